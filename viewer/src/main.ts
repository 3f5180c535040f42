// Puts the page together.
import { follow_address, from_address } from "./address.ts";
import { Blocks } from "./blocks.ts";
import { listen_to_keys, look_bar, player_bar, view_bar } from "./controls.ts";
import { fields_of, type Field } from "./fields.ts";
import { Frames } from "./frames.ts";
import { by_id, choice, h } from "./html.ts";
import { pick_at, Picking } from "./picking.ts";
import { Player } from "./player.ts";
import { Plots } from "./plots.ts";
import { read_run, type History, type Run } from "./run.ts";
import { save_film, save_picture } from "./saving.ts";
import { Show } from "./show.ts";
import { Stage } from "./stage.ts";
import { Store, type Shown } from "./store.ts";
import { contacts, folded, header, notes, origin } from "./texts.ts";
import { Units } from "./units.ts";
import { box_of, opening_box, View } from "./view.ts";

/** Decoded arrays that are kept, bytes. */
const room = 128 * 1024 * 1024;

const start: Shown = {
  frame: 0, playing: false, loop: false, rate: 20, field: "", map: "", range: "run", low: 0, high: 1, smooth: false,
  mesh: true, outline: true, ghost: false, forces: true, follow: "", centre: [0, 0], width: 1, picked: null, units: 0,
  theme: "",
};

function theme_choice(store: Store<Shown>, changed: () => void): HTMLElement {
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
function sections_of(run: Run): { title: string; open: boolean; histories: History[] }[] {
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

function history_sections(run: Run, plots: Plots): HTMLElement[] {
  return sections_of(run).map(({ title, open, histories }) => {
    const inside = h("div");
    const details = h("details", { open, class: "histories" }, h("summary", {}, `${title}`), inside);
    const fill = (): void => {
      if (details.open && !inside.firstChild) inside.append(...histories.map((history) => plots.of_history(history)));
    };
    details.addEventListener("toggle", fill);
    fill();
    return details;
  });
}

function failed(words: string): void {
  const place = by_id("failure");
  place.textContent = words;
  place.hidden = false;
}

/** What the address asks for, of what this page has. */
function asked_for(run: Run, fields: Field[]): Partial<Shown> {
  const asked = from_address(location.hash.slice(1), run.times.length, run.nodes, run.elements);
  if (asked.field !== "none" && !fields.some((f) => f.id === asked.field)) delete asked.field;
  return asked;
}

/** The first field that is not 0 in all frames. */
function first_field(frames: Frames, fields: Field[]): string {
  const is_something = (name: string): boolean =>
    frames.quantity(name)?.chunks.some(({ low = 0, step = 0 }) => low !== 0 || step !== 0) ?? false;
  const found = ["plastic_strain", "max_shear", "principal_1", "speed"]
    .map((id) => fields.find((f) => f.id === id))
    .find((f) => f?.needs.some(is_something));
  return (found ?? fields[0])?.id ?? "";
}

function nearest_frame(times: number[], time: number): number {
  const after = times.findIndex((t) => t >= time);
  if (after <= 0) return after === 0 ? 0 : times.length - 1;
  return time - times[after - 1] < times[after] - time ? after - 1 : after;
}

/** What the button for a film does: it begins one, and pressed again ends it. */
function film_button(
  stage: Stage, store: Store<Shown>, frames: number, name: string, bring: () => Promise<void>,
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

async function open_page(): Promise<void> {
  const run = read_run(document);
  document.title = `${run.case_name} – Udar`;
  const units = new Units();
  units.follow(run.case_text);
  const frames = new Frames(run, new Blocks(room));
  const fields = fields_of(frames);
  const asked = asked_for(run, fields);
  const store = new Store<Shown>({ ...start, field: first_field(frames, fields), ...asked });

  by_id("head").append(header(run), theme_choice(store, () => {
    stage.repaint();
    paint_bar();
    plots.redraw();
  }));
  const words = notes(run);
  if (words) by_id("head").after(words);

  const stage_box = by_id("stage");
  const view = new View(stage_box, frames, store);
  const stage = new Stage(stage_box, frames, store, view, units);
  if (stage.failure) failed(stage.failure);
  stage_box.addEventListener("failure", (event) => failed((event as CustomEvent<string>).detail));
  const bar = by_id<HTMLCanvasElement>("bar");
  const paint_bar = (): void => stage.paint_bar(bar);
  let is_drawn = false;
  const show = new Show(frames, fields, store, stage, (drawn) => {
    is_drawn = drawn;
    by_id("loading").hidden = drawn;
    if (!drawn) return;
    by_id("stage-time").textContent = stage.time_text();
    paint_bar();
    picking.now();
    document.body.dataset.frame = String(store.now.frame);
  });
  const player = new Player(frames.count, store, () => is_drawn);
  const plots = new Plots(run, frames.blocks, store, units, (time) => player.go(nearest_frame(run.times, time)));
  const picking = new Picking(frames, run, store, stage, plots, units, () => show.field);
  store.on(["low", "high", "map", "units"], paint_bar);
  new ResizeObserver(paint_bar).observe(bar);

  by_id("numbers").append(...contacts(run, units), ...history_sections(run, plots));
  store.on(["units"], () => by_id("numbers").replaceChildren(...contacts(run, units), ...history_sections(run, plots)));
  const texts = [
    folded("Case", run.case_text), folded("Case as it ran, in SI units", run.resolved_text), folded("Log", run.log),
  ];
  by_id("texts").append(origin(run), ...texts.filter((t) => t !== null));

  if (frames.count === 0) {
    stage_box.classList.add("empty");
    by_id("loading").hidden = true;
    stage_box.append(h("p", { class: "empty" },
      "This run has no frames. Ask for them in the case: [output] fields_every = \"20 us\"."));
  } else {
    await frames.open();
    stage.scene?.set_mesh(frames.corners, run.elements);
    void frames.blocks.boundary(frames.corners, run.elements).then((edges) => {
      stage.scene?.set_outline(edges);
      stage.repaint();
    });
    await frames.load(0, ["x", "y"]);
    const first = frames.places(0);
    stage.scene?.set_first_places(first);
    if (!asked.width) view.fit(opening_box(frames, box_of(first, frames.origin)), 0);
    const fit = (): void => {
      if (stage.drawn) view.fit(box_of(stage.drawn.places, frames.origin), stage.drawn.frame);
    };
    const name = run.case_name.replace(/[^\w.-]+/g, "_");
    const picture = (): void => void save_picture(stage, `${name}-${store.now.frame}`);
    const film = film_button(stage, store, frames.count, name, () => show.refresh());
    by_id("controls").append(
      player_bar(frames, store, player, units),
      look_bar(frames, fields, store, units),
      view_bar(frames, store, view, fit, picture, () => void film()),
      picking.element,
    );
    view.listen((at) => {
      if (stage.drawn) store.set({ picked: pick_at(frames, stage.drawn, view.to_metres(stage.drawn.frame, at), picking.on) });
    });
    listen_to_keys(frames, store, player, view, fit, picture);
    await show.refresh();
    const picked = store.now.picked;
    if (picked) {
      store.set({ picked: null });
      store.set({ picked });
    }
    follow_address(store);
    // Whoever opens a run wants to see it move: once, unless the address or the system asks for peace.
    const in_peace = location.hash !== "" || matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (!in_peace) player.play();
    addEventListener("hashchange", () => store.set(asked_for(run, fields)));
  }
  document.body.dataset.ready = "true";
  setTimeout(() => plots.make_some(60), 1500);
}

open_page().catch((error: unknown) => failed(error instanceof Error ? error.message : String(error)));
