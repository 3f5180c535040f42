// What the page of a run and that of a study have in common.
import type { Field } from "./fields.ts";
import type { Frames } from "./frames.ts";
import { by_id, choice } from "./html.ts";
import type { History, Run } from "./run.ts";
import { save_film, type Composed } from "./saving.ts";
import type { Stage } from "./stage.ts";
import type { Shown, Store } from "./store.ts";
import { box_of, opening_box, type Box } from "./view.ts";

/** Decoded arrays that are kept, bytes. */
export const room = 128 * 1024 * 1024;

export const start: Shown = {
  frame: 0, playing: false, loop: false, rate: 20, field: "", map: "", range: "run", low: 0, high: 1, smooth: false,
  mesh: true, outline: true, ghost: false, forces: true, follow: "", centre: [0, 0], width: 1, picked: null, units: 0,
  only: "", theme: "",
};

export function theme_choice(store: Store<Shown>, changed: () => void): HTMLElement {
  const theme = choice("theme", [["", "as the system"], ["light", "light"], ["dark", "dark"]], "", (value) => {
    store.set({ theme: value as Shown["theme"] });
  });
  theme.select.id = "theme";
  store.on(["theme"], () => {
    document.documentElement.dataset.theme = store.now.theme;
    changed();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  return theme.label;
}

/** Histories in the order in which one looks at them: what the case observes, contact, energy, bodies, the rest. */
export function sections_of(run: Run): { title: string; open: boolean; histories: History[] }[] {
  const rest = new Set(run.histories);
  const take = (title: string, which: (h: History) => boolean, open = true) => {
    const histories = run.histories.filter((h) => rest.has(h) && which(h));
    histories.forEach((h) => rest.delete(h));
    return { title, histories, open: open && histories.length <= 8 };
  };
  const bodies = new Set((run.summary?.bodies ?? run.bodies).map((b) => b.name));
  const has = (history: History, column: string) => history.columns.some((c) => c.name === column);
  const order = ["Energy", "Observed", "Contact forces", "Bodies", "Supports", "Momentum"];
  return [
    take("Energy", (h) => h.name === "energy"),
    take("Contact forces", (h) => has(h, "touching_nodes")),
    take("Supports", (h) => has(h, "reaction_x")),
    take("Bodies", (h) => bodies.has(h.name) && has(h, "spin")),
    take("Momentum", (h) => h.name === "momentum", false),
    take("Observed", () => true), // by the case: whatever the program does not watch by itself
  ]
    .sort((a, b) => order.indexOf(a.title) - order.indexOf(b.title))
    .filter(({ histories }) => histories.length > 0);
}

export function failed(words: string): void {
  const place = by_id("failure");
  place.textContent = words;
  place.hidden = false;
}

/** The first field that is not 0 in all frames. */
export function first_field(frames: Frames, fields: Field[]): string {
  const is_something = (name: string): boolean =>
    frames.quantity(name)?.chunks.some(({ low = 0, step = 0 }) => low !== 0 || step !== 0) ?? false;
  const found = ["plastic_strain", "max_shear", "principal_1", "speed"]
    .map((id) => fields.find((f) => f.id === id))
    .find((f) => f?.needs.some(is_something));
  return (found ?? fields[0])?.id ?? "";
}

/** Reads what all frames of a run share and gives it to its stage; the box of the bodies to open with. */
export async function prepare_stage(frames: Frames, stage: Stage, run: Run): Promise<Box> {
  await frames.open();
  stage.scene?.set_mesh(frames.corners, run.elements);
  void frames.blocks.boundary(frames.corners, run.elements).then((edges) => {
    stage.scene?.set_outline(edges);
    stage.repaint();
  });
  await frames.load(0, ["x", "y"]);
  const first = frames.places(0);
  stage.scene?.set_first_places(first);
  return opening_box(frames, box_of(first, frames.origin));
}

/** What the button for a film does: it begins one, and pressed again ends it. */
export function film_button(
  stage: Composed, store: Store<Shown>, frames: number, name: string, bring: () => Promise<void>,
): () => Promise<void> {
  let filming = false;
  let stop = false;
  return async () => {
    if (filming) {
      stop = true;
      return;
    }
    const button = by_id("save-film");
    [filming, stop] = [true, false];
    try {
      const tell = (done: number): void => void (button.textContent = `stop (${done} of ${frames})`);
      await save_film(stage, store, frames, name, bring, tell, () => stop);
    } catch (error) {
      failed(error instanceof Error ? error.message : String(error));
    }
    filming = false;
    button.textContent = "video";
  };
}

