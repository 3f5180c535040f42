// The stages of a study beside each other. One store tells what all show; each stage has its own, which follows: there
// the number of the frame is that of its run nearest to the common time.
import { Blocks } from "./blocks.ts";
import { curves } from "./colours.ts";
import { fields_of, type Field } from "./fields.ts";
import { Frames, nearest_frame } from "./frames.ts";
import { h } from "./html.ts";
import { prepare_stage } from "./parts.ts";
import { Show, type CommonRanges, type Range } from "./show.ts";
import { Stage } from "./stage.ts";
import { Store, switches, type Shown } from "./store.ts";
import type { ShownRun } from "./study.ts";
import type { Units } from "./units.ts";
import { box_of, View, type Box } from "./view.ts";
import type { Movable } from "./controls.ts";

/** What all stages have from the common store. */
const common_keys = [
  "playing", "rate", "field", "map", "range", "low", "high", "follow", "centre", "width", "units", "theme", ...switches,
] as const;
/** What a stage may change for all: by its mouse, and by the range it finds. */
const changed_here = ["follow", "centre", "width", "low", "high"] as const;

const some = <T extends object, K extends keyof T>(from: Readonly<T>, keys: readonly K[]): Pick<T, K> =>
  Object.fromEntries(keys.map((key) => [key, from[key]])) as Pick<T, K>;

export const level_colour = (k: number): string => curves[k % curves.length];

/** A run on the wall. */
export interface Panel {
  run: ShownRun;
  label: string;
  frames: Frames;
  store: Store<Shown>;
  view: View;
  stage: Stage;
  show: Show;
  figure: HTMLElement;
}

export class Wall {
  readonly root = h("div", { id: "wall" });
  readonly panels: Panel[] = [];
  /** The common time: that of the frames of the run that has most of them, s. */
  readonly times: number[];
  readonly fields: Field[] = [];
  readonly #ranges = new Map<string, Promise<Range>>();
  readonly #now = new Map<Field["id"], Map<number, Range>>(); // of the frames shown, by field and panel

  /** `levels`: runs with frames and how they are called, each with its place in the list of colours. */
  constructor(
    levels: { run: ShownRun; label: string; facts: string; colour: string }[],
    private readonly store: Store<Shown>,
    private readonly units: Units,
    blocks: Blocks,
    private readonly told: () => void,
  ) {
    this.times = levels.reduce((most, { run }) => (run.times.length >= most.length ? run.times : most), [] as number[]);
    this.root.dataset.count = String(levels.length);
    levels.forEach((level, k) => this.#add(level, k, blocks));
    store.on([...common_keys, "frame"], () => this.panels.forEach((panel) => this.#lead(panel)));
    store.on(["only"], () => this.#show_only());
    this.#show_only();
  }

  #add(level: { run: ShownRun; label: string; facts: string; colour: string }, k: number, blocks: Blocks): void {
    const { run, label, facts } = level;
    const box = h("div", { class: "stage", role: "img", "aria-label": `The bodies of ${label}`, tabindex: "0" });
    const time = h("span", { class: "stage-time" });
    const note = h("span", { class: "stage-note" });
    box.append(time, note);
    const dot = h("span", { class: "dot" });
    dot.style.background = level.colour;
    const name = h("button", {
      type: "button", class: "level-name", "aria-pressed": "false", title: "Shows this one alone, or all again",
      onclick: () => this.store.set({ only: this.store.now.only === run.name ? "" : run.name }),
    }, dot, label);
    const link = run.report
      ? h("a", { href: `runs/${encodeURIComponent(run.name)}/report.html`, "aria-label": `report of ${label}` }, "report")
      : null;
    const figure = h("figure", { class: "level", "data-run": run.name },
      h("figcaption", {}, name, h("span", { class: "level-facts" }, facts), link), box);
    this.root.append(figure);
    const frames = new Frames(run, blocks);
    const own = new Store<Shown>({ ...this.store.now });
    const view = new View(box, frames, own);
    const stage = new Stage(box, frames, own, view, this.units, `${run.case_name}: ${label}`);
    const fields = fields_of(frames);
    for (const field of fields) if (!this.fields.some((f) => f.id === field.id)) this.fields.push(field);
    const common: CommonRanges = {
      of_all: (field) => this.#range_of_all(field),
      of_now: (field, range) => this.#range_now(field, k, range),
    };
    const show = new Show(frames, fields, own, stage, (drawn) => {
      if (!drawn) return;
      time.textContent = stage.time_text();
      figure.dataset.frame = String(stage.drawn!.frame);
      figure.dataset.field = stage.drawn!.field?.id ?? "none";
      const wanted = this.fields.find((f) => f.id === this.store.now.field);
      note.textContent = wanted && !show.field ? `${wanted.label.toLowerCase()} is not in this page` : "";
      this.told();
    }, common);
    own.on(changed_here, () => this.store.set(some(own.now, changed_here)));
    own.on(["units"], () => (time.textContent = stage.drawn ? stage.time_text() : ""));
    this.panels.push({ run, label, frames, store: own, view, stage, show, figure });
  }

  /** Takes a panel along with the common store. */
  #lead(panel: Panel): void {
    panel.store.set({
      ...some(this.store.now, common_keys),
      frame: nearest_frame(panel.run.times, this.times[this.store.now.frame] ?? 0),
    });
  }

  #show_only(): void {
    const { only } = this.store.now;
    const known = this.panels.some(({ run }) => run.name === only);
    for (const { run, figure } of this.panels) {
      figure.hidden = known && run.name !== only;
      figure.querySelector(".level-name")!.setAttribute("aria-pressed", String(known && run.name === only));
    }
    this.root.dataset.count = String(known ? 1 : this.panels.length);
  }

  /** Over the ranges that all runs have. */
  #range_of_all(field: Field): Promise<Range> {
    let known = this.#ranges.get(field.id);
    if (!known) {
      const having = this.panels.flatMap(({ show }) => {
        const own = show.all_fields.find((f) => f.id === field.id);
        return own ? [show.run_range(own)] : [];
      });
      known = Promise.all(having).then(over);
      this.#ranges.set(field.id, known);
    }
    return known;
  }

  #range_now(field: Field, panel: number, own: Range): Range {
    const known = this.#now.get(field.id) ?? new Map<number, Range>();
    this.#now.set(field.id, known.set(panel, own));
    return over([...known.values()]);
  }

  /** Reads what all frames share and draws the first ones. */
  async open(is_view_given: boolean): Promise<void> {
    const boxes: Box[] = [];
    for (const { frames, stage, run } of this.panels) {
      boxes.push(await prepare_stage(frames, stage, run));
    }
    if (!is_view_given) this.first.view.fit(around(boxes), 0);
    this.panels.forEach((panel) => this.#lead(panel));
    for (const { view } of this.panels) view.listen(() => {});
    await this.refresh();
  }

  async refresh(): Promise<void> {
    await Promise.all(this.panels.map(({ show }) => show.refresh()));
  }

  get visible(): Panel[] {
    return this.panels.filter(({ figure }) => !figure.hidden);
  }
  get first(): Panel {
    return this.visible[0];
  }

  /** Are the frames asked for on all stages? */
  get is_drawn(): boolean {
    return this.panels.every(({ stage, store }) => stage.drawn?.frame === store.now.frame);
  }

  readonly view: Movable = {
    zoom: (factor) => this.first.view.zoom(factor),
    move: (x, y) => this.first.view.move(x, y),
    follow: (body) => this.first.view.follow(body, this.first.store.now.frame),
  };

  /** Shows all bodies of the frames. */
  fit(): void {
    const boxes = this.visible.flatMap(({ stage, frames }) => (stage.drawn ? [box_of(stage.drawn.places, frames.origin)] : []));
    if (boxes.length > 0) this.first.view.fit(around(boxes), this.first.store.now.frame);
  }

  paint_bar(canvas: HTMLCanvasElement): void {
    const drawn = this.visible.flatMap(({ stage }) => stage.drawn ?? []);
    const beyond = { below: drawn.some((d) => d.below), above: drawn.some((d) => d.above) };
    const with_field = this.visible.find(({ stage }) => stage.drawn?.field) ?? this.visible[0];
    with_field?.stage.paint_bar(canvas, beyond);
  }

  repaint(): void {
    for (const { stage } of this.panels) stage.repaint();
  }

  /** All that is seen as one picture: the stages as they stand, each with its name, time and colour bar. */
  compose(canvas: HTMLCanvasElement, least_ratio: number): void {
    const parts = this.visible.map(({ stage, figure }) => {
      const part = h("canvas");
      stage.compose(part, least_ratio);
      return { part, row: figure.offsetTop };
    });
    const rows = [...new Set(parts.map(({ row }) => row))].map((row) => parts.filter((p) => p.row === row));
    canvas.width = Math.max(...rows.map((row) => row.reduce((sum, { part }) => sum + part.width, 0)));
    canvas.height = rows.reduce((sum, row) => sum + row[0].part.height, 0);
    const context = canvas.getContext("2d")!;
    context.fillStyle = getComputedStyle(this.root).getPropertyValue("--paper").trim();
    context.fillRect(0, 0, canvas.width, canvas.height);
    let top = 0;
    for (const row of rows) {
      let left = 0;
      for (const { part } of row) {
        context.drawImage(part, left, top);
        left += part.width;
      }
      top += row[0].part.height;
    }
  }
}

function over(ranges: Range[]): Range {
  if (ranges.length === 0) return [0, 1];
  return [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))];
}

/** The box round boxes. */
function around(boxes: Box[]): Box {
  const all = (which: "low" | "high", k: 0 | 1): number[] => boxes.map((box) => box[which][k]);
  return {
    low: [Math.min(...all("low", 0)), Math.min(...all("low", 1))],
    high: [Math.max(...all("high", 0)), Math.max(...all("high", 1))],
  };
}
