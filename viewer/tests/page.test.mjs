// report.html in a real browser: what a user does with it, and what it must never do.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { frame_drawn, open_browser, open_report, read_csv, report, root, run, scratch, scrub } from "./harness.mjs";
import { compare_pictures } from "./pictures.mjs";

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const beam = join(root, "cases/short-beam/short-beam.toml");

let browser;
let medium; // run folders
let page; // of the medium short beam

before(async () => {
  medium = run(beam, "medium");
  browser = await open_browser();
  page = await open_report(browser, join(medium, "report.html"));
});
after(() => browser?.close());

/** The stage at whole pixels and of one size, whatever stands around it: words of the header have other widths in other
 *  runs, and a picture between two pixels is another picture. */
const stage_alone = "#stage { position: fixed; left: 0; top: 0; width: 640px; height: 400px; max-height: none; z-index: 9; }";

const meta = () => page.evaluate(() => JSON.parse(document.getElementById("run").textContent));

/** The row of a history at the time of a frame. */
function row_at(history, time) {
  const rows = read_csv(readFileSync(join(medium, "histories", `${history}.csv`), "utf8"));
  const row = rows.find((r) => Math.abs(r.time - time) <= 1e-12 * Math.max(1, time));
  assert.ok(row, `no row of ${history} at ${time} s`);
  return row;
}

/** A number as the page writes it, in SI. */
function in_si(text, units) {
  const [, number, unit] = /^([−\d.e]+)\s*(.*)$/.exec(text);
  assert.ok(unit in units, `unit ${unit}`);
  return Number(number.replaceAll("−", "-")) * units[unit];
}
const lengths = { "µm": 1e-6, mm: 1e-3, cm: 1e-2, m: 1 };
const stresses = { Pa: 1, kPa: 1e3, MPa: 1e6, "kgf/cm²": 98066.5 };

test("opens without a fault and says what ran", async () => {
  assert.deepEqual(page.faults, []);
  assert.equal(await page.textContent("h1"), "short-beam");
  assert.match(await page.textContent("#verdict"), /verdict: good/);
  assert.match(await page.textContent("#stage-time"), /t = 0 /);
  assert.match(await page.textContent("#numbers"), /stop/);
  const texts = await page.textContent("#texts");
  assert.match(texts, /yield_stress/);
  assert.match(texts, /udar \d+\.\d+/);
});

test("scrubs, and a picked node stands where the CSV says", async () => {
  const { times, quantities, observed } = await meta();
  const corner = observed.corner;
  assert.equal(corner.on, "nodes");
  await page.evaluate(({ index }) => (location.hash = `picked=nodes,${index}`), corner);
  await page.selectOption("#field", "velocity_y");
  for (const frame of [1, 26, 50, 100]) {
    await scrub(page, frame);
    const row = row_at("corner", times[frame]);
    const start = row_at("corner", 0);
    for (const [k, axis] of ["x", "y"].entries()) {
      const chunk = quantities.find((q) => q.name === axis).chunks.find((c) => frame >= c.first && frame < c.first + c.rows);
      const shown = in_si(await page.textContent(`#picked-now [data-value=${axis}]`), lengths);
      const place = [-0.2, 0.1][k] + row[`displacement_${axis}`] - start[`displacement_${axis}`];
      // Half a step of the coding, half a unit of the fifth digit, single precision on the way.
      const bound = 0.5 * chunk.step + 0.5e-4 * Math.abs(place) + 1e-7;
      assert.ok(Math.abs(shown - place) <= bound, `${axis} of frame ${frame}: ${shown}, not ${place}, bound ${bound}`);
    }
  }
  assert.match(await page.textContent("#picked-name"), /observed as corner/);
  // It is plotted, with the paper's three figures.
  await page.waitForSelector('[data-plot="picked.displacement"] table.figures');
  const figures = await page.textContent('[data-plot="picked.displacement"] table.figures');
  assert.match(figures, /maximum.*now.*minimum.*displacement x.*displacement y/s);
});

test("an observed element has the stress of the CSV", async () => {
  const { times, quantities, observed } = await meta();
  await page.evaluate(({ index }) => (location.hash = `picked=elements,${index}`), observed.top);
  await page.selectOption("#field", "principal_1");
  for (const frame of [2, 40, 99]) {
    await scrub(page, frame);
    const exact = row_at("top", times[frame]).principal_1;
    const chunk = quantities.find((q) => q.name === "principal_1").chunks.find((c) => frame >= c.first && frame < c.first + c.rows);
    const shown = in_si(await page.textContent("#picked-now [data-value=principal_1]"), stresses);
    const bound = 0.5 * chunk.step + 0.5e-3 * Math.abs(exact) + 1e-6 * Math.abs(exact);
    assert.ok(Math.abs(shown - exact) <= bound, `frame ${frame}: ${shown} Pa, not ${exact} Pa, bound ${bound}`);
  }
});

test("the history's plot shows the value of the frame's time", async () => {
  const { times } = await meta();
  await scrub(page, 30);
  const figure = page.locator('[data-plot="corner.displacement"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("table.figures").waitFor();
  const row = figure.locator("tbody tr", { hasText: "displacement y" });
  const unit = /, (\S+)$/.exec(await figure.locator("figcaption").textContent())[1];
  const cells = await row.locator("td").allTextContents();
  const rows = read_csv(readFileSync(join(medium, "histories", "corner.csv"), "utf8")).map((r) => r.displacement_y);
  const wanted = [Math.max(...rows), row_at("corner", times[30]).displacement_y, Math.min(...rows)];
  cells.forEach((cell, k) => {
    const shown = in_si(`${cell} ${unit}`, lengths);
    assert.ok(Math.abs(shown - wanted[k]) <= 0.6e-3 * Math.abs(wanted[k]) + 1e-12, `${shown} m, not ${wanted[k]} m`);
  });
});

test("changes field, colours and range", async () => {
  await scrub(page, 20);
  const looks = [];
  for (const field of ["plastic_strain", "principal_3", "max_shear", "pressure", "speed", "none", "flows_now"]) {
    await page.selectOption("#field", field);
    await page.waitForTimeout(250);
    looks.push((await page.locator("#stage").screenshot()).toString("base64"));
  }
  assert.equal(new Set(looks).size, looks.length, "every field looks different");
  await page.selectOption("#field", "max_shear");
  await page.fill("#high", "500");
  await page.press("#high", "Enter");
  assert.equal(await page.inputValue("#range"), "own");
  await page.fill("#low", "900");
  await page.press("#low", "Enter");
  assert.equal(await page.getAttribute("#low", "aria-invalid"), "true");
  await page.selectOption("#range", "run");
});

test("plays, pauses and goes on by keys", async () => {
  await scrub(page, 0);
  await page.selectOption("#rate", "10");
  await page.focus("#stage");
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.body.dataset.frame) >= 4, null, { timeout: 20_000 });
  await page.keyboard.press(" ");
  await page.waitForTimeout(300);
  const at = await page.evaluate(() => Number(document.body.dataset.frame));
  await page.waitForTimeout(400);
  assert.equal(await page.evaluate(() => Number(document.body.dataset.frame)), at, "paused");
  await page.keyboard.press("ArrowRight");
  await frame_drawn(page, at + 1);
  await page.keyboard.press("End");
  await frame_drawn(page, 100);
  await page.keyboard.press("Home");
  await frame_drawn(page, 0);
});

test("moves by itself when it is opened, once", async () => {
  const short = run(beam, "short", ["--set", 'bodies.beam.mesh.element_size="1 cm"', "--set", 'output.fields_every="0.4 ms"']);
  const view = await open_report(browser, join(short, "report.html"), { motion: "no-preference" });
  await frame_drawn(view, 5);
  await view.waitForSelector("#play[aria-pressed=false]");
  await view.context().close();
});

test("the address brings back frame, field and view", async () => {
  await scrub(page, 42);
  await page.selectOption("#field", "principal_1");
  await page.click("#zoom-in");
  await page.waitForFunction(() => /frame=42.*field=principal_1/.test(location.hash));
  await page.waitForTimeout(400);
  const hash = await page.evaluate(() => location.hash);
  const again = await open_report(browser, join(medium, "report.html"), { hash });
  assert.equal(await again.evaluate(() => document.body.dataset.frame), "42");
  assert.equal(await again.inputValue("#field"), "principal_1");
  const style = await page.addStyleTag({ content: stage_alone });
  await again.addStyleTag({ content: stage_alone });
  await page.waitForTimeout(700);
  const [one, two] = [await page.locator("#stage").screenshot(), await again.locator("#stage").screenshot()];
  const { different } = await compare_pictures(browser, one, two);
  assert.ok(different < 0.002, `${different} of the view differs`);
  await style.evaluate((element) => element.remove());
  assert.deepEqual(again.faults, []);
  await again.context().close();
});

test("three frames look as they did", async () => {
  const view = await open_report(browser, join(medium, "report.html"), {
    hash: "#frame=10&field=flows_now&at=0,0.03,0.5&show=mesh,outline,forces", width: 1187, height: 833,
  });
  await view.addStyleTag({ content: `${stage_alone} #stage span { display: none }` });
  await view.waitForTimeout(500);
  for (const [frame, field] of [[10, "flows_now"], [50, "principal_1"], [100, "plastic_strain"]]) {
    await view.selectOption("#field", field);
    await scrub(view, frame);
    await view.waitForTimeout(300);
    const seen = await view.locator("#stage").screenshot();
    const stored = join(root, "viewer/tests/pictures", `${field}-${frame}.png`);
    if (process.env.UDAR_WRITE_PICTURES) writeFileSync(stored, seen);
    const { different } = await compare_pictures(browser, seen, readFileSync(stored));
    // Letters are drawn otherwise on other systems: scale and label of forces, some 0.3 % of the view.
    assert.ok(different < 0.006, `${field} of frame ${frame}: ${(100 * different).toFixed(2)} % of the picture differs`);
  }
  await view.context().close();
});

test("saves the picture and a film", async () => {
  await page.selectOption("#field", "plastic_strain");
  await scrub(page, 100);
  const [picture] = await Promise.all([page.waitForEvent("download"), page.click("#save-picture")]);
  const file = join(scratch, "saved.png");
  await picture.saveAs(file);
  assert.equal(picture.suggestedFilename(), "short-beam-100.png");
  const bytes = readFileSync(file);
  assert.deepEqual([...bytes.subarray(0, 8)], [137, 80, 78, 71, 13, 10, 26, 10]);
  assert.ok(bytes.readUInt32BE(16) >= 500 && bytes.readUInt32BE(20) >= 300, "its size");
  assert.ok(bytes.length > 10_000);

  await page.selectOption("#rate", "60"); // drawn picture by picture: a busy machine takes its time
  const [film] = await Promise.all([page.waitForEvent("download", { timeout: 600_000 }), page.click("#save-film")]);
  const film_file = join(scratch, "saved.webm");
  await film.saveAs(film_file);
  const film_bytes = readFileSync(film_file);
  assert.deepEqual([...film_bytes.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3], "it begins as WebM does");
  assert.ok(film_bytes.length > 50_000, `${film_bytes.length} bytes`);
});

test("whoever uses a keyboard or a screen reader is served", async () => {
  for (const colours of ["light", "dark"]) {
    const view = await open_report(browser, join(medium, "report.html"), { colours });
    // The checker is injected from outside, past the content policy.
    await view.evaluate(readFileSync(axe, "utf8"));
    const { violations } = await view.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
    const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
    assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ")}`), []);
    await view.context().close();
  }
});

test("nothing went wrong on the way", () => assert.deepEqual(page.faults, []));

test("hostile names are shown, not obeyed", async () => {
  const evil = (k) => `</script><img src=x onerror=alert(${k})>\u2028]]>`;
  const text = readFileSync(beam, "utf8").replace("# Extremes", `# ${evil(1).replace("\u2028", "")}\n# Extremes`);
  const file = join(scratch, "<img src=x onerror=alert(4)>.toml");
  writeFileSync(file, text);
  const folder = run(file, "hostile", ["--set", 'bodies.beam.mesh.element_size="1 cm"', "--set", 'run.end_time="0.2 ms"']);
  // Names in a case are letters and digits; a folder may have been through other hands.
  const summary = JSON.parse(readFileSync(join(folder, "summary.json"), "utf8"));
  Object.assign(summary, { verdict: "doubtful", reasons: [evil(5)], warnings: [evil(6)], version: evil(7), machine: { processor: evil(8), threads: 2 } });
  summary.contacts[evil(9)] = Object.values(summary.contacts)[0];
  for (const body of summary.bodies ?? []) body.name = evil(10);
  writeFileSync(join(folder, "summary.json"), JSON.stringify(summary));
  writeFileSync(join(folder, "log.txt"), evil(11));
  const history = readFileSync(join(folder, "histories/corner.csv"), "utf8");
  const name = "<img src=x onerror=alert(12)>";
  writeFileSync(join(folder, `histories/${name}.csv`), history.replace("displacement_x", "<img src=x onerror=alert(13)>"));
  report(folder);
  const view = await open_report(browser, join(folder, "report.html"), { motion: "no-preference" });
  await view.waitForTimeout(500);
  for (const details of await view.locator("details").all()) await details.evaluate((d) => (d.open = true));
  await view.waitForTimeout(500);
  assert.deepEqual(view.faults, []);
  assert.equal(await view.locator("img").count(), 0);
  assert.match(await view.textContent("h1"), /<img src=x onerror=alert\(4\)>/);
  const words = await view.textContent("body");
  for (const k of [1, 5, 6, 8, 9, 11]) assert.ok(words.includes(`alert(${k})`), `text ${k} is shown`);
  await view.context().close();
});

test("a run without frames and one that failed have a page too", async () => {
  const coarse = ["--set", 'bodies.beam.mesh.element_size="1 cm"'];
  const bare = run(beam, "bare", [...coarse, "--set", "output.fields_every=never"]);
  const without = await open_report(browser, join(bare, "report.html"));
  assert.match(await without.textContent("#stage"), /no frames/);
  await without.locator('[data-plot="energy.energy"] table.figures').waitFor();
  assert.deepEqual(without.faults, []);
  await without.context().close();

  // A velocity that no mesh survives.
  const failed = run(beam, "failed", [...coarse, "--set", 'bodies.beam.velocity=["0 m/s", "-4000 m/s"]'], 5);
  const view = await open_report(browser, join(failed, "report.html"));
  assert.match(await view.textContent("header"), /numerical failure/);
  assert.deepEqual(view.faults, []);
  await view.context().close();
});

test("narrow screens show everything", async () => {
  const view = await open_report(browser, join(medium, "report.html"), { width: 420, height: 800 });
  const overflow = await view.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(overflow <= 0, `${overflow} px to the side`);
  await view.context().close();
});
