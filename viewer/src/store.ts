// What is shown now. Everything that draws listens here; everything that the user does ends here.

export class Store<T extends object> {
  readonly #listeners: { keys: readonly (keyof T)[]; listen: () => void }[] = [];

  constructor(readonly now: Readonly<T>) {}

  /** Changes some values and tells whoever listens to one that is another than before. */
  set(change: Partial<T>): void {
    const changed = (Object.keys(change) as (keyof T)[]).filter((key) => change[key] !== this.now[key]);
    if (changed.length === 0) return;
    Object.assign(this.now as T, change);
    for (const { keys, listen } of this.#listeners) if (keys.some((key) => changed.includes(key))) listen();
  }

  on(keys: readonly (keyof T)[], listen: () => void): void {
    this.#listeners.push({ keys, listen });
  }
}

export interface Picked {
  on: "nodes" | "elements";
  index: number;
}

/** What is drawn with the bodies or not. */
export const switches = ["smooth", "mesh", "outline", "ghost", "forces"] as const;
export type Switch = (typeof switches)[number];

export interface Shown extends Record<Switch, boolean> {
  frame: number;
  playing: boolean;
  loop: boolean;
  rate: number; // frames per second
  field: string;
  map: string; // "" : the one that suits the field
  range: "run" | "frame" | "own";
  low: number; // SI, of the range in use
  high: number;
  follow: string; // a body, or ""
  centre: readonly [number, number]; // m, of the view
  width: number; // m, of the view
  picked: Picked | null;
  units: number; // counts choices of units
  only: string; // of a study: the one run that is shown, or ""
  theme: "" | "light" | "dark";
}
