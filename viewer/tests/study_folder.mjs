// A study folder made by hand, from runs of the program: for the tests of the page, which need no study command.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { run, scratch } from "./harness.mjs";

const nothing = () => ({ values: [], differences: [], order: null, extrapolated: null, error: null, verdict: "unknown", reason: "" });

/** Order and error of numbers on meshes each finer by `ratio`, by Richardson's extrapolation; the finest last. */
export function estimate(values, ratio, tolerance) {
  const differences = values.slice(1).map((v, k) => Math.abs(v - values[k]) / (Math.abs(v) || 1));
  const out = { ...nothing(), values, differences };
  const [a, b, c] = values.slice(-3);
  if (values.length < 3) return { ...out, reason: "two levels tell no order" };
  const part = (b - a) / (c - b);
  if (!(part > 1)) return { ...out, verdict: "not converging", reason: "the differences do not get smaller" };
  const order = Math.log(part) / Math.log(ratio);
  const error = Math.abs(c - b) / (ratio ** order - 1);
  const verdict = error <= tolerance * Math.abs(c) ? "converged" : "converging";
  return { ...out, order, extrapolated: c + (c - b) / (part - 1), error, verdict, reason: `order ${order.toFixed(2)}, error ${error.toExponential(2)}` };
}

const look_up = (summary, path) => path.reduce((at, name) => at?.[name] ?? null, summary);
const units = { duration: "s", duration_99: "s", peak_force: "N", first_touch: "s", plastic: "J", kinetic: "J", elastic: "J" };
const unit_of = (path) => units[path.at(-1)] ?? (path[0] === "histories" ? (path[2].startsWith("displacement") ? "m" : "") : "");

function paths_of(summary) {
  const out = [["contacts", "stop", "duration"], ["contacts", "stop", "duration_99"], ["contacts", "stop", "peak_force"], ["contacts", "stop", "first_touch"]];
  for (const term of ["kinetic", "elastic", "plastic"]) out.push(["ledger", term]);
  for (const [name, columns] of Object.entries(summary.histories)) {
    for (const column of Object.keys(columns)) if (/displacement|plastic/.test(column)) out.push(["histories", name, column, "min"], ["histories", name, column, "max_abs"]);
  }
  return out;
}

/** Runs `levels` ([name, options, about], about: what study.json says of it) and writes a study of them; a level without options
 *  was not run. */
export function study_folder(folder_name, case_file, kind, levels, more = {}) {
  const folder = join(scratch, folder_name);
  mkdirSync(join(folder, "runs"), { recursive: true });
  writeFileSync(join(folder, ".udar-study"), "");
  const runs = levels.map(([name, options, about]) => {
    const said = { name, changes: [], values: [], texts: [], mesh: 0, step: 0, state: "done", reason: "", verdict: "good", elements: 0, steps: 0, threads: 1, ...about };
    if (!options) return { said, summary: {} };
    const summary = JSON.parse(readFileSync(join(run(case_file, `${folder_name}/runs/${name}`, options), "summary.json"), "utf8"));
    Object.assign(said, {
      verdict: summary.verdict, elements: summary.elements, steps: summary.steps, stepping_seconds: summary.stepping_seconds,
      shortest_step: summary.time_step.min, longest_step: summary.time_step.max, energy_error: summary.energy_error,
    });
    return { said, summary };
  });
  const first = runs.find(({ summary }) => summary.histories).summary;
  const finest_step = Math.max(...runs.map(({ said }) => said.step));
  const meshes = new Map(runs.filter(({ said }) => said.state === "done" && said.step === finest_step).map((r) => [r.said.mesh, r]));
  const finest_mesh = Math.max(...runs.map(({ said }) => said.mesh));
  const quantities = paths_of(first).map((path, k) => {
    const value = ({ summary }) => look_up(summary, path);
    const is_converge = kind === "converge";
    const mesh = is_converge ? estimate([...meshes.values()].map(value), 2, 0.02) : nothing();
    const steps = runs.filter(({ said }) => said.mesh === finest_mesh && said.state === "done").map(value);
    const step = is_converge && steps.length > 1 ? estimate(steps, 2, 0.02) : nothing();
    return { name: path.join("."), unit: unit_of(path), values: runs.map(value), value: value(runs.at(-1)), mesh, step, verdict: mesh.verdict, headline: k < 4 };
  });
  const l2 = (a, b) => ({ ...nothing(), differences: [a, b], order: Math.log2(a / b), error: b, verdict: b < 0.02 ? "converged" : "converging", reason: `the last difference is ${b}` });
  const study = {
    schema: 1, kind, version: "udar test", case_name: first.case_name, meshes: meshes.size, mesh_ratio: 2,
    element_sizes: [], steps: finest_step + 1, tolerance: 0.02, varied: [], comparison: { aligned: true, window: 2e-6 },
    runs: runs.map(({ said }) => said), quantities,
    histories: kind === "converge" ? ["corner.displacement_y", "stop.force_y"].map((name, k) => ({ name, unit: k ? "N" : "m", time: null, size: 0.01,
      mesh_l2: l2(0.04, 0.011 + 0.02 * k), mesh_max: l2(0.09, 0.03), step_l2: nothing(), step_max: nothing(), verdict: k ? "converging" : "converged" })) : [],
    fields: kind === "converge" ? [1e-4, 2e-3].map((time) => ({ name: "bodies.plastic_strain", unit: "", time, size: 0.1,
      mesh_l2: l2(0.12, 0.05), mesh_max: l2(0.3, 0.2), step_l2: nothing(), step_max: nothing(), verdict: "converging" })) : [],
    headlines: kind === "converge" ? [
      "contact duration of stop = 1.38 ms +- 0.03 ms (mesh)", "plastic work = 24.9 kJ +- 0.2 kJ (mesh)", "peak force of stop = 1.52 MN: not converging (mesh)",
    ] : [],
    ...more,
  };
  const write = (changed = study) => writeFileSync(join(folder, "study.json"), JSON.stringify(changed, null, 2));
  write();
  return { folder, study, write };
}
