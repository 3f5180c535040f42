// What is drawn around the bodies with a plain canvas: obstacles, forces, marks, scale, colour bar.
import { css_colour, type ColourMap } from "./colours.ts";
import type { Point } from "./run.ts";
import { digits, nice_step, nice_ticks, type Unit } from "./units.ts";

export type Canvas = CanvasRenderingContext2D;

/** Colours of the page, as its style sheet gives them. */
export interface Paints {
  paper: string;
  ink: string;
  faint: string;
  obstacle: string;
  obstacle_edge: string;
  hatch: string;
  accent: string;
}

export const font = (px: number, weight = ""): string =>
  `${weight} ${px}px system-ui, "Segoe UI", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif`.trim();

/** Closed outlines; `to_px` takes m to px. */
export function draw_obstacles(canvas: Canvas, outlines: Point[][], to_px: (p: Point) => Point, paints: Paints): void {
  const path = new Path2D();
  for (const outline of outlines) {
    outline.map(to_px).forEach(([x, y], k) => (k === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
    path.closePath();
  }
  canvas.save();
  canvas.fillStyle = paints.obstacle;
  canvas.fill(path);
  canvas.save();
  canvas.clip(path);
  canvas.strokeStyle = paints.hatch;
  canvas.lineWidth = 1;
  const { width, height } = size_of(canvas);
  canvas.beginPath();
  for (let x = -height; x < width; x += 9) {
    canvas.moveTo(x, height);
    canvas.lineTo(x + height, 0);
  }
  canvas.stroke();
  canvas.restore();
  canvas.strokeStyle = paints.obstacle_edge;
  canvas.lineWidth = 1.4;
  canvas.stroke(path);
  canvas.restore();
}

/** Width and height in the units in which one draws. */
export function size_of(canvas: Canvas): { width: number; height: number } {
  const scale = canvas.getTransform().a || 1;
  return { width: canvas.canvas.width / scale, height: canvas.canvas.height / scale };
}

/** An arrow that ends at `to`, px. */
export function draw_arrow(canvas: Canvas, from: Point, to: Point): void {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  if (length < 1) return;
  const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const head = Math.min(7, 0.5 * length);
  canvas.beginPath();
  canvas.moveTo(from[0], from[1]);
  canvas.lineTo(to[0] - 0.7 * head * ux, to[1] - 0.7 * head * uy);
  canvas.stroke();
  canvas.beginPath();
  canvas.moveTo(to[0], to[1]);
  canvas.lineTo(to[0] - head * ux - 0.4 * head * uy, to[1] - head * uy + 0.4 * head * ux);
  canvas.lineTo(to[0] - head * ux + 0.4 * head * uy, to[1] - head * uy - 0.4 * head * ux);
  canvas.fill();
}

/** How long a round length is, at the lower left. `scale`: px per m. */
export function draw_scale(canvas: Canvas, scale: number, unit: Unit, paints: Paints): void {
  const { width, height } = size_of(canvas);
  const length = nice_step(0, (0.22 * width) / scale / unit.size, 1.6);
  const px = length * unit.size * scale;
  const [x, y] = [14, height - 14];
  canvas.save();
  canvas.beginPath();
  canvas.moveTo(x, y - 5);
  canvas.lineTo(x, y);
  canvas.lineTo(x + px, y);
  canvas.lineTo(x + px, y - 5);
  for (const [width, colour] of [[4.5, paints.paper], [1.5, paints.ink]] as const) {
    canvas.lineWidth = width;
    canvas.strokeStyle = colour;
    canvas.stroke();
  }
  halo(canvas, `${digits(length)} ${unit.name}`, x + px / 2, y - 6, "center", paints);
  canvas.restore();
}

/** Words that can be read on anything. */
export function halo(canvas: Canvas, words: string, x: number, y: number, align: CanvasTextAlign, paints: Paints): void {
  canvas.save();
  canvas.font = font(12.5);
  canvas.textAlign = align;
  canvas.lineJoin = "round";
  canvas.lineWidth = 3.5;
  canvas.strokeStyle = paints.paper;
  canvas.strokeText(words, x, y);
  canvas.fillStyle = paints.ink;
  canvas.fillText(words, x, y);
  canvas.restore();
}

/** What a bar of colours stands for. */
export interface Bar {
  label: string;
  unit: string;
  low: number; // in that unit
  high: number;
  map: ColourMap;
  /** Values lie beyond the ends. */
  below: boolean;
  above: boolean;
}

/** A level colour bar of this width from x, y; 46 px high. */
export function draw_bar(canvas: Canvas, x: number, y: number, width: number, bar: Bar, paints: Paints): void {
  canvas.save();
  canvas.font = font(12.5);
  canvas.fillStyle = paints.ink;
  canvas.textAlign = "left";
  canvas.fillText(bar.unit ? `${bar.label}, ${bar.unit}` : bar.label, x, y + 11);
  const top = y + 17;
  const gradient = canvas.createLinearGradient(x, 0, x + width, 0);
  for (let k = 0; k <= 32; ++k) gradient.addColorStop(k / 32, css_colour(bar.map, Math.round((255 * k) / 32)));
  canvas.fillStyle = gradient;
  canvas.fillRect(x, top, width, 12);
  const point = (at: number, way: number, index: number): void => {
    canvas.fillStyle = css_colour(bar.map, index);
    canvas.beginPath();
    canvas.moveTo(at, top);
    canvas.lineTo(at + 7 * way, top + 6);
    canvas.lineTo(at, top + 12);
    canvas.fill();
  };
  if (bar.below) point(x, -1, 0);
  if (bar.above) point(x + width, 1, 255);
  canvas.fillStyle = canvas.strokeStyle = paints.ink;
  canvas.lineWidth = 1;
  const place = (value: number): number => x + ((value - bar.low) / (bar.high - bar.low)) * width;
  canvas.textAlign = "center";
  canvas.font = font(11.5);
  for (const tick of nice_ticks(bar.low, bar.high, Math.max(2, Math.floor(width / 62)))) {
    canvas.beginPath();
    canvas.moveTo(place(tick), top + 12);
    canvas.lineTo(place(tick), top + 16);
    canvas.stroke();
    canvas.fillText(digits(tick), place(tick), top + 28);
  }
  canvas.restore();
}
