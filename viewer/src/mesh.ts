// What can be told from the corners of the triangles alone.

/** Edges that belong to one triangle only: pairs of nodes, one after the other, the triangle on their left. */
export function boundary_edges(corners: Uint32Array, elements: number): Uint32Array {
  // Each edge as one number, the smaller node first, with its place; equal ones stand side by side once sorted.
  const keys = new Float64Array(3 * elements);
  const nodes = corners.reduce((most, node) => Math.max(most, node), 0) + 1;
  const ends = (k: number): [number, number] => {
    const element = Math.floor(k / 3);
    const side = k % 3;
    return [corners[side * elements + element], corners[((side + 1) % 3) * elements + element]];
  };
  for (let k = 0; k < keys.length; ++k) {
    const [a, b] = ends(k);
    keys[k] = Math.min(a, b) * nodes + Math.max(a, b);
  }
  const sorted = keys.slice().sort();
  const single = new Set<number>();
  for (let k = 0; k < sorted.length; ) {
    let next = k + 1;
    while (next < sorted.length && sorted[next] === sorted[k]) ++next;
    if (next === k + 1) single.add(sorted[k]);
    k = next;
  }
  const out: number[] = [];
  for (let k = 0; k < keys.length; ++k) if (single.has(keys[k])) out.push(...ends(k));
  return Uint32Array.from(out);
}

/** Means at the nodes of the elements that meet there; NaN where no element has a value. */
export function node_means(corners: Uint32Array, values: Float32Array, nodes: number): Float32Array {
  const sums = new Float32Array(nodes);
  const counts = new Uint16Array(nodes);
  const elements = values.length;
  for (let e = 0; e < elements; ++e) {
    const value = values[e];
    if (value !== value) continue;
    for (let c = 0; c < 3; ++c) {
      const node = corners[c * elements + e];
      sums[node] += value;
      ++counts[node];
    }
  }
  for (let i = 0; i < nodes; ++i) sums[i] = counts[i] > 0 ? sums[i] / counts[i] : NaN;
  return sums;
}

/** The element in which a point lies, or -1. `places` holds x and y of each node, one after the other. */
export function element_at(corners: Uint32Array, places: Float32Array, x: number, y: number): number {
  const elements = corners.length / 3;
  for (let e = 0; e < elements; ++e) {
    const a = 2 * corners[e];
    const b = 2 * corners[elements + e];
    const c = 2 * corners[2 * elements + e];
    const side = (p: number, q: number): number =>
      (places[q] - places[p]) * (y - places[p + 1]) - (places[q + 1] - places[p + 1]) * (x - places[p]);
    const s = side(a, b);
    if (s >= 0 ? side(b, c) >= 0 && side(c, a) >= 0 : side(b, c) <= 0 && side(c, a) <= 0) return e;
  }
  return -1;
}
