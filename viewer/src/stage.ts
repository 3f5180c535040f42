// The moving picture: obstacles below, bodies by WebGL, forces and marks above.
import { maps, type ColourMap } from "./colours.ts";
import {
  draw_arrow, draw_bar, draw_obstacles, draw_scale, font, halo, type Bar, type Canvas, type Paints,
} from "./drawing.ts";
import type { Field } from "./fields.ts";
import type { Frames } from "./frames.ts";
import { h } from "./html.ts";
import { Scene, type Colour, type Look } from "./scene.ts";
import type { Shown, Store } from "./store.ts";
import type { Point } from "./run.ts";
import { digits, with_unit, type Units } from "./units.ts";
import type { View } from "./view.ts";

/** Contact forces of a frame. */
export interface Forces {
  nodes: Uint32Array;
  x: Float32Array; // N
  y: Float32Array;
  largest: number; // N, of the whole run
}

/** Do values lie beyond the range? */
export interface Beyond {
  below: boolean;
  above: boolean;
}

/** What is drawn: the frame that has come, not the one asked for last. */
export interface Drawn extends Beyond {
  frame: number;
  places: Float32Array;
  field: Field | null;
  values: Float32Array | null;
  forces: Forces | null;
}

function paints_of(root: HTMLElement): Paints & { body: string; flows: string; flowed: string; none: string } {
  const style = getComputedStyle(root);
  const of = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    paper: of("paper"), ink: of("ink"), faint: of("faint"), obstacle: of("obstacle"),
    obstacle_edge: of("obstacle-edge"), hatch: of("hatch"), accent: of("accent"),
    body: of("body"), flows: of("flows"), flowed: of("flowed"), none: of("none"),
  };
}

function colour(hex: string, opacity = 1): Colour {
  return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255).concat(opacity) as Colour;
}

export class Stage {
  readonly #under = h("canvas", { "aria-hidden": "true" });
  readonly #bodies = h("canvas", { "aria-hidden": "true" });
  readonly #over = h("canvas", { "aria-hidden": "true" });
  readonly scene: Scene | null = null;
  readonly failure: string = "";
  drawn: Drawn | null = null;
  #waiting = 0;
  #ratio = devicePixelRatio; // px of the canvases for one of the page

  constructor(
    readonly root: HTMLElement,
    private readonly frames: Frames,
    private readonly store: Store<Shown>,
    private readonly view: View,
    private readonly units: Units,
    private readonly title = frames.run.case_name,
  ) {
    root.prepend(this.#under, this.#bodies, this.#over);
    try {
      this.scene = new Scene(this.#bodies);
    } catch (error) {
      this.failure = error instanceof Error ? error.message : String(error);
    }
    new ResizeObserver(() => this.repaint()).observe(root);
  }

  /** Paints before the next frame of the screen, once. */
  repaint(): void {
    if (this.#waiting) return;
    this.#waiting = requestAnimationFrame(() => {
      this.#waiting = 0;
      this.#ratio = devicePixelRatio;
      this.paint();
    });
  }

  #fresh(canvas: HTMLCanvasElement): Canvas {
    const context = canvas.getContext("2d")!;
    context.setTransform(this.#ratio, 0, 0, this.#ratio, 0, 0);
    context.clearRect(0, 0, this.root.clientWidth, this.root.clientHeight);
    return context;
  }

  paint(): void {
    const { clientWidth, clientHeight } = this.root;
    if (clientWidth === 0 || clientHeight === 0) return;
    for (const canvas of [this.#under, this.#bodies, this.#over]) {
      const [width, height] = [clientWidth, clientHeight].map((px) => Math.round(px * this.#ratio));
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
    }
    const paints = paints_of(this.root);
    const under = this.#fresh(this.#under);
    under.fillStyle = paints.paper;
    under.fillRect(0, 0, clientWidth, clientHeight);
    const over = this.#fresh(this.#over);
    const { drawn, scene } = this;
    if (!drawn) return;
    const to_px = this.view.to_px(drawn.frame);
    const { outlines } = this.frames.run;
    draw_obstacles(under, outlines.sets[outlines.of_frame[drawn.frame]] ?? [], to_px, paints);
    const [ox, oy] = this.frames.origin;
    const [cx, cy] = this.view.centre(drawn.frame);
    const ratio = this.#ratio;
    const { width, height } = this.#bodies;
    scene?.draw(
      { centre: [cx - ox, cy - oy], scale: this.view.scale * ratio, width, height, ratio }, this.#look(drawn, paints),
    );
    this.#draw_forces(over, drawn, to_px, paints);
    this.#draw_picked(over, drawn, to_px, paints);
    draw_scale(over, this.view.scale, this.units.for("m", (0.2 * clientWidth) / this.view.scale), paints);
  }

  map(field: Field | null): ColourMap {
    return maps[this.store.now.map] ?? (field?.signed ? maps.two_sided : maps.even);
  }

  #look(drawn: Drawn, paints: ReturnType<typeof paints_of>): Look {
    const { low, high, mesh, outline, ghost } = this.store.now;
    // Lines closer than some px would run into each other.
    const extent = this.#mean_side(drawn) * this.view.scale;
    const fade = Math.min(1, Math.max(0, (extent - 3) / 5));
    return {
      map: this.map(drawn.field),
      low,
      high,
      is_flag: drawn.field?.flag ?? !drawn.field,
      mesh: mesh ? 0.4 * fade : 0,
      none: colour(paints.none),
      plain: colour(paints.body),
      flowed: colour(paints.flowed),
      flagged: colour(paints.flows),
      outline: outline ? colour(paints.ink, 0.95) : null,
      ghost: ghost ? colour(paints.faint, 0.9) : null,
    };
  }

  /** Of the triangles, from a few of them; m. */
  #mean_side({ places }: Drawn): number {
    const { corners } = this.frames;
    const elements = corners.length / 3;
    let sum = 0;
    let count = 0;
    for (let e = 0; e < elements; e += Math.max(1, Math.floor(elements / 500))) {
      const [a, b] = [2 * corners[e], 2 * corners[elements + e]];
      sum += Math.hypot(places[b] - places[a], places[b + 1] - places[a + 1]);
      ++count;
    }
    return count > 0 ? sum / count : 0;
  }

  #node({ places }: Drawn, node: number): Point {
    return [places[2 * node] + this.frames.origin[0], places[2 * node + 1] + this.frames.origin[1]];
  }

  #draw_forces(over: Canvas, drawn: Drawn, to_px: (p: Point) => Point, paints: Paints): void {
    const { forces } = drawn;
    if (!this.store.now.forces || !forces || forces.largest === 0) return;
    const longest = 0.2 * Math.min(this.root.clientWidth, this.root.clientHeight);
    over.save();
    over.strokeStyle = over.fillStyle = paints.accent;
    over.lineWidth = 1.5;
    forces.nodes.forEach((node, k) => {
      const [x, y] = to_px(this.#node(drawn, node));
      const part = longest / forces.largest;
      draw_arrow(over, [x - forces.x[k] * part, y + forces.y[k] * part], [x, y]);
    });
    if (forces.nodes.length > 0) {
      const words = `longest arrow of the run: ${with_unit(forces.largest, "N", this.units, 3)}`;
      halo(over, words, this.root.clientWidth - 12, this.root.clientHeight - 14, "right", paints);
    }
    over.restore();
  }

  #draw_picked(over: Canvas, drawn: Drawn, to_px: (p: Point) => Point, paints: Paints): void {
    const { picked } = this.store.now;
    if (!picked) return;
    over.save();
    over.strokeStyle = paints.accent;
    over.lineWidth = 2;
    over.beginPath();
    if (picked.on === "nodes") {
      const [x, y] = to_px(this.#node(drawn, picked.index));
      over.arc(x, y, 5, 0, 2 * Math.PI);
    } else {
      const { corners } = this.frames;
      const elements = corners.length / 3;
      for (let c = 0; c < 3; ++c) {
        const [x, y] = to_px(this.#node(drawn, corners[c * elements + picked.index]));
        if (c === 0) over.moveTo(x, y);
        else over.lineTo(x, y);
      }
      over.closePath();
    }
    over.stroke();
    over.restore();
  }

  /** The colour bar of what is drawn; none for a field of yes and no. */
  bar(beyond: Beyond = this.drawn ?? { below: false, above: false }): Bar | null {
    const { drawn } = this;
    if (!drawn?.field || drawn.field.flag) return null;
    const { low, high } = this.store.now;
    const unit = this.units.for(drawn.field.unit, Math.max(Math.abs(low), Math.abs(high)));
    return {
      label: drawn.field.label,
      unit: unit.name,
      low: low / unit.size,
      high: high / unit.size,
      map: this.map(drawn.field),
      below: beyond.below,
      above: beyond.above,
    };
  }

  /** The colour bar on a canvas of its own; `beyond` where others have the same bar. */
  paint_bar(canvas: HTMLCanvasElement, beyond?: Beyond): void {
    const width = canvas.clientWidth;
    canvas.width = Math.round(width * devicePixelRatio);
    canvas.height = Math.round(50 * devicePixelRatio);
    const context = canvas.getContext("2d")!;
    context.scale(devicePixelRatio, devicePixelRatio);
    this.#draw_key(context, 2, width - 32, beyond);
  }

  /** The colour bar, or what the two colours of a yes or no mean. */
  #draw_key(context: Canvas, top: number, width: number, beyond?: Beyond): void {
    const paints = paints_of(this.root);
    const bar = this.bar(beyond);
    if (bar) draw_bar(context, 16, top, width, bar, paints);
    else if (this.drawn?.field?.flag) this.#key(context, 16, [["flows now", paints.flows], ["has flowed", paints.flowed], ["never flowed", paints.body]], paints);
  }

  #key(canvas: Canvas, x: number, entries: [string, string][], paints: Paints): void {
    canvas.font = font(12.5);
    canvas.textBaseline = "middle";
    for (const [words, fill] of entries) {
      canvas.fillStyle = fill;
      canvas.fillRect(x, 16, 22, 14);
      canvas.strokeStyle = paints.faint;
      canvas.strokeRect(x + 0.5, 16.5, 21, 13);
      canvas.fillStyle = paints.ink;
      canvas.fillText(words, x + 30, 24);
      x += 60 + canvas.measureText(words).width;
    }
  }

  /** The picture with title, time and colour bar, as it goes into a file, with `least_ratio` px or more for one of the page;
   *  the canvas gets the size it takes. */
  compose(canvas: HTMLCanvasElement, least_ratio: number): void {
    const ratio = (this.#ratio = Math.max(devicePixelRatio, least_ratio));
    this.paint();
    const { clientWidth, clientHeight } = this.root;
    const head = 34;
    const foot = this.drawn?.field ? 56 : 8;
    canvas.width = 2 * Math.round((clientWidth * ratio) / 2); // even sizes, for films
    canvas.height = 2 * Math.round(((clientHeight + head + foot) * ratio) / 2);
    const context = canvas.getContext("2d")!;
    const paints = paints_of(this.root);
    context.fillStyle = paints.paper;
    context.fillRect(0, 0, canvas.width, canvas.height);
    for (const part of [this.#under, this.#bodies, this.#over]) context.drawImage(part, 0, Math.round(head * ratio));
    context.scale(ratio, ratio);
    context.fillStyle = paints.ink;
    context.font = font(15, "600");
    context.fillText(this.title, 14, 23, clientWidth / 2);
    context.font = font(14);
    context.textAlign = "right";
    context.fillText(this.time_text(), clientWidth - 14, 23);
    context.textAlign = "left";
    context.translate(0, head + clientHeight);
    this.#draw_key(context, 4, Math.min(clientWidth - 32, 420));
    this.repaint();
  }

  time_text(): string {
    const { times } = this.frames.run;
    const unit = this.units.for("s", times[times.length - 1] ?? 0);
    return `t = ${digits(times[this.drawn?.frame ?? 0] / unit.size)} ${unit.name}`;
  }
}
