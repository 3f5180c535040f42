// What study.html says of a study: docs/report-format.md, docs/study-page.md.
import type { Run } from "./run.ts";
import { digits, type Units } from "./units.ts";

export type Value = number | null;

/** A run of the study as study.json tells of it. */
export interface StudyRun {
  name: string;
  changes: string[];
  values: Value[];
  texts: string[];
  mesh: number;
  step: number;
  state: string;
  reason: string;
  verdict: string;
  elements: number;
  steps: number;
  threads: number;
  stepping_seconds: Value;
  shortest_step: Value;
  longest_step: Value;
  energy_error: Value;
  shortened_steps?: number;
}

export interface Estimate {
  values: Value[];
  differences: Value[];
  order: Value;
  extrapolated: Value;
  error: Value;
  verdict: string;
  reason: string;
}

export interface StudyQuantity {
  name: string;
  unit: string;
  values: Value[]; // of every run
  value: Value;
  mesh: Estimate;
  step: Estimate;
  verdict: string;
  headline: boolean;
}

export interface StudyDifference {
  name: string;
  unit: string;
  time: Value;
  size: Value;
  mesh_l2: Estimate;
  mesh_max: Estimate;
  step_l2: Estimate;
  step_max: Estimate;
  verdict: string;
}

export interface Study {
  kind: string; // converge or sweep
  version: string;
  case_name: string;
  meshes: number;
  mesh_ratio: Value;
  element_sizes: Value[];
  steps: number;
  tolerance: Value;
  varied: string[];
  comparison: { aligned: boolean; window: Value };
  runs: StudyRun[];
  quantities: StudyQuantity[];
  histories: StudyDifference[];
  fields: StudyDifference[];
  warnings?: string[];
  headlines: string[];
}

/** A run that is in the page with all it has. */
export interface ShownRun extends Run {
  name: string; // of its folder
  report: boolean; // has it a page of its own?
}

export interface StudyData {
  format: number;
  kind: "study";
  study: Study;
  runs: ShownRun[];
  left_out: string[];
}

/** One of the runs that are compared: a mesh, a time step, a value of a sweep. */
export interface Level {
  run: StudyRun;
  index: number; // in Study.runs
  label: string; // "0.25 cm"
}

export const is_sweep = (study: Study): boolean => study.kind !== "converge";
const is_done = (run: StudyRun): boolean => run.state === "done";

/** The last part of a path in the case: "friction" of "obstacles.stop.friction", "velocity.0" of "bodies.ball.velocity.0". */
export const last_part = (path: string): string => /[^.]*(?:\.\d+)?$/.exec(path)![0];

export function mesh_label(study: Study, run: StudyRun, units: Units): string {
  const size = study.element_sizes[run.mesh];
  if (!(typeof size === "number" && size > 0)) return run.name;
  const largest = Math.max(...study.element_sizes.map((s) => s ?? 0));
  const unit = units.for("m", units.chosen("m") ? largest : size);
  return `${digits(size / unit.size)} ${unit.name}`;
}

export function step_label(run: StudyRun, units: Units): string {
  const step = run.longest_step ?? run.shortest_step;
  if (step === null) return run.name;
  const unit = units.for("s", step);
  return `${digits(step / unit.size, 3)} ${unit.name}`;
}

export function sweep_label(study: Study, run: StudyRun): string {
  const label = run.texts.map((text, k) => `${last_part(study.varied[k] ?? "")} ${text}`.trim()).join(", ");
  return label || run.name;
}

export function label_of(study: Study, run: StudyRun, units: Units): string {
  return is_sweep(study) ? sweep_label(study, run) : mesh_label(study, run, units);
}

/** Of each mesh the run with its finest time step that is done, from the coarsest mesh on; of a sweep all that are
 *  done. */
export function levels_of(study: Study, units: Units): Level[] {
  const all = study.runs.map((run, index) => ({ run, index, label: label_of(study, run, units) })).filter(({ run }) => is_done(run));
  if (is_sweep(study)) return all;
  const finest = new Map<number, Level>();
  for (const level of all) {
    const known = finest.get(level.run.mesh);
    if (!known || level.run.step > known.run.step) finest.set(level.run.mesh, level);
  }
  return [...finest.values()].sort((a, b) => a.run.mesh - b.run.mesh);
}

/** The runs with the finest mesh, from the longest time step on; none where there is only one. */
export function step_levels_of(study: Study, units: Units): Level[] {
  if (is_sweep(study) || study.steps < 2) return [];
  const finest = levels_of(study, units).at(-1);
  const levels = study.runs
    .map((run, index) => ({ run, index, label: step_label(run, units) }))
    .filter(({ run }) => is_done(run) && run.mesh === finest?.run.mesh)
    .sort((a, b) => a.run.step - b.run.step);
  return levels.length > 1 ? levels : [];
}

/** Does the study refine the time step only? */
export const is_of_steps = (study: Study, units: Units): boolean =>
  !is_sweep(study) && levels_of(study, units).length < 2 && step_levels_of(study, units).length > 1;

/** How a verdict looks: a word with a sign and a colour. */
export const verdicts: Record<string, { sign: string; kind: string }> = {
  converged: { sign: "✓", kind: "good" },
  converging: { sign: "↘", kind: "doubtful" },
  "not converging": { sign: "✗", kind: "bad" },
  unknown: { sign: "?", kind: "unknown" },
};
