// Brings the frame and field that are asked for onto the stage: loads what is missing, computes, chooses the range.
import { field_values, usual_range, type Field } from "./fields.ts";
import { Frames } from "./frames.ts";
import { node_means } from "./mesh.ts";
import { real_values } from "./arrays.ts";
import type { Forces, Stage } from "./stage.ts";
import type { Shown, Store } from "./store.ts";

export type Range = [low: number, high: number];

/** Where colours of several runs stand for the same: ranges over all of them. */
export interface CommonRanges {
  of_all(field: Field): Promise<Range>;
  /** Takes the range of what one run shows now. */
  of_now(field: Field, own: Range): Range;
}

export class Show {
  #turn = 0; // counts what was asked for; what comes too late is dropped
  readonly #ranges = new Map<string, Range>(); // of the run, by field

  constructor(
    private readonly frames: Frames,
    readonly all_fields: Field[],
    private readonly store: Store<Shown>,
    private readonly stage: Stage,
    private readonly tell: (drawn: boolean) => void,
    private readonly common?: CommonRanges,
  ) {
    store.on(["frame", "field", "smooth", "range", "forces"], () => void this.refresh());
    store.on(["centre", "width", "follow", "picked", "units", "theme"], () => stage.repaint());
    store.on(["mesh", "outline", "ghost", "map", "low", "high"], () => stage.repaint());
  }

  get field(): Field | null {
    return this.all_fields.find((f) => f.id === this.store.now.field) ?? null;
  }

  #needs(field: Field | null): string[] {
    return ["x", "y", ...(field?.needs ?? [])];
  }

  /** Comes back when the frame asked for is drawn, or another one is asked for. */
  async refresh(): Promise<void> {
    if (this.frames.count === 0) return;
    const turn = ++this.#turn;
    const { frame, range, forces } = this.store.now;
    const field = this.field;
    const needs = this.#needs(field);
    try {
      if (!this.frames.ready(frame, needs)) {
        this.tell(false);
        await this.frames.load(frame, needs);
        if (turn !== this.#turn) return;
      }
      const pushes = forces ? await this.#forces(frame) : null;
      const of_run = field && range === "run" ? await (this.common?.of_all(field) ?? this.run_range(field)) : null;
      if (turn !== this.#turn) return;
      if (!this.frames.ready(frame, needs)) await this.frames.load(frame, needs); // dropped meanwhile
      if (turn !== this.#turn) return;
      this.#draw(frame, field, pushes, of_run);
      this.tell(true);
      this.#look_ahead(frame, needs);
    } catch (error) {
      this.stage.root.dispatchEvent(new CustomEvent("failure", { detail: String(error) }));
    }
  }

  #draw(frame: number, field: Field | null, forces: Forces | null, of_run: Range | null): void {
    const { store, stage, frames } = this;
    const places = frames.places(frame);
    stage.scene?.set_places(places);
    const values = field ? field_values(frames, field, frame) : null;
    if (field && values) {
      const by_node = field.on === "nodes" || (store.now.smooth && !field.flag);
      const drawn = field.on === "nodes" || !by_node ? values : node_means(frames.corners, values, frames.run.nodes);
      if (field.on === "nodes" && !store.now.smooth) stage.scene?.set_values(this.#element_means(values), false);
      else stage.scene?.set_values(drawn, by_node);
      const now = store.now.range === "frame" ? this.#range_now(field, values) : of_run;
      if (now) store.set({ low: now[0], high: now[1] });
    } else {
      stage.scene?.set_values(new Float32Array(frames.run.elements), false);
    }
    const { low, high } = store.now;
    stage.drawn = {
      frame,
      places,
      field,
      values,
      // What the coding of the page moves a value by is not told.
      below: values?.some((v) => v < low - 0.005 * (high - low)) ?? false,
      above: values?.some((v) => v > high + 0.005 * (high - low)) ?? false,
      forces,
    };
    stage.repaint();
  }

  #range_now(field: Field, values: Float32Array): Range {
    const own = usual_range([values], field.signed);
    return this.common?.of_now(field, own) ?? own;
  }

  /** A value of nodes as one of elements. */
  #element_means(values: Float32Array): Float32Array {
    const { corners } = this.frames;
    const elements = corners.length / 3;
    const out = new Float32Array(elements);
    for (let e = 0; e < elements; ++e) {
      out[e] = (values[corners[e]] + values[corners[elements + e]] + values[corners[2 * elements + e]]) / 3;
    }
    return out;
  }

  async #forces(frame: number): Promise<Forces | null> {
    const chunks = this.frames.run.forces?.chunks ?? [];
    const chunk = chunks.find((c) => frame >= c.first && frame < c.first + c.counts.length);
    if (!chunk) return null;
    const { largest } = this.frames.run.forces!;
    if (!chunk.nodes || !chunk.x || !chunk.y) {
      return { nodes: new Uint32Array(), x: new Float32Array(), y: new Float32Array(), largest };
    }
    const [nodes, x, y] = await Promise.all([chunk.nodes, chunk.x, chunk.y].map((ref) => this.frames.blocks.numbers(ref)));
    const begin = chunk.counts.slice(0, frame - chunk.first).reduce((sum, n) => sum + n, 0);
    const end = begin + chunk.counts[frame - chunk.first];
    return {
      nodes: Uint32Array.from(nodes.subarray(begin, end)),
      x: real_values(x.subarray(begin, end), chunk.x),
      y: real_values(y.subarray(begin, end), chunk.y),
      largest,
    };
  }

  /** The range of a field over the run, from some of its frames. */
  async run_range(field: Field): Promise<Range> {
    const known = this.#ranges.get(field.id);
    if (known) return known;
    // One chunk after the other, each once: the quantities of one are at hand together.
    const chunks = this.frames.quantity(field.needs[0])?.chunks ?? [];
    const looked_at = chunks.length <= 4 ? chunks : [0, 1, 2, 3].map((k) => chunks[Math.round((k * (chunks.length - 1)) / 3)]);
    const samples: Float32Array[] = [];
    for (const chunk of looked_at) {
      await this.frames.load(chunk.first, field.needs);
      for (const part of [0.25, 0.6, 1]) {
        samples.push(field_values(this.frames, field, chunk.first + Math.round(part * (chunk.rows - 1))));
      }
    }
    const range = usual_range(samples, field.signed);
    this.#ranges.set(field.id, range);
    return range;
  }

  /** Asks for what comes next in good time. */
  #look_ahead(frame: number, needs: string[]): void {
    const chunks = this.frames.quantity("x")?.chunks ?? [];
    const next = chunks[chunks.indexOf(Frames.chunk(chunks, frame)) + 1];
    if (next && this.store.now.playing) void this.frames.load(next.first, needs);
  }
}
