// What is said of the run in words and tables.
import { h, meaning, table } from "./html.ts";
import type { Contact, Run } from "./run.ts";
import { digits, with_unit, type Units } from "./units.ts";

const percent = (part: number | null): string => (part === null ? "–" : `${digits(100 * part, 2)} %`);
const seconds = (s: number): string => (s < 100 ? `${digits(s, 3)} s` : `${Math.round(s / 6) / 10} min`);

/** Name, verdict and the numbers to look at first. */
export function header(run: Run): HTMLElement {
  const { summary: s } = run;
  const fact = (name: string, value: string) => h("div", { title: meaning(name) }, h("dt", {}, name), h("dd", {}, value));
  const stops: Record<string, string> = {
    interrupted: "interrupted", numerical: "stopped by a numerical failure", disk: "stopped by a full disk",
  };
  return h(
    "header",
    {},
    h("h1", {}, run.case_name),
    s
      ? h("p", { class: `verdict ${s.verdict}`, id: "verdict" }, `verdict: ${s.verdict}`)
      : h("p", { class: "verdict bad", id: "verdict" }, "the run left no summary"),
    s && stops[s.stop_reason] ? h("p", { class: "verdict bad" }, stops[s.stop_reason]) : null,
    s
      ? h(
          "dl",
          { class: "facts" },
          fact("elements", s.elements.toLocaleString("en")),
          fact("steps", s.steps.toLocaleString("en")),
          fact("energy error", percent(s.energy_error)),
          fact("momentum error", digits(s.momentum_error, 1)),
          s.spin_error === undefined ? null : fact("spin error", digits(s.spin_error, 1)),
          fact("penetration", `${percent(s.penetration_ratio)} of an element`),
          fact("computed in", `${seconds(s.stepping_seconds)}, ${s.threads === 1 ? "1 thread" : `${s.threads} threads`}`),
        )
      : null,
  );
}

/** Reasons of the verdict, warnings, what is left out of the page. */
export function notes(run: Run): HTMLElement | null {
  const all = [...(run.summary?.reasons ?? []), ...(run.summary?.warnings ?? []).map((w) => `warning: ${w}`)];
  if (run.left_out.length === 0 && all.length === 0) return null;
  return h(
    "ul",
    { class: "notes", "aria-label": "Notes" },
    ...all.map((words) => h("li", {}, words)),
    ...run.left_out.map((words) => h("li", { class: "left-out" }, words)),
  );
}

export function contacts(run: Run, units: Units): HTMLElement[] {
  const all = Object.entries(run.summary?.contacts ?? {}).filter(([, c]) => c.episodes.length > 0);
  if (!run.summary) return [h("p", {}, "Contacts are not known: the run left no summary.")];
  if (all.length === 0) return [h("p", {}, "Nothing touched.")];
  const most = 40;
  const shown = [...all].sort(([, a], [, b]) => (b.peak_force ?? 0) - (a.peak_force ?? 0)).slice(0, most);
  const time = (s: number | null): string => with_unit(s, "s", units);
  const vector = ([x, y]: Contact["impulse"]): string => {
    const least = 1e-9 * Math.hypot(x ?? 0, y ?? 0); // below this it is rounding
    const part = (v: number | null): string => digits(v !== null && Math.abs(v) < least ? 0 : v);
    return `${part(x)}, ${part(y)}`;
  };
  const out = [
    table(
      "Contacts",
      ["between", "first touch", "left", "duration", "99 % of push", "peak force"],
      shown.map(([name, c]) => [
        name, time(c.first_touch), c.last_separation === null ? "still on" : time(c.last_separation), time(c.duration),
        time(c.duration_99), with_unit(c.peak_force, "N", units),
      ]),
    ),
  ];
  const episodes = shown.flatMap(([name, c]) => c.episodes.map((e, k) => ({ name, e, k })));
  const some = episodes.slice(0, 200);
  out.push(
    table(
      "Episodes",
      ["between", "", "touch", "duration", "peak force", "impulse, N s", "e", "e along"],
      some.map(({ name, e, k }) => [
        name, String(k + 1), time(e.first_touch), e.separation === null ? "still on" : time(e.duration),
        with_unit(e.peak_force, "N", units), vector(e.impulse), digits(e.restitution, 3),
        digits(e.tangential_restitution, 3),
      ]),
    ),
  );
  const hidden = all.length - shown.length;
  if (hidden > 0 || episodes.length > some.length) {
    out.push(h("p", { class: "left-out" },
      `The ${shown.length} contacts with the largest force are shown, and ${some.length} of their episodes; all ${all.length} are in summary.json.`));
  }
  return out;
}

/** What ran, where and when. */
export function origin(run: Run): HTMLElement {
  const s = run.summary;
  const rows: [string, string | undefined][] = [
    ["program", run.version || undefined],
    ["machine", s?.machine && `${s.machine.processor || "unknown processor"}, ${s.machine.threads} threads`],
    ["started", s?.started],
    ["wall time", s ? seconds(s.wall_seconds) : undefined],
    ["element-steps per second", s ? `${digits(1e-6 * s.element_steps_per_second, 3)} million` : undefined],
  ];
  return h("dl", { class: "rows" },
    ...rows.flatMap(([name, value]) => (value ? [h("dt", {}, name), h("dd", {}, value)] : [])));
}

/** A text of the run folder, folded away. */
export function folded(title: string, text: string, open = false): HTMLElement | null {
  if (!text) return null;
  return h("details", { open }, h("summary", {}, title),
    h("pre", { tabindex: "0", "aria-label": title }, text));
}
