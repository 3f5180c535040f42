// The numbers of a study in tables: what they are on each level, and whether they settle.
import { choice, h } from "./html.ts";
import type { Shown, Store } from "./store.ts";
import {
  is_of_steps, is_sweep, label_of, levels_of, mesh_label, step_levels_of, verdicts,
  type Estimate, type Level, type Study, type StudyDifference, type StudyQuantity, type Value,
} from "./study.ts";
import { digits, with_unit, type Units } from "./units.ts";

const in_words = new Set(["name", "run", "unit", "state", "varied", "verdict"]);
const cell_head = (words: string, title?: string) =>
  h("th", { scope: "col", title, class: in_words.has(words) ? "words" : undefined }, words);
function percent(part: Value, count = 3): string {
  if (part === null) return "–";
  const all = part < 1e-9 ? 0 : 100 * part; // less is rounding
  return all > 1000 ? "> 1000 %" : `${all >= 10 ? String(Math.round(all)) : digits(all, count)} %`;
}

/** A table that can be scrolled. */
function scrolled(caption: string, ...inside: (Node | null)[]): HTMLElement {
  return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption }, h("table", {}, ...inside));
}

/** A verdict as sign, word and colour. */
export function verdict_mark(verdict: string): HTMLElement {
  const look = verdicts[verdict] ?? verdicts.unknown;
  return h("span", { class: `mark ${look.kind}` }, h("span", { class: "sign", "aria-hidden": "true" }, look.sign), verdict || "unknown");
}

const of_a_column = new Set(["min", "max", "max_abs", "last", "time_of_min", "time_of_max"]);

/** "contacts.stop." faint, "duration" not; of "corner.displacement_y.max" the last two. */
function name_of(path: string): Node[] {
  const parts = path.split(".");
  const plain = parts.length > 2 && of_a_column.has(parts.at(-1)!) ? 2 : 1;
  const faint = parts.slice(0, -plain).map((part) => `${part}.`).join("");
  return [h("span", { class: "faint" }, faint), document.createTextNode(parts.slice(-plain).join("."))];
}

/** What the user looks for in the tables. */
class Wanted {
  text = "";
  verdict = "";
  refined: "mesh" | "step" = "mesh";

  get is_some(): boolean {
    return this.text.trim() !== "" || this.verdict !== "";
  }
  fits(name: string, verdict: string): boolean {
    const words = this.text.trim().toLowerCase().split(/\s+/);
    return words.every((word) => name.toLowerCase().includes(word)) && (this.verdict === "" || (verdict || "unknown") === this.verdict);
  }
}

/** A row that says why, below that of a verdict which is pressed. */
function with_reason(row: HTMLTableRowElement, verdict: string, reasons: [string, string][], columns: number): HTMLTableRowElement {
  const told = reasons.filter(([, reason]) => reason !== "");
  const cell = h("td", { class: "verdict-cell" });
  row.append(cell);
  if (told.length === 0) {
    cell.append(verdict_mark(verdict));
    return row;
  }
  const words = told.map(([of, reason]) => (told.length > 1 ? `${of}: ${reason}` : reason));
  const button = h("button", { type: "button", class: "why", title: words.join("\n"), "aria-expanded": "false", onclick: () => {
    const is_open = button.getAttribute("aria-expanded") === "true";
    button.setAttribute("aria-expanded", String(!is_open));
    if (is_open) row.nextElementSibling?.remove();
    else row.after(h("tr", { class: "reason" }, h("td", { colspan: String(columns) }, words.join(" · "))));
  } }, verdict_mark(verdict));
  cell.append(button);
  return row;
}

/** A number of a level, with the difference from the next one below it. */
function value_cell(value: Value, size: number, difference: Value | undefined): HTMLElement {
  return h("td", { "data-value": value === null ? "" : String(value) }, digits(value === null ? null : value / size, 5),
    difference === undefined || difference === null ? null : h("span", { class: "difference" }, percent(difference, 2)));
}

export class StudyTables {
  readonly element = h("section", { id: "quantities", "aria-label": "Quantities" });
  readonly #body = h("div");
  readonly #wanted = new Wanted();
  readonly #open = new Set<string>(); // groups that the user has unfolded

  /** `plot`: shows a quantity over the levels. */
  constructor(
    private readonly study: Study,
    private readonly units: Units,
    store: Store<Shown>,
    private readonly plot: (quantity: StudyQuantity) => void,
  ) {
    if (is_of_steps(study, units)) this.#wanted.refined = "step";
    this.element.append(h("h2", {}, "Quantities"), this.#filters(), this.#body);
    store.on(["units"], () => this.#fill());
    this.#fill();
  }

  get #levels(): Level[] {
    return this.#wanted.refined === "step" ? step_levels_of(this.study, this.units) : levels_of(this.study, this.units);
  }

  #filters(): HTMLElement {
    const { study } = this;
    const text = h("input", { type: "search", id: "filter", placeholder: "name", "aria-label": "Only names with", oninput: () => {
      this.#wanted.text = text.value;
      this.#fill();
    } });
    const bar = h("div", { class: "bar filters" }, h("label", { class: "choice" }, h("span", {}, "show"), text));
    if (!is_sweep(study)) bar.append(this.#verdict_filter());
    if (step_levels_of(study, this.units).length > 0) {
      const refined = choice("refining", [["mesh", "the mesh"], ["step", "the time step"]], this.#wanted.refined, (value) => {
        this.#wanted.refined = value as "mesh" | "step";
        this.#fill();
      });
      refined.select.id = "refined";
      bar.append(refined.label);
    }
    return bar;
  }

  #verdict_filter(): HTMLElement {
    const counts = new Map<string, number>();
    for (const { verdict } of this.study.quantities) counts.set(verdict || "unknown", (counts.get(verdict || "unknown") ?? 0) + 1);
    const group = h("span", { class: "chips", role: "group", "aria-label": "Only this verdict" });
    for (const [verdict, { sign, kind }] of Object.entries(verdicts)) {
      const count = counts.get(verdict) ?? 0;
      if (count === 0) continue;
      const chip = h("button", { type: "button", class: `chip ${kind}`, "aria-pressed": "false", "data-verdict": verdict, onclick: () => {
        this.#wanted.verdict = this.#wanted.verdict === verdict ? "" : verdict;
        for (const other of group.querySelectorAll<HTMLElement>("button")) {
          other.setAttribute("aria-pressed", String(other.dataset.verdict === this.#wanted.verdict));
        }
        this.#fill();
      } }, h("span", { class: "sign", "aria-hidden": "true" }, sign), `${count} ${verdict}`);
      group.append(chip);
    }
    return group;
  }

  #fill(): void {
    const wanted = this.#wanted;
    const fitting = this.study.quantities.filter((q) => wanted.fits(q.name, q.verdict));
    const headlines = fitting.filter((q) => q.headline);
    const groups = new Map<string, StudyQuantity[]>();
    for (const quantity of fitting) {
      if (quantity.headline) continue;
      const group = quantity.name.split(".")[0];
      groups.set(group, [...(groups.get(group) ?? []), quantity]);
    }
    this.#body.replaceChildren();
    if (fitting.length === 0) this.#body.append(h("p", {}, wanted.is_some ? "None fits." : "This study has no quantities yet."));
    if (headlines.length > 0) this.#body.append(this.#table("Headlines", headlines));
    for (const [group, quantities] of groups) this.#body.append(this.#group(group, quantities, headlines.length === 0 && groups.size === 1));
  }

  #group(group: string, quantities: StudyQuantity[], alone: boolean): HTMLElement {
    const inside = h("div");
    const details = h("details", { "data-group": group, open: this.#wanted.is_some || this.#open.has(group) || alone },
      h("summary", {}, `${group} (${quantities.length})`), inside);
    const fill = (): void => {
      if (details.open && !inside.firstChild) inside.append(this.#table(group, quantities));
    };
    details.addEventListener("toggle", () => {
      if (!this.#wanted.is_some) (details.open ? this.#open.add(group) : this.#open.delete(group));
      fill();
    });
    fill();
    return details;
  }

  #table(caption: string, quantities: StudyQuantity[]): HTMLElement {
    const levels = this.#levels;
    const bare = is_sweep(this.study);
    const ends = bare ? [] : [
      cell_head("order", "observed, from the three finest levels"), cell_head("for size 0", "Richardson's extrapolation"),
      cell_head("± error", "error bar of the finest value"), cell_head("verdict"),
    ];
    const head = h("thead", {}, h("tr", {}, cell_head("name"), cell_head("unit"),
      ...levels.map(({ label }) => cell_head(label)), ...ends));
    const most = 400;
    const rows = quantities.slice(0, most).map((quantity) => this.#row(quantity, levels, bare, caption === "Headlines" ? "" : `${caption}.`));
    const is_group = caption !== "Headlines";
    return h("div", { class: is_group ? "group" : "" }, is_group ? null : h("h3", {}, caption), scrolled(caption, head, h("tbody", {}, ...rows)),
      quantities.length > most ? h("p", { class: "left-out" }, `The first ${most} of ${quantities.length}; look for a name above, or in study.csv.`) : null);
  }

  /** `group`: how names begin, which is not said again. */
  #row(quantity: StudyQuantity, levels: Level[], bare: boolean, group: string): HTMLTableRowElement {
    const name = quantity.name.startsWith(group) ? quantity.name.slice(group.length) : quantity.name;
    const estimate: Estimate = quantity[this.#wanted.refined];
    const values = levels.map(({ index }) => quantity.values[index] ?? null);
    const unit = this.units.for(quantity.unit, Math.max(0, ...values.map((v) => Math.abs(v ?? 0))));
    // Differences are those of each level that has a value from the next one; the finest has none.
    const known = values.flatMap((v, k) => (v === null ? [] : [k]));
    const offset = known.length - 1 - estimate.differences.length;
    const difference = (k: number): Value | undefined => {
      const at = known.indexOf(k);
      return at < 0 ? undefined : estimate.differences[at - offset];
    };
    const row = h("tr", { "data-quantity": quantity.name },
      h("th", { scope: "row" }, h("button", { type: "button", class: "name", title: "plots it", onclick: () => this.plot(quantity) }, ...name_of(name))),
      h("td", { class: "unit" }, unit.name),
      ...values.map((value, k) => value_cell(value, unit.size, bare ? undefined : difference(k))));
    if (bare) return row;
    const scaled = (value: Value, count: number): string => digits(value === null ? null : value / unit.size, count);
    row.append(h("td", {}, digits(estimate.order, 3)), h("td", {}, scaled(estimate.extrapolated, 5)),
      h("td", {}, estimate.error === null ? "–" : `± ${scaled(estimate.error, 2)}`));
    const verdict = this.#wanted.refined === "step" ? estimate.verdict : quantity.verdict || estimate.verdict;
    return with_reason(row, verdict, [["mesh", quantity.mesh.reason], ["time step", quantity.step.reason]], levels.length + 6);
  }
}

/** Histories or fields: how far each level is from the next one. */
export function differences(title: string, study: Study, all: StudyDifference[], units: Units): HTMLElement | null {
  if (all.length === 0 || is_sweep(study)) return null;
  const inside = h("div");
  const with_time = all.some(({ time }) => time !== null);
  const fill = (): void => {
    if (inside.firstChild) return;
    if (all.some((d) => d.mesh_l2.differences.length > 0)) {
      inside.append(one("L2 norm, part of the finest", (d) => d.mesh_l2, "mesh"),
        one("Largest difference, part of the largest value", (d) => d.mesh_max, "mesh"));
    }
    if (all.some((d) => d.step_l2.differences.length > 0)) {
      inside.append(one("L2 norm, refining the time step", (d) => d.step_l2, "step"),
        one("Largest difference, refining the time step", (d) => d.step_max, "step"));
    }
  };
  const one = (caption: string, of: (d: StudyDifference) => Estimate, which: "mesh" | "step"): HTMLElement => {
    const levels = which === "mesh" ? levels_of(study, units) : step_levels_of(study, units);
    const most = Math.max(0, ...all.map((d) => of(d).differences.length));
    const label = (k: number): string => {
      const [from, to] = [levels.at(k - most - 1)?.label, levels.at(k - most)?.label];
      return from && to ? `${from} → ${to}` : `${k + 1} → ${k + 2}`;
    };
    const head = h("thead", {}, h("tr", {}, cell_head("name"), with_time ? cell_head("time") : null,
      ...Array.from({ length: most }, (_, k) => cell_head(label(k))), cell_head("order"), cell_head("± error"), cell_head("verdict")));
    const rows = all.map((d) => {
      const estimate = of(d);
      const padded = [...Array<Value>(most - estimate.differences.length).fill(null), ...estimate.differences];
      const row = h("tr", { "data-difference": d.name }, h("th", { scope: "row" }, ...name_of(d.name)),
        with_time ? h("td", {}, with_unit(d.time, "s", units)) : null,
        ...padded.map((part) => h("td", {}, percent(part))), h("td", {}, digits(estimate.order, 3)),
        h("td", {}, estimate.error === null ? "–" : `± ${percent(estimate.error, 2)}`));
      return with_reason(row, estimate.verdict || d.verdict, [["", estimate.reason]], most + 4 + (with_time ? 1 : 0));
    });
    return scrolled(caption, h("caption", {}, caption), head, h("tbody", {}, ...rows));
  };
  const details = h("details", { class: "differences" }, h("summary", {}, `${title} (${all.length})`), inside);
  details.addEventListener("toggle", () => details.open && fill());
  return details;
}

/** What each run cost and what became of it. */
export function runs_table(study: Study, units: Units): HTMLElement {
  const seconds = (value: Value): string => (value === null ? "–" : value < 100 ? `${digits(value, 3)} s` : `${digits(value / 60, 3)} min`);
  const cost_of = (mesh: number, step: number): Value => study.runs.find((r) => r.mesh === mesh && r.step === step)?.stepping_seconds ?? null;
  const rows = study.runs.map((run) => {
    const before = cost_of(run.mesh - 1, run.step);
    const growth = !is_sweep(study) && before !== null && before > 0 && run.stepping_seconds !== null ? run.stepping_seconds / before : null;
    const [state, kind] = run.state === "done" ? ["✓ done", "good"] : run.state === "failed" ? ["✗ failed", "bad"] : [`? ${run.state || "missing"}`, "unknown"];
    return h("tr", { "data-run": run.name }, h("th", { scope: "row" }, run.name),
      h("td", { class: "words" }, h("span", { class: `mark ${kind}` }, state), run.reason ? h("span", { class: "run-reason" }, run.reason) : null),
      h("td", is_sweep(study) ? { class: "words" } : {}, is_sweep(study) ? label_of(study, run, units) : mesh_label(study, run, units)),
      h("td", {}, run.elements > 0 ? run.elements.toLocaleString("en") : "–"), h("td", {}, run.steps > 0 ? run.steps.toLocaleString("en") : "–"),
      h("td", {}, with_unit(run.shortest_step, "s", units, 3)), h("td", {}, seconds(run.stepping_seconds)),
      is_sweep(study) ? null : h("td", {}, growth === null ? "" : `× ${digits(growth, 3)}`),
      h("td", {}, percent(run.energy_error, 2)),
      h("td", {}, h("span", { class: `mark ${run.verdict || "unknown"}` }, run.verdict || "–")));
  });
  const heads = ["run", "state", is_sweep(study) ? "varied" : "elements of", "elements", "steps", "shortest step", "computed in",
    ...(is_sweep(study) ? [] : ["cost"]), "energy error", "books"];
  const titles: Record<string, string> = { cost: "seconds against those of the next coarser mesh with the same time step", books: "verdict of the run itself: do energy and momentum balance?" };
  return h("section", { id: "runs" }, h("h2", {}, "Runs"),
    scrolled("Runs", h("thead", {}, h("tr", {}, ...heads.map((head) => cell_head(head, titles[head])))), h("tbody", {}, ...rows)));
}
