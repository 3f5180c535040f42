// Builds dist/viewer.html, the page without a run: style and program in one file, with a content policy that lets run
// this program and nothing else. `npm run build`; docs/report-format.md says how a run is put into it.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdir, readFile, rename, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const common = { bundle: true, write: false, minify: true, format: "iife", target: "es2022", legalComments: "none", charset: "ascii" };
const bundle = async (entry, define = {}) => {
  const { outputFiles } = await build({ ...common, entryPoints: [join(here, entry)], define });
  return outputFiles[0].text.trim();
};

const worker = await bundle("src/worker.ts");
const script = (await bundle("src/main.ts", { WORKER_SOURCE: JSON.stringify(worker) })).replaceAll("</script", "<\\/script");
const style =
  (await readFile(join(here, "node_modules/uplot/dist/uPlot.min.css"), "utf8")) +
  (await readFile(join(here, "src/style.css"), "utf8"));
// The libraries' licences ask for their text in every copy.
const licence = async (name, file) =>
  `<!--\n${name}\n\n${(await readFile(join(here, "node_modules", name, file), "utf8")).trim().replaceAll("--", "- -")}\n-->\n`;
const parts = {
  licences: (await licence("uplot", "LICENSE")) + (await licence("twgl.js", "LICENSE.md")),
  "script-hash": createHash("sha256").update(script).digest("base64"),
  style: style.replaceAll("</style", "<\\/style"),
  script,
};
const template = await readFile(join(here, "src/page.html"), "utf8");
const page = template.replace(/\{\{([\w-]+)\}\}/g, (_, name) => parts[name]);
await mkdir(join(here, "dist"), { recursive: true });
await writeFile(join(here, "dist/viewer.html.new"), page);
await rename(join(here, "dist/viewer.html.new"), join(here, "dist/viewer.html"));
