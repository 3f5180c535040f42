// The frames of a run: where nodes are and what fields are at a time.
import type { Blocks } from "./blocks.ts";
import { real_values } from "./arrays.ts";
import type { Chunk, Quantity, Run } from "./run.ts";

/** Where the nodes are in a frame: x and y, one after the other, m, against `origin`. */
export type Places = Float32Array;

export class Frames {
  readonly count: number;
  /** Middle of everything in the first frame, m: what is drawn is near 0, where 32 bits tell fine differences. */
  origin: [number, number] = [0, 0];
  corners = new Uint32Array();
  node_numbers = new Uint32Array();
  element_numbers = new Uint32Array();
  #centres: [Float64Array, Float64Array] = [new Float64Array(), new Float64Array()];

  constructor(
    readonly run: Run,
    readonly blocks: Blocks,
  ) {
    this.count = run.times.length;
  }

  /** Reads what all frames share. */
  async open(): Promise<void> {
    const { run, blocks } = this;
    if (this.count === 0) return;
    const [corners, node_numbers, element_numbers, x, y] = await Promise.all(
      [run.corners, run.node_numbers, run.element_numbers, run.centre_x, run.centre_y].map((ref) => blocks.once(ref)),
    );
    [this.corners, this.node_numbers, this.element_numbers] = [corners, node_numbers, element_numbers].map((numbers) =>
      Uint32Array.from(numbers),
    );
    const in_metres = (numbers: ArrayLike<number>, { low = 0, step = 1 }) =>
      Float64Array.from(numbers, (n) => low + step * n);
    this.#centres = [in_metres(x, run.centre_x), in_metres(y, run.centre_y)];
    this.origin = this.centre(0, 0);
  }

  /** The middle of a body in a frame, m. */
  centre(frame: number, body: number): [number, number] {
    const k = frame * this.run.bodies.length + body;
    return [this.#centres[0][k], this.#centres[1][k]];
  }

  quantity(name: string): Quantity | undefined {
    return this.run.quantities.find((q) => q.name === name);
  }

  static chunk(chunks: Chunk[], frame: number): Chunk {
    const chunk = chunks.find((c) => frame >= c.first && frame < c.first + c.rows);
    if (!chunk) throw new Error(`frame ${frame} is missing`);
    return chunk;
  }

  #chunks(frame: number, names: string[]): Chunk[] {
    return names.flatMap((name) => {
      const quantity = this.quantity(name);
      return quantity ? [Frames.chunk(quantity.chunks, frame)] : [];
    });
  }

  /** Are these quantities at hand in this frame? */
  ready(frame: number, names: string[]): boolean {
    return this.#chunks(frame, names).every((chunk) => this.blocks.kept(chunk) !== undefined);
  }

  async load(frame: number, names: string[]): Promise<void> {
    await Promise.all(this.#chunks(frame, names).map((chunk) => this.blocks.numbers(chunk)));
  }

  /** Values of a quantity in a frame that is ready. */
  values(name: string, frame: number): Float32Array {
    const [chunk] = this.#chunks(frame, [name]);
    const numbers = chunk && this.blocks.kept(chunk);
    if (!numbers) throw new Error(`${name} of frame ${frame} is not at hand`);
    const begin = (frame - chunk.first) * chunk.columns;
    return real_values(numbers.subarray(begin, begin + chunk.columns), chunk);
  }

  /** Where the nodes are in a frame of which x and y are ready. */
  places(frame: number): Places {
    const x = this.values("x", frame);
    const y = this.values("y", frame);
    const out = new Float32Array(2 * x.length);
    this.run.bodies.forEach((body, b) => {
      const [cx, cy] = this.centre(frame, b);
      const [dx, dy] = [cx - this.origin[0], cy - this.origin[1]];
      for (let i = body.node_begin; i < body.node_end; ++i) {
        out[2 * i] = dx + x[i];
        out[2 * i + 1] = dy + y[i];
      }
    });
    return out;
  }

  body_of(on: "nodes" | "elements", index: number): number {
    return this.run.bodies.findIndex((b) =>
      on === "nodes" ? index >= b.node_begin && index < b.node_end : index >= b.element_begin && index < b.element_end,
    );
  }

  /** A quantity of one node or element, frame by frame; read from all chunks. */
  async column(name: string, index: number): Promise<Float32Array> {
    const quantity = this.quantity(name);
    if (!quantity) throw new Error(`${name} is not in this page`);
    const out = new Float32Array(this.count);
    for (const chunk of quantity.chunks) out.set(await this.blocks.column(chunk, index), chunk.first);
    return out;
  }
}

/** The frame nearest to a time, s; of two the later one. */
export function nearest_frame(times: number[], time: number): number {
  const after = times.findIndex((t) => t >= time);
  if (after <= 0) return after === 0 ? 0 : times.length - 1;
  return time - times[after - 1] < times[after] - time ? after - 1 : after;
}
