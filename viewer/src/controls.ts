// Player and choices below the picture.
import { maps } from "./colours.ts";
import type { Field } from "./fields.ts";
import { choice, h, toggle } from "./html.ts";
import type { Player } from "./player.ts";
import type { Shown, Store, Switch } from "./store.ts";
import { choices, digits, type Units } from "./units.ts";
import type { View } from "./view.ts";

/** What moves the view. */
export type Movable = Pick<View, "zoom" | "move" | "follow">;

const button = (id: string, words: string, title: string, press: () => void) =>
  h("button", { type: "button", id, title, "aria-label": /^\w/.test(words) ? undefined : title, onclick: press }, words);

/** Time: buttons, slider, speed. */
export function player_bar(times: number[], store: Store<Shown>, player: Player, units: Units): HTMLElement {
  const count = times.length;
  const unit = units.for("s", times[times.length - 1] ?? 0);
  const slider = h("input", {
    type: "range", id: "time", min: "0", max: String(Math.max(0, count - 1)), step: "1", "aria-label": "Time",
    oninput: () => player.go(Number(slider.value)),
  });
  const time = h("output", { id: "time-text", for: "time" });
  const play = button("play", "▶", "Play or pause (space)", () => player.play());
  const update = (): void => {
    const { frame, playing } = store.now;
    slider.value = String(frame);
    const words = `${digits((times[frame] ?? 0) / unit.size)} ${unit.name}`;
    slider.setAttribute("aria-valuetext", words);
    time.textContent = `${words}  (${frame + 1} of ${count})`;
    play.textContent = playing ? "❚❚" : "▶";
    play.setAttribute("aria-pressed", String(playing));
  };
  store.on(["frame", "playing"], update);
  update();
  const rate = choice("speed", [2, 5, 10, 20, 30, 60].map((r) => [String(r), `${r} frames/s`] as const),
    String(store.now.rate), (value) => store.set({ rate: Number(value) }));
  rate.select.id = "rate";
  return h("div", { class: "bar player", role: "group", "aria-label": "Player" },
    button("first", "⇤", "First frame (Home)", () => player.go(0)),
    button("back", "←", "One frame back (left arrow)", () => player.go(store.now.frame - 1)),
    play,
    button("forward", "→", "One frame on (right arrow)", () => player.go(store.now.frame + 1)),
    button("last", "⇥", "Last frame (End)", () => player.go(count - 1)),
    slider, time, rate.label,
    toggle("loop", "Begin again at the end", store.now.loop, (loop) => store.set({ loop })));
}

/** Field, range, units, what is drawn with it. */
export function look_bar(
  fields: Field[], has_forces: boolean, store: Store<Shown>, units: Units, of_all = "of the run",
): HTMLElement {
  const now = () => fields.find((f) => f.id === store.now.field) ?? null;
  const field = choice("Field", [["none", "none"], ...fields.map((f) => [f.id, f.label] as const)],
    now()?.id ?? "none", (value) => store.set({ field: value, range: store.now.range === "own" ? "run" : store.now.range }));
  field.select.id = "field";
  const map = choice("colours", [["", "automatic"], ...Object.entries(maps).map(([id, m]) => [id, m.label] as const)],
    store.now.map, (value) => store.set({ map: value }));
  map.select.id = "map";
  const range = choice("Range", [["run", of_all], ["frame", "of this frame"], ["own", "my own"]],
    store.now.range, (value) => store.set({ range: value as Shown["range"] }));
  range.select.id = "range";
  const number = (id: string, label: string, key: "low" | "high"): HTMLInputElement => {
    const input = h("input", { type: "number", step: "any", id, "aria-label": label, onchange: () => {
      const value = Number(input.value) * unit().size;
      const other = key === "low" ? store.now.high : store.now.low;
      const fits = input.value !== "" && (key === "low" ? value < other : value > other);
      input.setAttribute("aria-invalid", String(!fits));
      input.title = fits ? "" : "the lowest colour must stand for less than the highest";
      if (fits) store.set({ range: "own", [key]: value });
    } });
    return input;
  };
  const unit = () => units.for(now()?.unit ?? "", Math.max(Math.abs(store.now.low), Math.abs(store.now.high)));
  const [low, high] = [number("low", "Lowest colour at", "low"), number("high", "Highest colour at", "high")];
  const unit_name = h("span", { class: "unit" });
  const unit_choice = h("span", { class: "bar" });
  for (const si of ["Pa", "m"]) {
    const kind = si === "Pa" ? "stresses in" : "lengths in";
    const select = choice(kind, [["", "automatic"], ...choices(si).map((u) => [u.name, u.name] as const)],
      units.chosen(si)?.name ?? "", (name) => {
        units.choose(si, name);
        store.set({ units: store.now.units + 1 });
      });
    select.select.id = `unit-${si}`;
    unit_choice.append(select.label);
  }
  const update = (): void => {
    const shown = now();
    field.select.value = shown?.id ?? "none";
    range.select.value = store.now.range;
    map.select.value = store.now.map;
    const bare = !shown || shown.flag === true;
    for (const input of [low, high, range.select, map.select]) input.disabled = bare;
    const show = (value: number): string => {
      const here = Number((value / unit().size).toPrecision(4));
      const is_plain = here === 0 || (Math.abs(here) >= 1e-3 && Math.abs(here) < 1e5);
      return bare ? "" : is_plain ? String(here) : here.toExponential().replace("+", "");
    };
    low.value = show(store.now.low);
    high.value = show(store.now.high);
    unit_name.textContent = bare ? "" : unit().name;
  };
  store.on(["field", "range", "low", "high", "units", "map"], update);
  update();
  const flag = (key: Switch, words: string, title: string) => {
    const made = toggle(words, title, store.now[key], (on) => store.set({ [key]: on }));
    const box = made.querySelector("input")!;
    box.id = `show-${key}`;
    store.on([key], () => (box.checked = store.now[key]));
    return made;
  };
  return h("div", { class: "look" },
    h("div", { class: "bar" }, field.label, range.label,
      h("span", { class: "range" }, low, " to ", high, unit_name)),
    h("div", { class: "bar" },
      flag("mesh", "mesh", "Edges of the elements (m)"), flag("outline", "outline", "Boundary of the bodies (o)"),
      flag("ghost", "undeformed", "Where the bodies were at first (u)"),
      flag("smooth", "smoothed", "Means at the nodes instead of a value for each element (s)"),
      has_forces ? flag("forces", "contact forces", "Contact forces as arrows (c)") : null),
    h("div", { class: "bar" }, map.label, unit_choice));
}

/** View: fit, zoom, follow; pictures and films. */
export function view_bar(
  bodies: string[], store: Store<Shown>, view: Movable, fit: () => void,
  picture: () => void, film: () => void,
): HTMLElement {
  const follow = choice("follow", [["", "nothing"], ...bodies.slice(0, 500).map((b) => [b, b] as const)],
    store.now.follow, (name) => view.follow(name, store.now.frame));
  follow.select.id = "follow";
  store.on(["follow"], () => (follow.select.value = store.now.follow));
  return h("div", { class: "bar" },
    button("fit", "fit", "Show all bodies of this frame (f)", fit),
    button("zoom-in", "+", "Larger (+)", () => view.zoom(1.25)),
    button("zoom-out", "−", "Smaller (-)", () => view.zoom(0.8)),
    follow.label,
    button("save-picture", "PNG", "Save this picture as PNG (p)", picture),
    button("save-film", "video", "Save the animation as a video of this view. It is recorded as it plays: where drawing is slower than the speed chosen, so is the video", film));
}

/** Keys of the whole page; those typed into a field of the page stay there. */
export function listen_to_keys(
  frames: number, store: Store<Shown>, player: Player, view: Movable, fit: () => void, picture: () => void,
): void {
  const flip = (key: Switch) => () => store.set({ [key]: !store.now[key] });
  const step = (by: number) => () => player.go(store.now.frame + by);
  const keys: Record<string, () => void> = {
    " ": () => player.play(), ArrowLeft: step(-1), ArrowRight: step(1), PageUp: step(-10), PageDown: step(10),
    Home: () => player.go(0), End: () => player.go(frames - 1),
    "+": () => view.zoom(1.25), "=": () => view.zoom(1.25), "-": () => view.zoom(0.8), f: fit, p: picture,
    m: flip("mesh"), o: flip("outline"), u: flip("ghost"), s: flip("smooth"), c: flip("forces"),
    a: () => view.move(60, 0), d: () => view.move(-60, 0), w: () => view.move(0, 60), x: () => view.move(0, -60),
  };
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (target.closest("input:not([type=checkbox]):not([type=range]), select, textarea, pre, summary, .scroll")) return;
    if (target.closest("button, input[type=checkbox]") && event.key === " ") return;
    if (target.closest("input[type=range]") && !(event.key in { " ": 0, f: 0, p: 0, m: 0, o: 0, u: 0, s: 0, c: 0 })) return;
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}
