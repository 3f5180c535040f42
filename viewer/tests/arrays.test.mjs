// Tables, meshes, units and addresses, without a browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { load_source } from "./source.mjs";

const { decode, restore, real_values } = await load_source("arrays.ts");
const { boundary_edges, element_at, node_means } = await load_source("mesh.ts");
const { digits, nice_ticks, with_unit, Units } = await load_source("units.ts");
const { from_address, to_address } = await load_source("address.ts");

/** A table as docs/report-format.md says, written from that text and from nothing else. */
function planes_of(table, rows, columns, bytes) {
  const modulus = 2n ** BigInt(8 * bytes);
  const out = new Uint8Array(rows * columns * bytes);
  const at = (row, column) => (row < 0 ? 0n : BigInt(table[row * columns + column]));
  const difference = (row, column) => (column < 0 ? 0n : at(row, column) - at(row - 1, column));
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const r = BigInt.asIntN(8 * bytes, difference(row, column) - difference(row, column - 1));
      const coded = (r >= 0n ? 2n * r : -2n * r - 1n) % modulus;
      for (let b = 0; b < bytes; ++b) {
        out[b * rows * columns + row * columns + column] = Number((coded >> BigInt(8 * b)) & 255n);
      }
    }
  }
  return out;
}

/** Numbers without order, the same in every test. */
function* numbers(seed) {
  let state = seed;
  while (true) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    yield state;
  }
}

test("tables of every width come back as they were", async () => {
  const random = numbers(7);
  for (const bytes of [1, 2, 4]) {
    for (const [rows, columns] of [[1, 1], [1, 9], [9, 1], [5, 7], [25, 40], [0, 3], [3, 0]]) {
      const table = Array.from({ length: rows * columns }, () => random.next().value >>> (32 - 8 * bytes));
      const planes = planes_of(table, rows, columns, bytes);
      assert.deepEqual([...restore(planes, rows, columns, bytes)], table);
      const text = Buffer.from(deflateRawSync(planes)).toString("base64");
      assert.deepEqual([...(await decode(text, { block: 0, rows, columns, bytes }))], table);
    }
  }
});

test("a block of another size is refused", () => {
  assert.throws(() => restore(new Uint8Array(5), 1, 3, 2), /5 bytes where 6/);
});

test("numbers stand for values, for nothing, or for themselves", () => {
  assert.deepEqual([...real_values(Uint16Array.of(0, 4, 9), { low: -1, step: 0.5, none: 9 })], [-1, 1, NaN]);
  const floats = Float32Array.of(1.5, -2, 3e8);
  assert.deepEqual([...real_values(new Uint32Array(floats.buffer), { float: true })], [...floats]);
});

test("the boundary is what belongs to one triangle", () => {
  // A square of two triangles; rows of corners.
  const corners = Uint32Array.of(0, 0, 1, 2, 2, 3);
  const edges = boundary_edges(corners, 2);
  const pairs = Array.from({ length: edges.length / 2 }, (_, k) => `${edges[2 * k]}-${edges[2 * k + 1]}`);
  assert.deepEqual(pairs.sort(), ["0-1", "1-2", "2-3", "3-0"]);
  const places = Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1);
  assert.equal(element_at(corners, places, 0.7, 0.2), 0);
  assert.equal(element_at(corners, places, 0.2, 0.7), 1);
  assert.equal(element_at(corners, places, 1.2, 0.7), -1);
  assert.deepEqual([...node_means(corners, Float32Array.of(1, 3), 4)], [2, 1, 2, 3]);
  assert.deepEqual([...node_means(corners, Float32Array.of(NaN, 3), 4)], [3, NaN, 3, 3]);
});

test("numbers are written for people", () => {
  for (const [value, words] of [[0, "0"], [12.3456, "12.35"], [-0.00123, "−0.00123"], [1.5e-5, "1.5e−5"], [123456, "1.235e5"], [NaN, "–"], [100, "100"]]) {
    assert.equal(digits(value), words);
  }
  const units = new Units();
  assert.equal(with_unit(0.00052, "s", units), "520 µs");
  assert.equal(with_unit(2.5e8, "Pa", units), "250 MPa");
  units.follow('yield_stress = "2400 kgf/cm^2"\nelement_size = "0.25 cm"');
  assert.equal(with_unit(98066.5 * 2400, "Pa", units), "2400 kgf/cm²");
  assert.equal(with_unit(0.1, "m", units), "10 cm");
});

test("ticks are 1, 2 or 5 times a power of ten and lie inside", () => {
  const random = numbers(3);
  for (let k = 0; k < 500; ++k) {
    const low = (random.next().value / 2 ** 32 - 0.5) * 10 ** ((random.next().value % 20) - 10);
    const high = low + (random.next().value / 2 ** 32 + 1e-3) * 10 ** ((random.next().value % 20) - 10);
    const ticks = nice_ticks(low, high, 6);
    const size = Math.max(Math.abs(low), Math.abs(high));
    if (high - low < 1e-9 * size) continue;
    assert.ok(ticks.length <= 8 && ticks.length >= 2, `${ticks.length} ticks from ${low} to ${high}`);
    for (const tick of ticks) assert.ok(tick >= low - 1e-6 * (high - low) && tick <= high + 1e-6 * (high - low));
    const mantissa = Number((ticks[1] - ticks[0]).toExponential(6).split("e")[0]);
    assert.ok([1, 2, 5].some((m) => Math.abs(mantissa - m) < 1e-3 * m), `a step of ${mantissa}`);
  }
});

test("an address brings back what was shown, and nothing that cannot be", () => {
  const shown = {
    frame: 7, field: "principal_1", centre: [0.25, -0.5], width: 1.5, map: "grey", follow: "beam", range: "own", low: -2e8,
    high: 3e8, smooth: true, mesh: false, outline: true, ghost: false, forces: false, picked: { on: "nodes", index: 3 },
  };
  assert.deepEqual(from_address(to_address(shown), 10, 5, 8), shown);
  const strange = from_address("frame=12&at=1,x,2&range=5,5&picked=nodes,9&show=<script>", 10, 5, 8);
  assert.deepEqual(strange, { smooth: false, mesh: false, outline: false, ghost: false, forces: false });
});
