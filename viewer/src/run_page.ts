// Puts the page of a run together.
import { follow_address, from_address } from "./address.ts";
import { Blocks } from "./blocks.ts";
import { listen_to_keys, look_bar, player_bar, view_bar } from "./controls.ts";
import { fields_of, type Field } from "./fields.ts";
import { Frames, nearest_frame } from "./frames.ts";
import { by_id, h } from "./html.ts";
import { failed, film_button, first_field, prepare_stage, room, sections_of, start, theme_choice } from "./parts.ts";
import { pick_at, Picking } from "./picking.ts";
import { Player } from "./player.ts";
import { Plots } from "./plots.ts";
import type { Run } from "./run.ts";
import { save_picture } from "./saving.ts";
import { Show } from "./show.ts";
import { Stage } from "./stage.ts";
import { Store, type Shown } from "./store.ts";
import { contacts, folded, header, notes, origin } from "./texts.ts";
import { Units } from "./units.ts";
import { box_of, View } from "./view.ts";

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

/** What the address asks for, of what this page has. */
function asked_for(run: Run, fields: Field[]): Partial<Shown> {
  const asked = from_address(location.hash.slice(1), run.times.length, run.nodes, run.elements);
  if (asked.field !== "none" && !fields.some((f) => f.id === asked.field)) delete asked.field;
  return asked;
}

export async function open_run(run: Run): Promise<void> {
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
  const clock = { time: () => run.times[store.now.frame] ?? 0, end: run.summary?.end_time };
  const plots = new Plots(clock, frames.blocks, store, units, (time) => player.go(nearest_frame(run.times, time)));
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
    const opening = await prepare_stage(frames, stage, run);
    if (!asked.width) view.fit(opening, 0);
    const fit = (): void => {
      if (stage.drawn) view.fit(box_of(stage.drawn.places, frames.origin), stage.drawn.frame);
    };
    const name = run.case_name.replace(/[^\w.-]+/g, "_");
    const picture = (): void => void save_picture(stage, `${name}-${store.now.frame}`);
    const film = film_button(stage, store, frames.count, name, () => show.refresh());
    by_id("controls").append(
      player_bar(run.times, store, player, units),
      look_bar(fields, run.forces !== undefined, store, units),
      view_bar(run.bodies.map((b) => b.name), store, view, fit, picture, () => void film()),
      picking.element,
    );
    view.listen((at) => {
      if (stage.drawn) store.set({ picked: pick_at(frames, stage.drawn, view.to_metres(stage.drawn.frame, at), picking.on) });
    });
    listen_to_keys(frames.count, store, player, view, fit, picture);
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
