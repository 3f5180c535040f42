// Numbers for people: units that suit their size and their user.

export interface Unit {
  name: string;
  size: number; // in SI
}

const unit = (name: string, size: number): Unit => ({ name, size });

/** By SI unit: what people write instead, small ones first. */
const families: Record<string, Unit[]> = {
  s: [unit("µs", 1e-6), unit("ms", 1e-3), unit("s", 1)],
  m: [unit("µm", 1e-6), unit("mm", 1e-3), unit("cm", 1e-2), unit("m", 1), unit("in", 0.0254)],
  Pa: [
    unit("Pa", 1), unit("kPa", 1e3), unit("MPa", 1e6), unit("GPa", 1e9), unit("kgf/cm²", 98066.5),
    unit("psi", 6894.757293168361), unit("ksi", 6894757.293168361),
  ],
  N: [unit("N", 1), unit("kN", 1e3), unit("MN", 1e6), unit("kgf", 9.80665), unit("lbf", 4.4482216152605)],
  J: [unit("mJ", 1e-3), unit("J", 1), unit("kJ", 1e3), unit("MJ", 1e6)],
  kg: [unit("g", 1e-3), unit("kg", 1)],
};

/** Units that nobody chose for the size of a number: they come only when asked for. */
const only_asked = new Set(["cm", "in", "kgf/cm²", "psi", "ksi", "kgf", "lbf"]);

const pretty: Record<string, string> = {
  "m/s^2": "m/s²", "kg m^2/s": "kg m²/s", "N s": "N s", "kg m/s": "kg m/s",
};

/** Units the user may choose between for an SI unit. */
export const choices = (si: string): Unit[] => families[si] ?? [];

export class Units {
  readonly #chosen = new Map<string, Unit>();

  choose(si: string, name: string): void {
    const found = choices(si).find((u) => u.name === name);
    if (found) this.#chosen.set(si, found);
    else this.#chosen.delete(si);
  }

  chosen(si: string): Unit | undefined {
    return this.#chosen.get(si);
  }

  /** The unit for numbers up to `most` in SI: the chosen one, or one that makes them 1 to 1000. */
  for(si: string, most: number): Unit {
    const chosen = this.#chosen.get(si);
    if (chosen) return chosen;
    const family = choices(si).filter((u) => !only_asked.has(u.name));
    const plain = unit(pretty[si] ?? si, 1);
    if (family.length === 0 || !(most > 0)) return family.find((u) => u.size === 1) ?? plain;
    return [...family].reverse().find((u) => most >= u.size * 0.9995) ?? family[0];
  }

  /** The units of the case file: what its author thinks in. */
  follow(case_text: string): void {
    const stress = /yield_stress\s*=\s*"[^"]*?\d\s*([^\d\s"][^"]*)"/.exec(case_text)?.[1];
    const spelt: Record<string, string> = { "kgf/cm^2": "kgf/cm²", "kgf/cm2": "kgf/cm²" };
    if (stress) this.choose("Pa", spelt[stress.trim()] ?? stress.trim());
    const length = /element_size\s*=\s*"[^"]*?\d\s*(cm|mm|in|m)"/.exec(case_text)?.[1];
    if (length) this.choose("m", length);
  }
}

/** Four digits and no more: 0.0123, 12.3, 1.23e-7. */
export function digits(value: number | null | undefined, count = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(count - 1) : value.toPrecision(count);
  const [mantissa, exponent] = text.split("e");
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  return (exponent === undefined ? short : `${short}e${exponent.replace("+", "")}`).replaceAll("-", "−");
}

/** A number with the unit that suits it. */
export function with_unit(value: number | null | undefined, si: string, units: Units, count = 4): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const u = units.for(si, Math.abs(value));
  return `${digits(value / u.size, count)}${u.name ? " " + u.name : ""}`;
}

/** Steps of 1, 2 or 5 times a power of ten: at most `most` of them between two numbers. */
export function nice_step(low: number, high: number, most: number): number {
  const rough = (high - low) / most;
  if (!(rough > 0) || !Number.isFinite(rough)) return 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5, 10].find((m) => m * power >= rough * (1 - 1e-9)) ?? 10);
}

/** Round numbers from `low` to `high`. */
export function nice_ticks(low: number, high: number, most: number): number[] {
  const step = nice_step(low, high, most);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
}
