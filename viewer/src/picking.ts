// A node or element that the user points at: what it is, what it feels now, what it felt over time.
import { field_series, flow_words, type Field } from "./fields.ts";
import type { Frames } from "./frames.ts";
import { choice, h } from "./html.ts";
import { element_at } from "./mesh.ts";
import type { Plots } from "./plots.ts";
import type { Run, Point } from "./run.ts";
import type { Drawn, Stage } from "./stage.ts";
import type { Picked, Shown, Store } from "./store.ts";
import { with_unit, type Units } from "./units.ts";

/** What lies at a place, m: the nearest corner of the element there, or the element. */
export function pick_at(frames: Frames, drawn: Drawn, [x, y]: Point, on: Picked["on"]): Picked | null {
  const [px, py] = [x - frames.origin[0], y - frames.origin[1]];
  const element = element_at(frames.corners, drawn.places, px, py);
  if (element < 0) return null;
  if (on === "elements") return { on, index: element };
  const elements = frames.corners.length / 3;
  const nodes = [0, 1, 2].map((c) => frames.corners[c * elements + element]);
  const distance = (n: number): number => Math.hypot(drawn.places[2 * n] - px, drawn.places[2 * n + 1] - py);
  return { on, index: nodes.reduce((best, n) => (distance(n) < distance(best) ? n : best)) };
}

const mean = (values: number[]): number => values.reduce((sum, v) => sum + v, 0) / values.length;

export class Picking {
  readonly element = h("section", { id: "picked", "aria-label": "Picked node or element" });
  readonly #now = h("dl", { class: "rows", id: "picked-now" });
  readonly #plot = h("div", { class: "plots" });
  readonly #what = h("p", { id: "picked-name", role: "status" });
  readonly #number = h("input", { type: "number", min: "0", id: "pick-number", "aria-label": "Number of the node or element" });
  on: Picked["on"] = "nodes";
  #neighbours: number[] = []; // of what is picked

  constructor(
    private readonly frames: Frames,
    private readonly run: Run,
    private readonly store: Store<Shown>,
    private readonly stage: Stage,
    private readonly plots: Plots,
    private readonly units: Units,
    private readonly field: () => Field | null,
  ) {
    const kind = choice("Click picks a", [["nodes", "node"], ["elements", "element"]], this.on, (value) => {
      this.on = value as Picked["on"];
    });
    kind.select.id = "pick-kind";
    const observed = Object.entries(run.observed);
    const names = choice("observed", [["", "–"], ...observed.map(([name]) => [name, name] as const)], "", (name) => {
      const at = run.observed[name];
      if (at) store.set({ picked: { on: at.on, index: at.index } });
    });
    const by_number = (): void => {
      const numbers = this.on === "nodes" ? frames.node_numbers : frames.element_numbers;
      const kind = this.on === "nodes" ? "node" : "element";
      const number = this.#number.value.trim();
      const index = number === "" ? -1 : numbers.indexOf(Number(number));
      store.set({ picked: index >= 0 ? { on: this.on, index } : null });
      if (index < 0) this.#what.textContent = number === "" ? `Write the number of a ${kind}.` : `There is no ${kind} ${number}.`;
    };
    this.#number.addEventListener("keydown", (event) => {
      if (event.key === "Enter") by_number();
    });
    this.element.append(
      h("div", { class: "bar" }, kind.label,
        h("label", { class: "choice" }, h("span", {}, "or its number"), this.#number),
        h("button", { type: "button", id: "pick-go", onclick: by_number }, "pick"),
        observed.length > 0 ? names.label : null,
        h("button", { type: "button", onclick: () => store.set({ picked: null }) }, "none")),
      this.#what, this.#now, this.#plot,
    );
    store.on(["picked"], () => {
      const { picked } = store.now;
      this.#neighbours = picked ? this.#find_neighbours(picked) : [];
      void this.#show();
    });
    store.on(["field", "units"], () => void this.#show());
    this.#name();
  }

  /** The name of what is picked: "node 412 of beam, observed as corner". */
  #name(): void {
    const { picked } = this.store.now;
    if (!picked) {
      this.#what.textContent = this.frames.count > 0 ? "Click into a body to see what happens there." : "";
      return;
    }
    const body = this.#body(picked);
    const numbers = picked.on === "nodes" ? this.frames.node_numbers : this.frames.element_numbers;
    const names = Object.entries(this.run.observed)
      .filter(([, o]) => o.on === picked.on && o.index === picked.index).map(([name]) => name);
    const is_bare = picked.on === "elements" && body?.rigid;
    this.#what.textContent =
      `${picked.on === "nodes" ? "Node" : "Element"} ${numbers[picked.index]} of ${body?.name ?? "?"}` +
      (names.length > 0 ? `, observed as ${names.join(", ")}: its histories below have more rows` : "") +
      (is_bare ? ", which is rigid: it has no stress" : "");
  }

  #body({ on, index }: Picked) {
    return this.run.bodies[this.frames.body_of(on, index)];
  }

  /** What the picked place feels in the frame that is drawn. */
  now(): void {
    const { picked } = this.store.now;
    const { drawn } = this.stage;
    this.#now.replaceChildren();
    if (!picked || !drawn) return;
    const say = (name: string, value: string, key: string) =>
      this.#now.append(h("dt", {}, name), h("dd", { "data-value": key }, value));
    const nodes = picked.on === "nodes" ? [picked.index] : this.#neighbours;
    for (const [k, axis] of ["x", "y"].entries()) {
      const place = mean(nodes.map((node) => drawn.places[2 * node + k])) + this.frames.origin[k];
      say(axis, with_unit(place, "m", this.units, 5), axis);
    }
    if (!drawn.field || !drawn.values) return;
    const { field, values } = drawn;
    if (field.on === picked.on) {
      const value = values[picked.index];
      say(field.label, field.flag ? flow_words(value) : with_unit(value, field.unit, this.units), field.id);
    } else if (!field.flag) {
      const where = picked.on === "nodes" ? "mean of the elements round it" : "mean of its nodes";
      say(`${field.label}, ${where}`, with_unit(mean(this.#neighbours.map((k) => values[k])), field.unit, this.units), field.id);
    }
  }

  /** An element's nodes, or the elements round a node. */
  #find_neighbours({ on, index }: Picked): number[] {
    const { corners } = this.frames;
    const elements = corners.length / 3;
    if (on === "elements") return [0, 1, 2].map((c) => corners[c * elements + index]);
    const found: number[] = [];
    corners.forEach((node, k) => node === index && found.push(k % elements));
    return found;
  }

  async #show(): Promise<void> {
    this.#name();
    this.now();
    this.#plot.replaceChildren();
    const { picked } = this.store.now;
    if (!picked) return;
    const times = Float32Array.from(this.run.times);
    const numbers = picked.on === "nodes" ? this.frames.node_numbers : this.frames.element_numbers;
    const name = `${picked.on === "nodes" ? "node" : "element"} ${numbers[picked.index]}`;
    const still = (): boolean => this.store.now.picked === picked;
    const place = (key: string) => {
      const figure = h("figure", { class: "plot", "data-plot": `picked.${key}` }, h("figcaption", {}, "reading all frames …"));
      this.#plot.append(figure);
      return figure;
    };
    const field = this.field();
    const is_bare = picked.on === "elements" && this.#body(picked)?.rigid;
    const at_field = field && field.on === picked.on && !field.flag && !is_bare ? place(field.id) : null;
    if (picked.on === "nodes") {
      const at = place("displacement");
      const body = this.frames.body_of("nodes", picked.index);
      const parts: Float32Array[] = [];
      for (const [k, quantity] of ["x", "y"].entries()) {
        const column = await this.frames.column(quantity, picked.index);
        const start = column[0] + this.frames.centre(0, body)[k];
        parts.push(column.map((v, frame) => v + this.frames.centre(frame, body)[k] - start));
      }
      if (!still()) return;
      this.plots.draw(at, { title: `${name}: displacement`, unit: "m", times,
        curves: [{ name: "displacement x", values: parts[0] }, { name: "displacement y", values: parts[1] }] });
    }
    if (field && at_field) {
      const values = await field_series(this.frames, field, picked.index);
      if (still()) {
        this.plots.draw(at_field, { title: `${name}: ${field.label.toLowerCase()}`, unit: field.unit, times,
          curves: [{ name: field.label.toLowerCase(), values }] });
      }
    }
  }
}
