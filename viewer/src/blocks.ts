// The arrays of the page: asked for by their description, decoded by the worker, the last ones kept.
import { real_values, type Numbers } from "./arrays.ts";
import type { ArrayRef } from "./run.ts";
import type { Answer, Question } from "./worker.ts";

declare const WORKER_SOURCE: string;

type Unnumbered<Q> = Q extends unknown ? Omit<Q, "id"> : never;

export class Blocks {
  readonly #worker = new Worker(URL.createObjectURL(new Blob([WORKER_SOURCE], { type: "text/javascript" })));
  readonly #waiting = new Map<number, { give: (value: ArrayBufferView) => void; fail: (error: Error) => void }>();
  readonly #kept = new Map<number, Numbers>(); // the one used last stands last
  readonly #coming = new Map<number, Promise<Numbers>>();
  #bytes = 0;
  #questions = 0;

  /** `room`: bytes of decoded arrays that are kept. */
  constructor(private readonly room: number) {
    this.#worker.onmessage = (event: MessageEvent<Answer>) => {
      const { id, value, error } = event.data;
      const waiting = this.#waiting.get(id);
      this.#waiting.delete(id);
      if (value) waiting?.give(value);
      else waiting?.fail(new Error(error ?? "no answer"));
    };
  }

  #ask(question: Unnumbered<Question>): Promise<ArrayBufferView> {
    const id = ++this.#questions;
    return new Promise((give, fail) => {
      this.#waiting.set(id, { give, fail });
      this.#worker.postMessage({ id, ...question });
    });
  }

  #text(block: number): string {
    const element = document.getElementById(`block-${block}`);
    if (!element) throw new Error(`block ${block} is missing in this page`);
    return element.textContent ?? "";
  }

  /** The numbers, if they are at hand. */
  kept(ref: ArrayRef): Numbers | undefined {
    const numbers = this.#kept.get(ref.block);
    if (numbers) {
      this.#kept.delete(ref.block);
      this.#kept.set(ref.block, numbers);
    }
    return numbers;
  }

  async numbers(ref: ArrayRef): Promise<Numbers> {
    const kept = this.kept(ref);
    if (kept) return kept;
    let coming = this.#coming.get(ref.block);
    if (!coming) {
      coming = this.#ask({ kind: "numbers", text: this.#text(ref.block), ref }).then((value) => {
        this.#keep(ref.block, value as Numbers);
        return value as Numbers;
      });
      coming = coming.finally(() => this.#coming.delete(ref.block));
      this.#coming.set(ref.block, coming);
    }
    return coming;
  }

  #keep(block: number, numbers: Numbers): void {
    this.#kept.set(block, numbers);
    this.#bytes += numbers.byteLength;
    for (const [oldest, old] of this.#kept) {
      if (this.#bytes <= this.room || oldest === block) break;
      this.#kept.delete(oldest);
      this.#bytes -= old.byteLength;
    }
  }

  /** Decoded for whoever asks, and not kept. */
  async once(ref: ArrayRef): Promise<Numbers> {
    return (await this.#ask({ kind: "numbers", text: this.#text(ref.block), ref })) as Numbers;
  }

  async values(ref: ArrayRef): Promise<Float32Array> {
    return real_values(await this.once(ref), ref);
  }

  /** One column of a table, a value for each row. */
  async column(ref: ArrayRef, column: number): Promise<Float32Array> {
    const kept = this.kept(ref);
    if (kept) return real_values(kept.filter((_, k) => k % ref.columns === column) as Numbers, ref);
    return (await this.#ask({ kind: "column", text: this.#text(ref.block), ref, column })) as Float32Array;
  }

  async boundary(corners: Uint32Array, elements: number): Promise<Uint32Array> {
    return (await this.#ask({ kind: "boundary", corners, elements })) as Uint32Array;
  }
}
