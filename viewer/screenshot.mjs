// A picture of the page of a run, for the documentation: node screenshot.mjs REPORT OUT ADDRESS, where ADDRESS is what
// stands behind # (docs/report.md).
import { resolve } from "node:path";
import { open_browser, open_report } from "./tests/harness.mjs";

const [file, out, address] = process.argv.slice(2);
const browser = await open_browser();
const page = await open_report(browser, resolve(file), { hash: `#${address}`, width: 1500, height: 1000 });
await page.waitForTimeout(1500);
await page.screenshot({ path: out });
await browser.close();
