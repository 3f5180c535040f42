// Measures report.html of a large run: bytes, time until its first frame is drawn, memory while all of it is played.
// scripts/page-bench calls it: node bench.mjs REPORT [TIMES]. Prints one line of JSON.
import { readdirSync, readFileSync, statSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { open_browser } from "./tests/harness.mjs";

const [file, times = "5"] = process.argv.slice(2);

/** Memory of the largest renderer process, bytes: page, worker, decoded arrays, and the browser's own. */
function renderer_bytes() {
  let most = 0;
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      if (!readFileSync(`/proc/${pid}/cmdline`, "utf8").includes("--type=renderer")) continue;
      most = Math.max(most, 1024 * Number(/VmRSS:\s*(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]));
    } catch {
      // It has ended meanwhile.
    }
  }
  return most;
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const ready = [];
let heap = 0;
let renderer = 0;
let frames = 0;
for (let k = 0; k < Number(times); ++k) {
  const browser = await open_browser();
  const context = await browser.newContext({ viewport: { width: 1500, height: 950 }, reducedMotion: "reduce" });
  const page = await context.newPage();
  const begin = performance.now();
  await page.goto(pathToFileURL(file).href, { waitUntil: "commit" });
  await page.waitForSelector("body[data-ready=true]", { timeout: 120_000 });
  ready.push((performance.now() - begin) / 1000);
  if (k === 0) {
    const inspector = await context.newCDPSession(page);
    const look = async () => {
      const { usedSize, backingStorageSize = 0 } = await inspector.send("Runtime.getHeapUsage");
      let workers = 0;
      for (const worker of page.workers()) {
        workers += await worker.evaluate(() => performance.memory?.usedJSHeapSize ?? 0);
      }
      heap = Math.max(heap, usedSize + backingStorageSize + workers);
      renderer = Math.max(renderer, renderer_bytes());
    };
    await look();
    frames = Number(await page.getAttribute("#time", "max")) + 1;
    for (const field of await page.locator("#field option").evaluateAll((all) => all.map((o) => o.value))) {
      if (field === "none") continue;
      await page.selectOption("#field", field);
      for (let frame = 0; frame < frames; frame += 10) {
        await page.fill("#time", String(frame));
        await page.waitForFunction((wanted) => document.body.dataset.frame === String(wanted), frame, { timeout: 60_000 });
        await look();
      }
    }
  }
  await browser.close();
}
console.log(JSON.stringify({ bytes: statSync(file).size, frames, ready_s: median(ready), heap_bytes: heap, renderer_bytes: renderer }));
