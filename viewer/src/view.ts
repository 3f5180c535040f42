// Which part of the plane is seen, and how mouse, fingers and keys change it.
import type { Frames } from "./frames.ts";
import type { Point } from "./run.ts";
import type { Shown, Store } from "./store.ts";

export interface Box {
  low: Point;
  high: Point;
}

/** What a followed body adds to the centre of the view, m. */
export function followed(frames: Frames, shown: Readonly<Shown>, frame: number): Point {
  const body = frames.run.bodies.findIndex((b) => b.name === shown.follow);
  return body < 0 || frames.count === 0 ? [0, 0] : frames.centre(frame, body);
}

/** The box round points that lie one after the other, m against the origin of the frames. */
export function box_of(places: Float32Array, [ox, oy]: readonly [number, number]): Box {
  const low: Point = [Infinity, Infinity];
  const high: Point = [-Infinity, -Infinity];
  for (let k = 0; k < places.length; k += 2) {
    low[0] = Math.min(low[0], places[k]);
    high[0] = Math.max(high[0], places[k]);
    low[1] = Math.min(low[1], places[k + 1]);
    high[1] = Math.max(high[1], places[k + 1]);
  }
  return { low: [low[0] + ox, low[1] + oy], high: [high[0] + ox, high[1] + oy] };
}

/** The bodies of the first frame and where they come to, unless they fly so far that nothing could be seen of them. */
export function opening_box(frames: Frames, first: Box): Box {
  const low: Point = [...first.low];
  const high: Point = [...first.high];
  for (let frame = 1; frame < frames.count; ++frame) {
    frames.run.bodies.forEach((_, body) => {
      const [from, to] = [frames.centre(0, body), frames.centre(frame, body)];
      for (const k of [0, 1] as const) {
        low[k] = Math.min(low[k], first.low[k] + Math.min(0, to[k] - from[k]));
        high[k] = Math.max(high[k], first.high[k] + Math.max(0, to[k] - from[k]));
      }
    });
  }
  const extent = (box: Box): number => Math.max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  return extent({ low, high }) > 2.2 * extent(first) ? first : { low, high };
}

export class View {
  constructor(
    private readonly stage: HTMLElement,
    private readonly frames: Frames,
    private readonly store: Store<Shown>,
  ) {}

  /** px per m, in px of the page. */
  get scale(): number {
    return this.stage.clientWidth / this.store.now.width;
  }

  /** Centre of what is seen, m. */
  centre(frame: number): Point {
    const [x, y] = followed(this.frames, this.store.now, frame);
    return [this.store.now.centre[0] + x, this.store.now.centre[1] + y];
  }

  to_px(frame: number): (p: Point) => Point {
    const [cx, cy] = this.centre(frame);
    const { clientWidth, clientHeight } = this.stage;
    const scale = this.scale;
    return ([x, y]) => [clientWidth / 2 + (x - cx) * scale, clientHeight / 2 - (y - cy) * scale];
  }

  to_metres(frame: number, [px, py]: Point): Point {
    const [cx, cy] = this.centre(frame);
    const { clientWidth, clientHeight } = this.stage;
    return [cx + (px - clientWidth / 2) / this.scale, cy - (py - clientHeight / 2) / this.scale];
  }

  /** Shows a box with some room around it. */
  fit(box: Box, frame: number): void {
    const [x, y] = followed(this.frames, this.store.now, frame);
    const { clientWidth, clientHeight } = this.stage;
    const needed = Math.max(box.high[0] - box.low[0], ((box.high[1] - box.low[1]) * clientWidth) / clientHeight);
    this.store.set({
      centre: [(box.low[0] + box.high[0]) / 2 - x, (box.low[1] + box.high[1]) / 2 - y],
      width: 1.18 * (needed > 0 ? needed : 1),
    });
  }

  move(px: number, py: number): void {
    const [x, y] = this.store.now.centre;
    this.store.set({ centre: [x - px / this.scale, y + py / this.scale] });
  }

  /** Makes things `factor` times as large; the point at px, py stays where it is. */
  zoom(factor: number, px = this.stage.clientWidth / 2, py = this.stage.clientHeight / 2): void {
    const { centre, width } = this.store.now;
    const [dx, dy] = [px - this.stage.clientWidth / 2, this.stage.clientHeight / 2 - py];
    const part = (1 - 1 / factor) / this.scale;
    this.store.set({ centre: [centre[0] + dx * part, centre[1] + dy * part], width: width / factor });
  }

  /** Begins or ends to follow a body; what is seen now stays. */
  follow(body: string, frame: number): void {
    const seen = this.centre(frame);
    const [x, y] = followed(this.frames, { ...this.store.now, follow: body }, frame);
    this.store.set({ follow: body, centre: [seen[0] - x, seen[1] - y] });
  }

  /** Wheel and pinch to zoom, drag to pan; `click` where neither happened, px. */
  listen(click: (at: Point) => void): void {
    const pointers = new Map<number, Point>();
    let moved = 0;
    const at = (event: MouseEvent): Point => {
      const box = this.stage.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.stage.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 20 : 1)), ...at(event));
    }, { passive: false });
    this.stage.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.stage.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, at(event));
      if (pointers.size === 1) moved = 0;
    });
    this.stage.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const now = at(event);
      moved += Math.hypot(now[0] - before[0], now[1] - before[1]);
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const span = (p: Point): number => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        this.zoom(span(now) / span(before), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      } else if (moved > 4) {
        this.move(now[0] - before[0], now[1] - before[1]);
      }
      pointers.set(event.pointerId, now);
    });
    const end = (event: PointerEvent): void => {
      const was_alone = pointers.size === 1;
      if (!pointers.delete(event.pointerId)) return;
      if (event.type === "pointerup" && was_alone && moved <= 4) click(at(event));
    };
    this.stage.addEventListener("pointerup", end);
    this.stage.addEventListener("pointercancel", end);
  }
}
