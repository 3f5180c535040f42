// Histories as curves over time, with the line of the time that is shown and the largest, present and smallest value.
import uPlot from "uplot";
import type { Blocks } from "./blocks.ts";
import { curves } from "./colours.ts";
import { h, meaning } from "./html.ts";
import type { History } from "./run.ts";
import type { Shown, Store } from "./store.ts";
import { digits, type Units } from "./units.ts";

/** A curve: values in SI. */
export interface Curve {
  name: string;
  values: Float32Array;
  times?: Float32Array; // s, where they are not those of the plot
  colour?: string;
}

/** The time that is shown. */
export interface Clock {
  time(): number; // s
  end: number | undefined; // of the runs, s
}

/** Curves of one unit over the same times. */
export interface PlotData {
  title: string;
  unit: string; // SI
  times: Float32Array; // s
  curves: Curve[];
}

export const readable = (name: string): string => name.replace(/_/g, " ");

const title_of = (history: History, group: string): string =>
  history.name === group ? group : `${history.name}: ${group}`;

/** Columns that belong in one plot: those of one unit whose names differ only in their end (x and y, 1, 2 and 3), and
 *  all terms of the energy. */
export function groups_of(history: History): { title: string; unit: string; columns: number[] }[] {
  const groups: { title: string; unit: string; columns: number[] }[] = [];
  history.columns.forEach(({ name, unit }, k) => {
    if (k === 0) return;
    const title = history.name === "energy" ? "energy" : readable(name.replace(/_(x|y|xy|z|[123])$/, ""));
    const known = groups.find((g) => g.title === title && g.unit === unit);
    if (known) known.columns.push(k);
    else groups.push({ title, unit, columns: [k] });
  });
  return groups;
}

/** The value of a curve at a time, between its rows on the line through them. */
export function at_time(times: Float32Array, values: Float32Array, time: number): number {
  let low = 0;
  let high = times.length - 1;
  if (high < 0) return NaN;
  if (time <= times[low]) return values[low];
  if (time >= times[high]) return values[high];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  const part = (time - times[low]) / (times[high] - times[low]);
  return part === 0 ? values[low] : values[low] + part * (values[high] - values[low]);
}

interface Drawn {
  plot: uPlot;
  element: HTMLElement;
  update: () => void;
  /** Only what is in sight follows the time; the rest catches up when it comes into sight. */
  in_sight: boolean;
}

export class Plots {
  readonly #drawn = new Map<Element, Drawn>();
  readonly #makers = new Map<Element, () => void>();
  readonly #sight = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const drawn = this.#drawn.get(target);
      if (drawn) {
        drawn.in_sight = isIntersecting;
        if (isIntersecting) drawn.update();
      }
      const make = isIntersecting && this.#makers.get(target);
      if (!make) continue;
      this.#makers.delete(target);
      make();
    }
  }, { rootMargin: "200px" });

  constructor(
    private readonly clock: Clock,
    private readonly blocks: Blocks,
    store: Store<Shown>,
    private readonly units: Units,
    private readonly go: (time: number) => void,
  ) {
    store.on(["frame"], () => this.#each(({ in_sight, update }) => in_sight && update()));
    new ResizeObserver(() => this.#each(({ plot, element }) => this.#fit(plot, element))).observe(document.body);
  }

  get time(): number {
    return this.clock.time();
  }

  #each(what: (drawn: Drawn) => void): void {
    for (const [place, drawn] of this.#drawn) {
      if (place.isConnected) {
        what(drawn);
      } else {
        drawn.plot.destroy();
        this.#drawn.delete(place);
      }
    }
  }

  #fit(plot: uPlot, element: HTMLElement): void {
    const width = element.clientWidth;
    if (width > 0 && width !== plot.width) plot.setSize({ width, height: 170 });
  }

  /** All plots of a history; each is made when it comes into sight. */
  of_history(history: History): HTMLElement {
    const box = h("div", { class: "plots" });
    let values: Promise<Float32Array> | null = null;
    for (const group of groups_of(history)) {
      const place = h("figure", { class: "plot", "data-plot": `${history.name}.${group.title}` },
        h("figcaption", {}, title_of(history, group.title)));
      box.append(place);
      this.later(place, () => {
        values ??= this.blocks.values(history.values);
        void values.then((all) => {
          const row = (k: number): Float32Array =>
            all.subarray(k * history.values.columns, (k + 1) * history.values.columns);
          this.draw(place, {
            title: title_of(history, group.title),
            unit: group.unit,
            times: row(0),
            curves: group.columns.map((k) => ({ name: readable(history.columns[k].name), values: row(k) })),
          });
        });
      });
    }
    return box;
  }

  /** Makes what belongs into `place` when it comes into sight. */
  later(place: HTMLElement, make: () => void): void {
    this.#makers.set(place, make);
    this.#sight.observe(place);
  }

  /** Fills `place` with a plot. */
  draw(place: HTMLElement, all: PlotData): void {
    // Of many terms those that are nothing all the time only take room.
    const is_something = ({ values }: Curve): boolean => values.some((v) => v !== 0);
    const quiet = all.curves.length > 4 ? all.curves.filter((curve) => !is_something(curve)) : [];
    const data = { ...all, curves: all.curves.filter((curve) => !quiet.includes(curve)) };
    const colour_of = (curve: Curve): string => curve.colour ?? curves[all.curves.indexOf(curve) % curves.length];
    const most = data.curves.reduce((sofar, { values }) => values.reduce((m, v) => Math.max(m, Math.abs(v) || 0), sofar), 0);
    const unit = this.units.for(data.unit, most);
    const time_unit = this.units.for("s", this.clock.end ?? data.times[data.times.length - 1] ?? 0);
    const scaled = (values: Float32Array, size: number): Float64Array => Float64Array.from(values, (v) => v / size);
    // Rounding errors of what is 0 would only confuse.
    const say = (value: number): string => digits(Math.abs(value) < 1e-9 * most ? 0 : value / unit.size);
    const figures = h("tbody");
    const heads = ["", "maximum", "now", "minimum"].map((head) => h("th", { scope: "col" }, head));
    const cells = data.curves.map((curve) => {
      const [high, now, low] = [h("td"), h("td", { class: "now" }), h("td")];
      const known = curve.values.filter((v) => Number.isFinite(v));
      high.textContent = say(known.reduce((a, b) => Math.max(a, b), -Infinity));
      low.textContent = say(known.reduce((a, b) => Math.min(a, b), Infinity));
      const dot = h("span", { class: "dot" });
      dot.style.background = colour_of(curve);
      figures.append(h("tr", {}, h("th", { scope: "row", title: meaning(curve.name) }, dot, curve.name), high, now, low));
      return now;
    });
    const element = h("div", { class: "curves", role: "img", "aria-label": `${data.title} over time` });
    place.replaceChildren(
      h("figcaption", {}, `${data.title}${unit.name ? `, ${unit.name}` : ""}`),
      element,
      h("table", { class: "figures" }, h("thead", {}, h("tr", {}, ...heads)), figures),
      quiet.length > 0 ? h("p", { class: "left-out" }, `0 all the time: ${quiet.map((c) => c.name).join(", ")}`) : "",
    );
    const ink = (): string => getComputedStyle(document.body).getPropertyValue("--ink");
    const line = (): string => getComputedStyle(document.body).getPropertyValue("--line");
    const axis = (): uPlot.Axis => ({
      stroke: ink, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1, size: 4 },
      font: "11px system-ui, sans-serif", values: (_, ticks) => ticks.map((v) => digits(v)),
    });
    const line_of_time = h("div", { class: "time-line" });
    const mark_time = (plot: uPlot): void => {
      const x = plot.valToPos(this.time / time_unit.size, "x");
      line_of_time.hidden = !(x >= 0 && x <= plot.over.clientWidth);
      line_of_time.style.transform = `translateX(${x}px)`;
    };
    const times_of = (curve: Curve): Float32Array => curve.times ?? data.times;
    const aligned: uPlot.AlignedData = data.curves.some(({ times }) => times)
      ? uPlot.join(data.curves.map((c) => [scaled(times_of(c), time_unit.size), scaled(c.values, unit.size)]))
      : [scaled(data.times, time_unit.size), ...data.curves.map((c) => scaled(c.values, unit.size))];
    const plot = new uPlot(
      {
        width: element.clientWidth || 400,
        height: 170,
        legend: { show: false },
        cursor: { points: { show: false }, drag: { x: true, y: false } },
        scales: { x: { time: false } },
        axes: [{ ...axis(), size: 26 }, { ...axis(), size: 58 }],
        series: [{}, ...data.curves.map((curve) => ({ stroke: colour_of(curve), width: 1.5, spanGaps: false }))],
        hooks: { draw: [(self) => mark_time(self)] },
      },
      aligned,
      element,
    );
    element.append(h("span", { class: "axis-unit" }, time_unit.name));
    element.addEventListener("click", (event) => {
      const left = event.clientX - plot.over.getBoundingClientRect().left;
      this.go(plot.posToVal(left, "x") * time_unit.size);
    });
    const update = (): void => {
      cells.forEach((cell, k) => {
        cell.textContent = say(at_time(times_of(data.curves[k]), data.curves[k].values, this.time));
      });
      mark_time(plot);
    };
    plot.over.append(line_of_time);
    update();
    this.#drawn.set(place, { plot, element, update, in_sight: true });
    this.#sight.observe(place);
  }

  /** Makes the plots of open sections that were not in sight yet, so that a print has them; not of a heap of bodies. */
  make_some(most: number): void {
    for (const [place, make] of [...this.#makers].slice(0, most)) {
      this.#makers.delete(place);
      if (place.isConnected) make();
    }
  }

  /** Draws all again, for other units or colours. */
  redraw(): void {
    this.#each(({ plot }) => plot.redraw(false));
  }
}
