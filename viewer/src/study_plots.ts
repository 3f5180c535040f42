// Plots of a study: histories of all levels over each other, and a number over the element size or what was varied.
import uPlot from "uplot";
import type { Blocks } from "./blocks.ts";
import { curves } from "./colours.ts";
import { choice, h } from "./html.ts";
import { sections_of } from "./parts.ts";
import { readable, type Curve, type Plots } from "./plots.ts";
import type { History } from "./run.ts";
import type { Shown, Store } from "./store.ts";
import { is_of_steps, is_sweep, last_part, levels_of, step_levels_of, type ShownRun, type Study, type StudyQuantity, type Value } from "./study.ts";
import { digits, type Units } from "./units.ts";

/** A run in the plots. */
export interface Line {
  run: ShownRun;
  label: string;
  colour: string;
}

/** One plot for every column of every history, with a curve for each run that has it. */
export function history_sections(lines: Line[], plots: Plots, blocks: Blocks): HTMLElement[] {
  const finest = lines.at(-1)?.run;
  if (!finest) return [];
  const histories = [...finest.histories];
  for (const { run } of lines) {
    for (const history of run.histories) if (!histories.some((known) => known.name === history.name)) histories.push(history);
  }
  const read = new Map<History, Promise<Float32Array>>(); // while a section is being drawn
  const values = (history: History): Promise<Float32Array> => {
    const known = read.get(history) ?? blocks.values(history.values);
    read.set(history, known);
    if (read.size > 24) read.delete(read.keys().next().value!);
    return known;
  };
  return sections_of({ ...finest, histories }).map(({ title, open, histories }) => {
    const inside = h("div", { class: "plots" });
    const details = h("details", { open: open && (title === "Observed" || title === "Contact forces"), class: "histories" },
      h("summary", {}, title), inside);
    const fill = (): void => {
      if (!details.open || inside.firstChild) return;
      for (const history of histories) {
        history.columns.slice(1).forEach((column) => inside.append(column_plot(history.name, column, lines, plots, values)));
      }
    };
    details.addEventListener("toggle", fill);
    fill();
    return details;
  });
}

function column_plot(
  name: string, column: History["columns"][0], lines: Line[], plots: Plots, values: (history: History) => Promise<Float32Array>,
): HTMLElement {
  const title = `${name}: ${readable(column.name)}`;
  const place = h("figure", { class: "plot", "data-plot": `${name}.${column.name}` }, h("figcaption", {}, title));
  plots.later(place, () => void draw());
  const draw = async (): Promise<void> => {
    const found: Curve[] = [];
    for (const { run, label, colour } of lines) {
      const history = run.histories.find((known) => known.name === name);
      const k = history?.columns.findIndex((c) => c.name === column.name) ?? -1;
      if (!history || k < 1) continue;
      const all = await values(history);
      const row = (n: number): Float32Array => all.subarray(n * history.values.columns, (n + 1) * history.values.columns);
      found.push({ name: label, times: row(0), values: row(k), colour });
    }
    if (!found.some(({ values: v }) => v.some((x) => x !== 0))) {
      place.classList.add("quiet");
      place.append(h("p", { class: "left-out" }, "0 all the time, on all levels"));
      return;
    }
    plots.draw(place, { title, unit: column.unit, times: found[0].times!, curves: found });
  };
  return place;
}

/** Points that belong together: those of one size or varied value over another. */
interface Series {
  name: string;
  points: { x: number; y: number; label: string }[];
}

/** A chosen number over the element size, or over what was varied. */
export class NumberPlot {
  readonly element: HTMLElement;
  readonly #place = h("figure", { class: "plot", id: "number-plot" });
  readonly #select: HTMLSelectElement;
  #over = 0; // which of the varied values
  #shown: StudyQuantity | null = null;
  #plot: uPlot | null = null;
  readonly #is_of_steps: boolean;

  constructor(private readonly study: Study, private readonly units: Units, store: Store<Shown>) {
    this.#is_of_steps = is_of_steps(study, units);
    const usable = study.quantities.filter((q) => q.values.some((v) => v !== null));
    const sorted = [...usable.filter((q) => q.headline), ...usable.filter((q) => !q.headline)];
    const chosen = choice("number", sorted.map((q, k) => [String(k), q.name] as const), "0", (value) => this.show(sorted[Number(value)]));
    this.#select = chosen.select;
    this.#select.id = "number";
    const over = choice("over", study.varied.map((path, k) => [String(k), path] as const), "0", (value) => {
      this.#over = Number(value);
      this.#draw();
    });
    this.element = h("section", { id: "number-section" }, h("h2", {}, is_sweep(study) ? "A number over what was varied" : `A number over ${this.#size_words}`),
      h("div", { class: "bar" }, chosen.label, is_sweep(study) && study.varied.length > 1 ? over.label : null), this.#place);
    this.show = (quantity) => {
      this.#shown = quantity;
      this.#select.value = String(sorted.indexOf(quantity));
      this.#draw();
    };
    this.element.hidden = sorted.length === 0;
    if (sorted.length > 0) {
      this.#shown = sorted[0];
      // Its width is known when it stands in the page.
      requestAnimationFrame(() => this.#draw());
    }
    store.on(["units"], () => this.#draw());
    new ResizeObserver(() => {
      const width = this.#place.clientWidth;
      if (this.#plot && width > 0 && width !== this.#plot.width) this.#plot.setSize({ width, height: 240 });
    }).observe(this.#place);
  }

  show: (quantity: StudyQuantity) => void;

  get #size_words(): string {
    return this.#is_of_steps ? "time step" : "element size";
  }

  redraw(): void {
    this.#plot?.redraw(false);
  }

  #series(quantity: StudyQuantity): { series: Series[]; names: string[] | null } {
    const { study } = this;
    if (!is_sweep(study)) {
      const by_step = this.#is_of_steps;
      const points = (by_step ? step_levels_of(study, this.units) : levels_of(study, this.units)).flatMap(({ run, index, label }) => {
        const [x, y] = [by_step ? run.longest_step : study.element_sizes[run.mesh] ?? null, quantity.values[index] ?? null];
        return x === null || y === null ? [] : [{ x, y, label }];
      });
      return { series: [{ name: "", points }], names: null };
    }
    const done = study.runs.map((run, index) => ({ run, index })).filter(({ run }) => run.state === "done");
    const is_words = done.some(({ run }) => typeof run.values[this.#over] !== "number");
    const names = is_words ? [...new Set(done.map(({ run }) => run.texts[this.#over] ?? run.name))] : null;
    const series = new Map<string, Series>();
    for (const { run, index } of done) {
      const text = run.texts[this.#over] ?? run.name;
      const y: Value = quantity.values[index] ?? null;
      const x = names ? names.indexOf(text) : (run.values[this.#over] as number);
      if (y === null) continue;
      const others = run.texts.map((t, k) => `${last_part(study.varied[k] ?? "")} ${t}`).filter((_, k) => k !== this.#over).join(", ");
      const known = series.get(others) ?? { name: others || last_part(quantity.name), points: [] };
      known.points.push({ x, y, label: text });
      series.set(others, known);
    }
    for (const { points } of series.values()) points.sort((a, b) => a.x - b.x);
    return { series: [...series.values()], names };
  }

  #draw(): void {
    const quantity = this.#shown;
    this.#plot?.destroy();
    this.#plot = null;
    if (!quantity) return;
    const { study } = this;
    const { series, names } = this.#series(quantity);
    const most = Math.max(0, ...series.flatMap(({ points }) => points.map(({ y }) => Math.abs(y))));
    const unit = this.units.for(quantity.unit, most);
    const sizes = !is_sweep(study);
    const x_unit = sizes ? this.units.for(this.#is_of_steps ? "s" : "m", Math.max(0, ...series.flatMap(({ points }) => points.map(({ x }) => x)))) : { name: "", size: 1 };
    const tables = series.map(({ points }) => [points.map(({ x }) => x / x_unit.size), points.map(({ y }) => y / unit.size)] as uPlot.AlignedData);
    const { error, extrapolated } = this.#is_of_steps ? quantity.step : quantity.mesh;
    const limit = sizes ? extrapolated : null;
    const element = h("div", { class: "curves", role: "img", "aria-label": `${quantity.name} over ${sizes ? this.#size_words : study.varied[this.#over] ?? "runs"}` });
    const axis_words = sizes ? `${this.#size_words}, ${x_unit.name}` : study.varied[this.#over] ?? "";
    this.#place.replaceChildren(
      h("figcaption", {}, `${quantity.name}${unit.name ? `, ${unit.name}` : ""}`), element,
      h("p", { class: "axis-words" }, axis_words),
      ...(series.length > 1 ? [h("p", { class: "keys-of-curves" }, ...series.map(({ name }, k) => {
        const dot = h("span", { class: "dot" });
        dot.style.background = curves[k % curves.length];
        return h("span", {}, dot, name);
      }))] : []),
      limit !== null ? h("p", { class: "left-out" }, `dashed: for size 0, ${digits(limit / unit.size, 5)} ${unit.name}` +
        (error !== null ? `; bar: ± ${digits(error / unit.size, 2)} ${unit.name} of the finest` : "")) : "");
    if (tables.every(([x]) => x.length === 0)) {
      element.append(h("p", { class: "left-out" }, "No run has this number."));
      return;
    }
    const css = (name: string) => (): string => getComputedStyle(document.body).getPropertyValue(name);
    const axis = (): uPlot.Axis => ({ stroke: css("--ink"), grid: { stroke: css("--line"), width: 1 },
      ticks: { stroke: css("--line"), width: 1, size: 4 }, font: "11px system-ui, sans-serif" });
    const finest = series[0]?.points.reduce((a, b) => (b.x < a.x ? b : a), series[0].points[0]);
    const marks = (plot: uPlot): void => {
      const { ctx, bbox } = plot;
      ctx.save();
      ctx.strokeStyle = css("--accent")();
      ctx.lineWidth = 1.5 * devicePixelRatio;
      if (limit !== null) {
        const y = plot.valToPos(limit / unit.size, "y", true);
        ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        ctx.setLineDash([]);
      }
      if (sizes && error !== null && finest) {
        const x = plot.valToPos(finest.x / x_unit.size, "x", true);
        const ends = [-1, 1].map((side) => plot.valToPos((finest.y + side * error) / unit.size, "y", true));
        const cap = 5 * devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(x, ends[0]);
        ctx.lineTo(x, ends[1]);
        for (const y of ends) {
          ctx.moveTo(x - cap, y);
          ctx.lineTo(x + cap, y);
        }
        ctx.stroke();
      }
      ctx.restore();
    };
    const shown = tables.flatMap(([, ys]) => [...ys] as number[]);
    const extra = [limit, sizes && error !== null && finest ? finest.y - error : null, sizes && error !== null && finest ? finest.y + error : null]
      .flatMap((v) => (v === null ? [] : [v / unit.size]));
    const bounds = [...shown, ...extra];
    const [low, high] = [Math.min(...bounds), Math.max(...bounds)];
    const room = 0.08 * (high - low || Math.abs(high) || 1);
    const xs = tables.flatMap(([x]) => [...x] as number[]);
    const [left, right] = [sizes ? 0 : Math.min(...xs), Math.max(...xs)];
    const side = 0.06 * (right - left || 1);
    this.#plot = new uPlot(
      {
        width: this.#place.clientWidth || 400, height: 240, legend: { show: false },
        cursor: { drag: { x: false, y: false } },
        scales: { x: { time: false, range: [left - (sizes ? 0 : side), right + side] }, y: { range: [low - room, high + room] } },
        axes: [
          { ...axis(), size: 26, values: (_, ticks) => ticks.map((v) => (names ? names[v] ?? "" : digits(v))), ...(names ? { splits: () => names.map((_, k) => k) } : {}) },
          { ...axis(), size: 62, values: (_, ticks) => ticks.map((v) => digits(v, 5)) },
        ],
        series: [{}, ...series.map((_, k) => ({
          stroke: curves[k % curves.length], width: 1.8, spanGaps: true, points: { show: true, size: 8, fill: curves[k % curves.length] },
        }))],
        hooks: { draw: [marks] },
      },
      tables.length > 1 ? uPlot.join(tables) : tables[0],
      element,
    );
  }
}
