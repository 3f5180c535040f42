// study.html in a real browser: levels beside each other, tables, plots, and what the page must never do.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { frame_drawn, open_browser, open_report, root, scratch, scrub, udar } from "./harness.mjs";
import { estimate, study_folder } from "./study_folder.mjs";

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const beam = join(root, "cases/short-beam/short-beam.toml");
const short = ["--set", 'run.end_time="0.4 ms"'];
const mesh = (size, ...more) => [...short, "--set", `bodies.beam.mesh.element_size="${size}"`, ...more];
const failure = "element 812 turned inside out";
const make_page = ({ folder }) => {
  execFileSync(udar, ["report", folder], { stdio: "pipe" });
  return join(folder, "study.html");
};

let browser;
let study; // folder, what is in study.json
let file;
let page;

before(async () => {
  study = study_folder("study", beam, "converge", [
    ["mesh1-step1", mesh("2 cm", "--set", 'output.fields_every="40 us"'), { mesh: 0 }],
    ["mesh2-step1", mesh("1 cm"), { mesh: 1 }],
    ["mesh3-step1", mesh("0.5 cm", "--no-report"), { mesh: 2 }],
    ["mesh4-step1", null, { mesh: 3, state: "failed", reason: failure, verdict: "" }],
  ], { element_sizes: [0.02, 0.01, 0.005, 0.0025], meshes: 4 });
  file = make_page(study);
  browser = await open_browser();
  page = await open_report(browser, file);
});
after(() => browser?.close());

const data = () => page.evaluate(() => JSON.parse(document.getElementById("run").textContent));
const panels = (of = page) => of.$$eval(".level", (all) => all.map((e) => ({ run: e.dataset.run, frame: Number(e.dataset.frame), field: e.dataset.field, hidden: e.hidden })));
/** A number as the page writes it. */
const in_si = (text) => Number(text.replaceAll("−", "-"));

test("opens without a fault, with every mesh and what became of the runs", async () => {
  assert.deepEqual(page.faults, []);
  assert.equal(await page.textContent("h1"), "short-beam");
  assert.deepEqual((await panels()).map(({ run }) => run), ["mesh1-step1", "mesh2-step1", "mesh3-step1"]);
  const labels = await page.locator(".level-name").allTextContents();
  assert.deepEqual(labels, ["2 cm", "1 cm", "0.5 cm"]);
  const { study: inside, runs } = await data();
  const told = await page.locator(".level-facts").allTextContents();
  runs.forEach((run, k) => assert.ok(told[k].startsWith(`${run.elements.toLocaleString("en")} elements`), told[k]));
  assert.match(await page.textContent(".notes"), new RegExp(`mesh4-step1 failed: ${failure}`));
  assert.match(await page.textContent("#runs"), new RegExp(failure));
  assert.equal(inside.headlines.length, await page.locator("#headlines p").count());
  assert.deepEqual(await page.locator("#headlines .much").allTextContents(), ["1.38 ms", "24.9 kJ", "1.52 MN"]);
  // Only runs that have a page of their own are linked.
  const links = await page.locator(".level a").evaluateAll((all) => all.map((a) => a.getAttribute("href")));
  assert.deepEqual(links, ["runs/mesh1-step1/report.html", "runs/mesh2-step1/report.html"]);
});

test("all stages show the frame nearest to the common time", async () => {
  const { runs } = await data();
  for (const frame of [0, 7, 13, 20]) {
    await scrub(page, frame);
    const time = await page.evaluate(() => Number(document.body.dataset.time));
    for (const [k, panel] of (await panels()).entries()) {
      const off = runs[k].times.map((t) => Math.abs(t - time));
      assert.ok(off[panel.frame] <= Math.min(...off) + 1e-15, `${panel.run} shows frame ${panel.frame} at ${time} s`);
    }
    const texts = await page.locator(".stage-time").allTextContents();
    texts.forEach((text) => assert.match(text, /^t = /));
  }
  const times = (await data()).runs[1].times;
  assert.equal(await page.evaluate(() => Number(document.body.dataset.time)), (await data()).runs[2].times.at(-1));
  assert.ok(times.length > (await data()).runs[0].times.length, "they have other frames");
});

test("plays all together and is led by keys", async () => {
  await scrub(page, 0);
  await page.selectOption("#rate", "20");
  await page.focus("#wall .stage >> nth=1");
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.body.dataset.frame) >= 4, null, { timeout: 20_000 });
  await page.keyboard.press(" ");
  await page.keyboard.press("End");
  await frame_drawn(page, 20);
  await page.keyboard.press("Home");
  await frame_drawn(page, 0);
});

test("field, range and view are common", async () => {
  await scrub(page, 10);
  const seen = () => Promise.all([0, 1, 2].map((k) => page.locator(".stage").nth(k).screenshot().then((p) => p.toString("base64"))));
  let before = await seen();
  const box = await page.locator(".stage").nth(2).boundingBox();
  for (const change of [
    () => page.selectOption("#field", "speed"),
    () => page.selectOption("#map", "grey"),
    // A wheel over one stage moves all.
    () => page.mouse.move(box.x + box.width / 2, box.y + box.height / 2).then(() => page.mouse.wheel(0, -400)),
  ]) {
    await change();
    await page.waitForTimeout(300);
    const now = await seen();
    now.forEach((picture, k) => assert.notEqual(picture, before[k], `stage ${k} follows ${change}`));
    before = now;
  }
  assert.deepEqual((await panels()).map(({ field }) => field), ["speed", "speed", "speed"]);
  // The range is that over all runs: the largest of those in their own pages.
  const bounds = async (of) => {
    await of.selectOption("#field", "max_shear");
    await of.waitForTimeout(300);
    return in_si(await of.inputValue("#high"));
  };
  const common = await bounds(page);
  const alone = [];
  for (const run of ["mesh1-step1", "mesh2-step1", "mesh3-step1"]) {
    const own = join(scratch, `${run}.html`);
    execFileSync(udar, ["report", join(study.folder, "runs", run), "--output", own], { stdio: "pipe" });
    const view = await open_report(browser, own, { width: 700, height: 500 });
    alone.push(await bounds(view));
    await view.context().close();
  }
  assert.equal(common, Math.max(...alone));
  await page.keyboard.press("f");
});

test("a name shows one stage alone and all again; the address remembers", async () => {
  await scrub(page, 12);
  await page.click(".level-name >> nth=1");
  assert.deepEqual((await panels()).map(({ hidden }) => hidden), [true, false, true]);
  await page.click("#zoom-out");
  await page.waitForFunction(() => /frame=12.*only=mesh2-step1/.test(location.hash));
  const hash = await page.evaluate(() => location.hash);
  const again = await open_report(browser, file, { hash });
  assert.equal(await again.evaluate(() => document.body.dataset.frame), "12");
  assert.deepEqual((await panels(again)).map(({ hidden }) => hidden), [true, false, true]);
  assert.equal(await again.inputValue("#field"), await page.inputValue("#field"));
  assert.deepEqual(again.faults, []);
  await again.context().close();
  await page.click(".level-name >> nth=1");
  assert.deepEqual((await panels()).map(({ hidden }) => hidden), [false, false, false]);
});

test("the tables have the numbers of study.json", async () => {
  await page.click("[data-group=histories] summary");
  for (const { name, unit, values, mesh: m, verdict } of study.study.quantities) {
    const row = page.locator(`[data-quantity="${name}"]`);
    if ((await row.count()) === 0) continue; // of a group that is folded
    const cells = await row.locator("td[data-value]").evaluateAll((all) => all.map((td) => [td.dataset.value, td.firstChild.textContent, td.lastChild.textContent]));
    const shown_unit = await row.locator("td.unit").textContent();
    const size = { "": 1, m: 1, cm: 0.01, mm: 1e-3, "µs": 1e-6, ms: 1e-3, s: 1, N: 1, kN: 1e3, MN: 1e6 }[shown_unit];
    assert.ok(size, `${shown_unit} of ${unit}`);
    assert.equal(cells.length, 3);
    cells.forEach(([exact, text], k) => {
      assert.equal(Number(exact), values[k], name);
      assert.ok(Math.abs(in_si(text) * size - values[k]) <= 0.6e-4 * Math.abs(values[k]) + 1e-30, `${name}: ${text} ${shown_unit}, not ${values[k]}`);
    });
    m.differences.forEach((d, k) => {
      const told = cells[k][2];
      if (d < 10) assert.ok(Math.abs(in_si(told.replace(" %", "")) / 100 - d) <= 0.06 * d + 1e-9, `${name}: ${told}, not ${d}`);
    });
    assert.ok((await row.locator(".mark").textContent()).endsWith(verdict), name);
  }
  assert.ok((await page.locator("[data-quantity]").count()) > 10);
  const growth = await page.locator('[data-run="mesh2-step1"]').last().textContent();
  const [coarse, fine] = study.study.runs.map((r) => r.stepping_seconds);
  assert.ok(growth.includes(`× ${Number((fine / coarse).toPrecision(3))}`), growth);
  await page.click("#differences summary >> nth=0");
  assert.match(await page.locator("[data-difference='corner.displacement_y']").first().textContent(), /4 %.*1\.1 %.*converged/);
});

test("names and verdicts filter, and a verdict says why", async () => {
  await page.fill("#filter", "stop DURATION_99");
  assert.deepEqual(await page.locator("[data-quantity]").evaluateAll((all) => all.map((e) => e.dataset.quantity)), ["contacts.stop.duration_99"]);
  await page.fill("#filter", "");
  const verdict = study.study.quantities[0].verdict;
  await page.click(`.chip[data-verdict="${verdict}"]`);
  const marks = await page.locator("[data-quantity] .mark").allTextContents();
  assert.equal(marks.length, study.study.quantities.filter((q) => q.verdict === verdict).length);
  assert.ok(marks.every((m) => m.slice(1) === verdict), `only ${verdict}`);
  await page.click("[data-quantity] button.why >> nth=0");
  assert.equal(await page.locator("tr.reason").first().textContent(), study.study.quantities.find((q) => q.verdict === verdict).mesh.reason);
  await page.click(`.chip[data-verdict="${verdict}"]`);
  await page.fill("#filter", "zzz");
  assert.match(await page.textContent("#quantities"), /None fits/);
  await page.fill("#filter", "");
});

test("histories lie over each other, with a curve for each mesh", async () => {
  await scrub(page, 20);
  const figure = page.locator('[data-plot="corner.displacement_y"]');
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("table.figures").waitFor();
  assert.deepEqual(await figure.locator("tbody th").allTextContents(), ["2 cm", "1 cm", "0.5 cm"]);
  const unit = { cm: 0.01, mm: 1e-3, m: 1 }[/, (\S+)$/.exec(await figure.locator("figcaption").textContent())[1]];
  for (const [k, run] of ["mesh1-step1", "mesh2-step1", "mesh3-step1"].entries()) {
    const rows = readFileSync(join(study.folder, "runs", run, "histories/corner.csv"), "utf8").trim().split("\n").slice(1).map((line) => Number(line.split(",")[2]));
    const cells = await figure.locator("tbody tr").nth(k).locator("td").allTextContents();
    [Math.max(...rows), null, Math.min(...rows)].forEach((wanted, c) => {
      if (wanted === null) return; // the common time is not that of a row of every run
      assert.ok(Math.abs(in_si(cells[c]) * unit - wanted) <= 0.6e-3 * Math.abs(wanted) + 1e-9, `${run}: ${cells[c]}, not ${wanted} m`);
    });
  }
});

test("nothing went wrong on the way", () => assert.deepEqual(page.faults, []));

test("whoever uses a keyboard or a screen reader is served", async () => {
  for (const colours of ["light", "dark"]) {
    const view = await open_report(browser, file, { colours });
    await view.evaluate(readFileSync(axe, "utf8"));
    const { violations } = await view.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
    const serious = violations.filter((v) => ["serious", "critical"].includes(v.impact));
    assert.deepEqual(serious.map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(" ")}`), []);
    await view.context().close();
  }
});

test("narrow screens show everything", async () => {
  const view = await open_report(browser, file, { width: 420, height: 800 });
  for (const details of await view.locator("details").all()) await details.evaluate((d) => (d.open = true));
  await view.waitForTimeout(300);
  const overflow = await view.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(overflow <= 0, `${overflow} px to the side`);
  await view.context().close();
});

test("a sweep, runs without frames, and hostile names that are shown, not obeyed", async () => {
  const evil = (k) => `</script><img src=x onerror=alert(${k})>]]>`;
  const still = (friction) => mesh("2 cm", "--set", "output.fields_every=never", "--set", `obstacles.stop.friction=${friction}`);
  const sweep = study_folder("sweep", beam, "sweep", [0, 0.2, 0.4].map((f, k) => [`run${k + 1}`, still(f), { values: [f], texts: [String(f)] }]),
    { varied: ["obstacles.stop.friction"] });
  const bare = await open_report(browser, make_page(sweep));
  assert.deepEqual(bare.faults, []);
  assert.equal(await bare.locator("#picture").count(), 0);
  await bare.locator("#number-plot .uplot").waitFor();
  await bare.locator('[data-plot="corner.displacement_y"]').scrollIntoViewIfNeeded();
  await bare.locator('[data-plot="corner.displacement_y"] table.figures').waitFor();
  assert.match(await bare.locator('[data-plot="corner.displacement_y"]').textContent(), /friction 0\.2/);
  await bare.context().close();

  const s = study.study;
  study.write({
    ...s, case_name: evil(1), version: evil(2), headlines: [evil(3), `a = ${evil(4)}`],
    runs: s.runs.map((r, k) => (k < 3 ? { ...r, verdict: evil(5) } : { ...r, name: evil(6), reason: evil(7), state: evil(8) })),
    quantities: s.quantities.map((q, k) => (k > 1 ? q : { ...q, name: `${evil(9 + k)}.x`, unit: evil(11), verdict: evil(12), mesh: { ...estimate([1, 2], 2, 1), reason: evil(13) } })),
    histories: s.histories.map((d) => ({ ...d, name: evil(14), verdict: evil(15) })),
  });
  const view = await open_report(browser, make_page(study), { motion: "no-preference" });
  for (const details of await view.locator("details").all()) await details.evaluate((d) => (d.open = true));
  await view.click("button.why >> nth=0");
  await view.waitForTimeout(500);
  assert.deepEqual(view.faults, []);
  assert.equal(await view.locator("img").count(), 0);
  assert.equal(await view.textContent("h1"), evil(1));
  const words = await view.textContent("body");
  for (const k of [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]) assert.ok(words.includes(`alert(${k})`), `text ${k} is shown`);
  await view.context().close();
});
