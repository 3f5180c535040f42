// What the browser tests share: the program, a browser, a page that notices everything a report must never do.
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
export const udar = process.env.UDAR ?? join(root, "build/release/udar");
const browser_path = process.env.CHROMIUM ?? "/usr/bin/chromium";

export const scratch = mkdtempSync(join(tmpdir(), "udar-viewer-"));
process.on("exit", () => rmSync(scratch, { recursive: true, force: true }));

/** Runs a case into a folder of the tests and returns the folder; a run that stops with `status` is as expected. */
export function run(case_file, name, options = [], status = 0) {
  const folder = join(scratch, name);
  let got = 0;
  try {
    execFileSync(udar, ["run", case_file, "--output", folder, ...options], { stdio: "pipe" });
  } catch (error) {
    got = error.status;
  }
  if (got !== status) throw new Error(`udar run ended with ${got}, not ${status}`);
  return folder;
}

/** Makes report.html of a run folder anew. */
export const report = (folder) => execFileSync(udar, ["report", folder], { stdio: "pipe" });

export async function open_browser() {
  if (!existsSync(browser_path)) throw new Error(`no browser at ${browser_path}: scripts/setup --test installs it`);
  return chromium.launch({
    executablePath: browser_path,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--font-render-hinting=none"],
  });
}

/** Opens a file and waits until its first frame is drawn. `page.faults` collects console errors and warnings, errors
 *  of the program, network requests, dialogs and broken rules of the content policy. */
export async function open_report(browser, file, { hash = "", width = 1500, height = 950, colours = "light", motion = "reduce" } = {}) {
  const context = await browser.newContext({
    viewport: { width, height }, colorScheme: colours, reducedMotion: motion, acceptDownloads: true,
  });
  const page = await context.newPage();
  page.faults = [];
  page.on("console", (m) => {
    // The software renderer complains that reading its pixels is slow; that is so.
    if (["error", "warning"].includes(m.type()) && !m.text().includes("GPU stall")) page.faults.push(`console: ${m.text()}`);
  });
  page.on("pageerror", (error) => page.faults.push(`error: ${error.message}`));
  page.on("dialog", (dialog) => {
    page.faults.push(`dialog: ${dialog.message()}`);
    void dialog.dismiss();
  });
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) page.faults.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href + hash);
  await page.waitForSelector("body[data-ready=true]", { timeout: 60_000 });
  return page;
}

/** Waits until a frame is on the stage. */
export const frame_drawn = (page, frame) =>
  page.waitForFunction((wanted) => document.body.dataset.frame === String(wanted), frame, { timeout: 30_000 });

/** Moves the slider of the time to a frame. */
export async function scrub(page, frame) {
  await page.fill("#time", String(frame));
  await frame_drawn(page, frame);
}

/** Rows of a history by column name without unit, as numbers. */
export function read_csv(text) {
  const [head, ...rows] = text.trim().split("\n").map((line) => line.split(","));
  const names = head.map((name) => name.replace(/ \[.*/, ""));
  return rows.map((row) => Object.fromEntries(names.map((name, k) => [name, Number(row[k])])));
}
