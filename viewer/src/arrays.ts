// Bytes of a block back into numbers: docs/report-format.md, "Arrays".
import type { ArrayRef } from "./run.ts";

export type Numbers = Uint8Array | Uint16Array | Uint32Array;

export function from_base64(text: string): Uint8Array<ArrayBuffer> {
  const known = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };
  if (known.fromBase64) return known.fromBase64(text);
  const bytes = atob(text);
  const out = new Uint8Array(bytes.length);
  for (let k = 0; k < bytes.length; ++k) out[k] = bytes.charCodeAt(k);
  return out;
}

export async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The table, row by row, from its byte planes. Throws where the bytes are not those of such a table. */
export function restore(planes: Uint8Array, rows: number, columns: number, bytes: number): Numbers {
  const size = rows * columns;
  if (planes.length !== size * bytes) {
    throw new Error(`a block has ${planes.length} bytes where ${size * bytes} are needed`);
  }
  const make = { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[bytes];
  if (!make) throw new Error(`numbers of ${bytes} bytes are unknown`);
  const out = new make(size);
  for (let row = 0, k = 0; row < rows; ++row) {
    let difference = 0; // from the row above
    for (let column = 0; column < columns; ++column, ++k) {
      let coded = planes[k];
      for (let b = 1; b < bytes; ++b) coded |= planes[k + b * size] << (8 * b);
      difference = (difference + ((coded >>> 1) ^ -(coded & 1))) | 0;
      out[k] = (row > 0 ? out[k - columns] : 0) + difference; // wraps as the format asks
    }
  }
  return out;
}

export async function decode(text: string, ref: ArrayRef): Promise<Numbers> {
  return restore(await inflate(from_base64(text)), ref.rows, ref.columns, ref.bytes);
}

/** What the numbers of a table stand for; NaN where they stand for nothing. */
export function real_values(numbers: Numbers, ref: ArrayRef, out = new Float32Array(numbers.length)): Float32Array {
  if (ref.float) {
    out.set(new Float32Array(numbers.buffer, numbers.byteOffset, numbers.length));
    return out;
  }
  const low = ref.low ?? 0;
  const step = ref.step ?? 1;
  for (let k = 0; k < numbers.length; ++k) out[k] = low + step * numbers[k];
  if (ref.none !== undefined) {
    for (let k = 0; k < numbers.length; ++k) if (numbers[k] === ref.none) out[k] = NaN;
  }
  return out;
}
