// Runs beside the page: blocks into numbers, so that the page never stands still.
import { decode, real_values } from "./arrays.ts";
import { boundary_edges } from "./mesh.ts";
import type { ArrayRef } from "./run.ts";

/** What the page asks for. `texts` are the base64 of the blocks of `refs`. */
export type Question =
  | { id: number; kind: "numbers"; text: string; ref: ArrayRef }
  | { id: number; kind: "column"; text: string; ref: ArrayRef; column: number }
  | { id: number; kind: "boundary"; corners: Uint32Array; elements: number };

export type Answer = { id: number; value?: ArrayBufferView; error?: string };

async function answer(question: Question): Promise<ArrayBufferView> {
  if (question.kind === "boundary") return boundary_edges(question.corners, question.elements);
  const numbers = await decode(question.text, question.ref);
  if (question.kind === "numbers") return numbers;
  const { rows, columns } = question.ref;
  const column = numbers.filter((_, k) => k % columns === question.column);
  return real_values(column.subarray(0, rows), question.ref);
}

self.onmessage = async (event: MessageEvent<Question>) => {
  const { id } = event.data;
  try {
    const value = await answer(event.data);
    (self as unknown as Worker).postMessage({ id, value } satisfies Answer, [value.buffer as ArrayBuffer]);
  } catch (error) {
    (self as unknown as Worker).postMessage({ id, error: String(error) } satisfies Answer);
  }
};
