// What can be shown in colour, and how it is computed from what the page holds.
import type { Frames } from "./frames.ts";

export interface Field {
  id: string;
  label: string;
  unit: string; // SI
  on: "nodes" | "elements";
  /** Quantities of the page that it takes. */
  needs: string[];
  /** Both signs mean something: colours part at 0. */
  signed: boolean;
  /** A state instead of a number: flows now, has flowed, never did. */
  flag?: boolean;
  from: (...values: number[]) => number;
}

const same = (value: number): number => value;
/** 1 where it flows now, a half where it has flowed, else 0. */
const flow = (now: number, strain: number): number => (now > 0.5 ? 1 : strain > 0 ? 0.5 : 0);
export const flow_words = (value: number): string => (value > 0.75 ? "yes" : value > 0.25 ? "it has flowed" : "no");
const size = (x: number, y: number): number => Math.hypot(x, y);

const all: Field[] = [
  field("plastic_strain", "Plastic strain", "", ["plastic_strain"], same),
  { ...field("flows_now", "Flows now", "", ["flows_now", "plastic_strain"], flow), flag: true },
  { ...field("flows_now", "Flows now", "", ["flows_now"], same), flag: true },
  signed("principal_1", "Principal stress 1", "Pa", ["principal_1"], same),
  signed("principal_2", "Principal stress 2", "Pa", ["principal_2"], same),
  signed("principal_3", "Principal stress 3", "Pa", ["principal_3"], same),
  field("max_shear", "Maximum shear stress", "Pa", ["principal_1", "principal_3"], (a, c) => 0.5 * (a - c)),
  field("max_shear", "Maximum shear stress", "Pa", ["max_shear"], same),
  signed("pressure", "Pressure", "Pa", ["principal_1", "principal_2", "principal_3"], (a, b, c) => -(a + b + c) / 3),
  signed("pressure", "Pressure", "Pa", ["pressure"], same),
  nodal(field("speed", "Speed", "m/s", ["velocity_x", "velocity_y"], size)),
  nodal(signed("velocity_x", "Velocity x", "m/s", ["velocity_x"], same)),
  nodal(signed("velocity_y", "Velocity y", "m/s", ["velocity_y"], same)),
  nodal(field("acceleration", "Acceleration", "m/s^2", ["acceleration_x", "acceleration_y"], size)),
  nodal(signed("acceleration_x", "Acceleration x", "m/s^2", ["acceleration_x"], same)),
  nodal(signed("acceleration_y", "Acceleration y", "m/s^2", ["acceleration_y"], same)),
];

function field(id: string, label: string, unit: string, needs: string[], from: Field["from"]): Field {
  return { id, label, unit, on: "elements", needs, signed: false, from };
}
function signed(id: string, label: string, unit: string, needs: string[], from: Field["from"]): Field {
  return { ...field(id, label, unit, needs, from), signed: true };
}
function nodal(of_elements: Field): Field {
  return { ...of_elements, on: "nodes" };
}

/** The fields for which this page has what they take. */
export function fields_of(frames: Frames): Field[] {
  const known: Field[] = [];
  for (const f of all) {
    const there = f.needs.every((name) => frames.quantity(name));
    if (there && !known.some((k) => k.id === f.id)) known.push(f);
  }
  return known;
}

/** The field in a frame for which its quantities are ready; NaN on rigid bodies, where a stress means nothing. */
export function field_values(frames: Frames, shown: Field, frame: number): Float32Array {
  const parts = shown.needs.map((name) => frames.values(name, frame));
  const out = parts[0];
  if (parts.length > 1 || shown.from !== same) {
    const [a, b, c] = parts;
    for (let k = 0; k < out.length; ++k) out[k] = shown.from(a[k], b?.[k], c?.[k]);
  }
  if (shown.on === "elements") {
    for (const body of frames.run.bodies) {
      if (body.rigid) out.fill(NaN, body.element_begin, body.element_end);
    }
  }
  return out;
}

/** The field of one node or element, frame by frame. */
export async function field_series(frames: Frames, shown: Field, index: number): Promise<Float32Array> {
  const parts: Float32Array[] = [];
  for (const name of shown.needs) parts.push(await frames.column(name, index));
  return parts[0].map((a, k) => shown.from(a, parts[1]?.[k], parts[2]?.[k]));
}

/** Lowest and highest of all values but the outermost half per cent on each side: a handful of crushed elements would
 *  leave everything else in one colour. */
export function usual_range(values: Float32Array[], both_signs: boolean): [number, number] {
  const known: number[] = [];
  for (const part of values) {
    const stride = Math.max(1, Math.floor(part.length / 20000));
    for (let k = 0; k < part.length; k += stride) if (Number.isFinite(part[k])) known.push(part[k]);
  }
  if (known.length === 0) return [0, 1];
  const sorted = Float32Array.from(known).sort();
  const at = (part: number): number => sorted[Math.round(part * (sorted.length - 1))];
  if (both_signs) {
    const most = Math.max(-at(0.005), at(0.995)) || Math.max(-sorted[0], sorted[sorted.length - 1]) || 1;
    return [-most, most];
  }
  const high = at(0.995) > 0 ? at(0.995) : sorted[sorted.length - 1];
  return [0, high > 0 ? high : 1];
}
