// Puts the page of a study together: its levels side by side, its tables and plots.
import { follow_address, from_address } from "./address.ts";
import { Blocks } from "./blocks.ts";
import { listen_to_keys, look_bar, player_bar, view_bar } from "./controls.ts";
import { nearest_frame } from "./frames.ts";
import { by_id, h } from "./html.ts";
import { failed, film_button, first_field, room, start, theme_choice } from "./parts.ts";
import { Player } from "./player.ts";
import { Plots } from "./plots.ts";
import { save_picture } from "./saving.ts";
import { Store, type Shown } from "./store.ts";
import { is_of_steps, is_sweep, label_of, step_label, verdicts, type Study, type StudyData } from "./study.ts";
import { history_sections, NumberPlot, type Line } from "./study_plots.ts";
import { differences, runs_table, StudyTables, verdict_mark } from "./study_tables.ts";
import { folded } from "./texts.ts";
import { digits, Units, with_unit } from "./units.ts";
import { level_colour, Wall } from "./wall.ts";

function header(study: Study): HTMLElement {
  const fact = (name: string, value: string) => h("div", {}, h("dt", {}, name), h("dd", {}, value));
  const done = study.runs.filter(({ state }) => state === "done").length;
  const lacking = study.runs.length - done;
  const facts = is_sweep(study)
    ? [fact("varied", study.varied.join(", ") || "–")]
    : [fact("meshes", String(study.meshes)), study.mesh_ratio === null ? null : fact("each finer by", digits(study.mesh_ratio, 3)),
        fact("time steps", String(study.steps)),
        study.tolerance === null ? null : fact("converged up to", `${digits(100 * study.tolerance, 3)} %`)];
  return h("header", {},
    h("h1", {}, study.case_name),
    h("p", { class: "kind" }, is_sweep(study) ? "sweep" : "convergence study"),
    h("dl", { class: "facts" }, ...facts, fact("runs", lacking > 0 ? `${done} of ${study.runs.length} done` : String(done)),
      study.version ? fact("by", study.version) : null));
}

/** "duration of stop = 1.38 ms ± 0.03 ms (mesh)": what it is small, how much it is large, how sure it is beside it. */
function headlines(study: Study): HTMLElement | null {
  if (study.headlines.length === 0) return null;
  // There is a line for each headline that has a value, in the same order.
  const marked = study.quantities.filter(({ headline, value }) => headline && value !== null);
  return h("section", { id: "headlines", "aria-label": "Headlines" }, ...study.headlines.map((line, k) => {
    const words = line.replaceAll("+-", "±");
    const verdict = marked.length === study.headlines.length && !is_sweep(study) ? marked[k].verdict || "unknown" : "";
    const kind = verdict ? (verdicts[verdict] ?? verdicts.unknown).kind : "";
    const mark = verdict ? verdict_mark(verdict) : null;
    const at = words.indexOf(" = ");
    if (at < 0) return h("p", { class: kind }, h("span", { class: "what" }, words), mark);
    const [, much, rest] = /^(.*?)((?:\s*±|\s*[:;,(]\s).*|\s\(.*|)$/.exec(words.slice(at + 3))!;
    const bars = rest.replace(/^[:;,]\s*/, "").trim().split(/\s+(?=±)|,\s+/).filter((bar) => bar);
    return h("p", { class: kind }, h("span", { class: "what" }, words.slice(0, at)), h("span", { class: "much" }, much), mark,
      h("span", { class: "bars" }, ...bars.map((bar) => h("span", {}, bar))));
  }));
}

function notes(data: StudyData, levels: ShownLevel[]): HTMLElement | null {
  const lacking = data.study.runs.filter(({ state }) => state !== "done")
    .map(({ name, state, reason }) => `${name} ${state === "failed" ? "failed" : "is missing"}${reason ? `: ${reason}` : ""}`)
    .concat(data.study.warnings ?? []);
  // What several runs go without is said once.
  const by_words = new Map<string, string[]>();
  for (const { run, label } of levels) for (const words of run.left_out) by_words.set(words, [...(by_words.get(words) ?? []), label]);
  const left_out = [...data.left_out, ...[...by_words].map(([words, labels]) => `${labels.join(", ")}: ${words}`)];
  if (lacking.length + left_out.length === 0) return null;
  const small = left_out.map((words) => h("li", { class: "left-out" }, words));
  const most = 3;
  return h("div", { class: "all-notes", role: "region", "aria-label": "Notes" },
    h("ul", { class: "notes" }, ...lacking.map((words) => h("li", {}, words)), ...(small.length <= most ? small : [])),
    small.length <= most ? null : h("details", {}, h("summary", {}, `Left out of this page (${small.length})`), h("ul", { class: "notes" }, ...small)));
}

interface ShownLevel extends Line {
  facts: string;
}

/** The runs of the page, from the coarsest on, named and coloured. */
function shown_levels({ study, runs }: StudyData, units: Units): ShownLevel[] {
  const by_step = is_of_steps(study, units);
  return runs.map((run, k) => {
    const told = study.runs.find(({ name }) => name === run.name);
    const facts = [`${run.elements || told?.elements ? `${(run.elements || told!.elements).toLocaleString("en")} elements` : ""}`];
    const step = told?.longest_step ?? told?.shortest_step ?? null;
    if (step !== null) facts.push(`steps of ${with_unit(step, "s", units, 3)}`);
    return { run, label: !told ? run.name : by_step ? step_label(told, units) : label_of(study, told, units), facts: facts.filter((f) => f).join(" · "), colour: level_colour(k) };
  });
}

export async function open_study(data: StudyData): Promise<void> {
  const { study } = data;
  document.title = `${study.case_name} – Udar`;
  const units = new Units();
  units.follow(data.runs.at(-1)?.case_text ?? "");
  const blocks = new Blocks(room);
  const levels = shown_levels(data, units);
  const moving = levels.filter(({ run }) => run.times.length > 0);
  const store = new Store<Shown>({ ...start, mesh: false }); // lines of other widths would be other colours
  const main = document.querySelector("main")!;
  main.classList.add("study");

  let player: Player | null = null;
  const bar = by_id<HTMLCanvasElement>("bar");
  const told = (): void => {
    if (!wall.is_drawn) return;
    wall.paint_bar(bar);
    document.body.dataset.frame = String(store.now.frame);
    document.body.dataset.time = String(wall.times[store.now.frame]);
  };
  const wall = new Wall(moving, store, units, blocks, told);
  const clock = { time: () => wall.times[store.now.frame] ?? 0, end: data.runs.at(-1)?.summary?.end_time };
  const plots = new Plots(clock, blocks, store, units, (time) => player?.go(nearest_frame(wall.times, time)));
  const number = new NumberPlot(study, units, store);
  const tables = new StudyTables(study, units, store, (quantity) => {
    number.show(quantity);
    number.element.scrollIntoView({ block: "nearest", behavior: "smooth" });
  });

  by_id("head").append(header(study), theme_choice(store, () => {
    wall.repaint();
    wall.paint_bar(bar);
    plots.redraw();
    number.redraw();
  }));
  const words = notes(data, levels);
  if (words) by_id("head").after(words);
  const said = headlines(study);
  if (said) main.prepend(said);
  by_id("stage").replaceWith(wall.root);
  by_id("keys-click").textContent = "a click on a name shows that one alone, or all again;";
  const histories = h("section", { id: "history-plots", "aria-label": "Histories" });
  const fill = (): void => {
    const sections = history_sections(levels, plots, blocks);
    histories.replaceChildren(...(sections.length > 0 ? [h("h2", {}, "Histories"), ...sections] : []));
    histories.hidden = sections.length === 0;
    differing.replaceChildren(...["Differences of histories", "Differences of fields"].flatMap((title, k) =>
      differences(title, study, k === 0 ? study.histories : study.fields, units) ?? []));
    differing.hidden = !differing.firstChild;
    runs.replaceChildren(...runs_table(study, units).childNodes);
  };
  const differing = h("section", { id: "differences", "aria-label": "Differences" });
  const runs = runs_table(study, units);
  fill();
  store.on(["units"], fill);
  by_id("numbers").append(tables.element, differing, number.element, runs, histories);
  const text = folded("Case", data.runs.at(-1)?.case_text ?? "");
  if (text) by_id("texts").append(text);
  else by_id("texts").remove();

  if (moving.length === 0) {
    by_id("picture").remove();
  } else {
    player = await open_wall(wall, store, units, study, bar);
  }
  document.body.dataset.ready = "true";
  setTimeout(() => plots.make_some(30), 1500);
}

/** Everything that moves. */
async function open_wall(
  wall: Wall, store: Store<Shown>, units: Units, study: Study, bar: HTMLCanvasElement,
): Promise<Player> {
  const { fields } = wall;
  const asked_for = (): Partial<Shown> => {
    const asked = from_address(location.hash.slice(1), wall.times.length, 0, 0);
    if (asked.field !== "none" && !fields.some((f) => f.id === asked.field)) delete asked.field;
    return { only: "", ...asked };
  };
  const failures = wall.panels.map(({ stage }) => stage.failure).filter((f) => f);
  if (failures.length > 0) failed(failures[0]);
  wall.root.addEventListener("failure", (event) => failed((event as CustomEvent<string>).detail), true);
  const asked = asked_for();
  const finest = wall.panels.at(-1)!;
  store.set({ field: first_field(finest.frames, finest.show.all_fields), ...asked });
  await wall.open(asked.width !== undefined);
  const player = new Player(wall.times.length, store, () => wall.is_drawn);
  const fit = (): void => wall.fit();
  const name = study.case_name.replace(/[^\w.-]+/g, "_");
  const picture = (): void => void save_picture(wall, `${name}-${store.now.frame}`);
  const film = film_button(wall, store, wall.times.length, name, () => wall.refresh());
  const bodies = [...new Set(wall.panels.flatMap(({ run }) => run.bodies.map((b) => b.name)))];
  by_id("controls").append(
    player_bar(wall.times, store, player, units),
    look_bar(fields, wall.panels.some(({ run }) => run.forces !== undefined), store, units, "of all"),
    view_bar(bodies, store, wall.view, fit, picture, () => void film()),
  );
  listen_to_keys(wall.times.length, store, player, wall.view, fit, picture);
  store.on(["low", "high", "map", "units", "only", "field"], () => wall.paint_bar(bar));
  store.on(["frame"], () => wall.is_drawn && (document.body.dataset.frame = String(store.now.frame)));
  new ResizeObserver(() => wall.paint_bar(bar)).observe(bar);
  follow_address(store);
  addEventListener("hashchange", () => store.set(asked_for()));
  const in_peace = location.hash !== "" || matchMedia("(prefers-reduced-motion: reduce)").matches;
  if (!in_peace) player.play();
  return player;
}
