// What report.html says of a run: docs/report-format.md.
import type { StudyData } from "./study.ts";

/** A table of whole numbers in a block; docs/report-format.md, "Arrays". */
export interface ArrayRef {
  block: number;
  rows: number;
  columns: number;
  bytes: 1 | 2 | 4;
  low?: number;
  step?: number;
  none?: number;
  float?: boolean;
}

/** Some frames of a quantity: its rows are the frames from `first` on. */
export interface Chunk extends ArrayRef {
  first: number;
}

export interface Quantity {
  name: string;
  unit: string;
  on: "nodes" | "elements";
  chunks: Chunk[];
}

export interface Body {
  name: string;
  rigid: boolean;
  node_begin: number;
  node_end: number;
  element_begin: number;
  element_end: number;
}

/** Contact forces of some frames: `counts[k]` nodes feel one in frame `first` + k. */
export interface ForceChunk {
  first: number;
  counts: number[];
  nodes?: ArrayRef;
  x?: ArrayRef;
  y?: ArrayRef;
}

export interface History {
  name: string;
  columns: { name: string; unit: string }[];
  values: ArrayRef;
}

export type Point = [number, number];

export interface Extremes {
  min: number | null;
  max: number | null;
  max_abs: number | null;
  last: number | null;
  time_of_min: number | null;
  time_of_max: number | null;
}

export interface Episode {
  first_touch: number | null;
  separation: number | null;
  duration: number | null;
  impulse: [number | null, number | null];
  peak_force: number | null;
  restitution: number | null;
  tangential_restitution?: number | null;
}

export interface Contact extends Omit<Episode, "separation" | "restitution"> {
  last_separation: number | null;
  duration_99: number | null;
  episodes: Episode[];
}

/** The parts of summary.json that the page shows. */
export interface Summary {
  elements: number;
  nodes: number;
  steps: number;
  threads: number;
  wall_seconds: number;
  stepping_seconds: number;
  element_steps_per_second: number;
  end_time: number;
  energy_error: number | null;
  momentum_error: number | null;
  spin_error?: number | null;
  penetration_ratio: number | null;
  verdict: string;
  reasons: string[];
  warnings: string[];
  stop_reason: string;
  machine?: { processor: string; threads: number };
  started?: string;
  bodies?: { name: string }[];
  contacts: Record<string, Contact>;
}

export interface Run {
  format: number;
  case_name: string;
  version: string;
  summary: Summary | null;
  case_text: string;
  resolved_text: string;
  log: string;
  times: number[];
  nodes: number;
  elements: number;
  corners: ArrayRef;
  node_numbers: ArrayRef;
  element_numbers: ArrayRef;
  bodies: Body[];
  centre_x: ArrayRef;
  centre_y: ArrayRef;
  quantities: Quantity[];
  forces?: { unit: string; largest: number; chunks: ForceChunk[] };
  outlines: { sets: Point[][][]; of_frame: number[] };
  observed: Record<string, { on: "nodes" | "elements"; index: number }>;
  histories: History[];
  left_out: string[];
}

/** What this page holds: a run, or several of a study. Throws where there is nothing, or what a newer program wrote. */
export function read_page(page: Document): Run | StudyData {
  const text = page.getElementById("run")?.textContent;
  if (!text) throw new Error("this page holds no run");
  const data = JSON.parse(text) as Run | StudyData;
  if (data.format !== 1) throw new Error(`this page has data of format ${data.format}, and its viewer knows format 1`);
  return data;
}
