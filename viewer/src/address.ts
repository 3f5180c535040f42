// The part of the address behind #: frame, field and view, so that a link brings back what was seen.
import { switches, type Shown, type Store } from "./store.ts";

const short = (value: number): string => String(Number(value.toPrecision(6)));

export function to_address(shown: Readonly<Shown>): string {
  const words = new URLSearchParams({
    frame: String(shown.frame),
    field: shown.field,
    at: [...shown.centre, shown.width].map(short).join(","),
  });
  if (shown.map) words.set("map", shown.map);
  if (shown.only) words.set("only", shown.only);
  if (shown.follow) words.set("follow", shown.follow);
  if (shown.range !== "run") words.set("range", shown.range === "own" ? `${short(shown.low)},${short(shown.high)}` : shown.range);
  const on = switches.filter((key) => shown[key]);
  words.set("show", on.join(","));
  if (shown.picked) words.set("picked", `${shown.picked.on},${shown.picked.index}`);
  return words.toString();
}

/** What an address asks for; what cannot be is passed over. */
export function from_address(text: string, frames: number, nodes: number, elements: number): Partial<Shown> {
  const words = new URLSearchParams(text);
  const shown: Partial<Shown> = {};
  const numbers = (name: string): number[] => (words.get(name) ?? "").split(",").map(Number);
  const frame = Number(words.get("frame") ?? NaN);
  if (Number.isInteger(frame) && frame >= 0 && frame < frames) shown.frame = frame;
  for (const key of ["field", "map", "follow", "only"] as const) {
    const word = words.get(key);
    if (word) shown[key] = word;
  }
  const [x, y, width] = numbers("at");
  if ([x, y].every(Number.isFinite) && width > 0 && Number.isFinite(width)) {
    shown.centre = [x, y];
    shown.width = width;
  }
  const range = words.get("range");
  if (range === "frame") shown.range = "frame";
  const [low, high] = numbers("range");
  if (low < high) Object.assign(shown, { range: "own", low, high });
  const show = words.get("show");
  if (show !== null) {
    for (const key of switches) shown[key] = show.split(",").includes(key);
  }
  const [on, index] = (words.get("picked") ?? "").split(",");
  const most = on === "nodes" ? nodes : on === "elements" ? elements : 0;
  if (Number.isInteger(Number(index)) && Number(index) >= 0 && Number(index) < most) shown.picked = { on: on as "nodes" | "elements", index: Number(index) };
  return shown;
}

/** Keeps the address up to date, not more often than some times a second. */
export function follow_address(store: Store<Shown>): void {
  let waiting = 0;
  const write = (): void => {
    waiting = 0;
    history.replaceState(null, "", `#${to_address(store.now)}`);
  };
  const keys = [
    "frame", "field", "map", "range", "low", "high", "follow", "centre", "width", "picked", "only", ...switches,
  ] as const;
  store.on(keys, () => {
    waiting ||= window.setTimeout(write, 300);
  });
}
