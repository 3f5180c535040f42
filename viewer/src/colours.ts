// Colour maps whose lightness tells the value, in even steps for the eye (OKLab: Ottosson 2020).

type Rgb = [number, number, number]; // 0 to 255

const channel = (c: number): number => {
  const x = c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
  return Math.round(255 * Math.min(1, Math.max(0, x)));
};

/** OKLab lightness, chroma and hue (degrees) as sRGB; formulas of B. Ottosson, "A perceptual color space for image
 *  processing" (2020). */
export function oklch(lightness: number, chroma: number, hue: number): Rgb {
  const a = chroma * Math.cos((hue * Math.PI) / 180);
  const b = chroma * Math.sin((hue * Math.PI) / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    channel(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

const steps = 256;
const table = (at: (t: number) => Rgb): Uint8Array => {
  const out = new Uint8Array(4 * steps);
  for (let k = 0; k < steps; ++k) out.set([...at(k / (steps - 1)), 255], 4 * k);
  return out;
};

/** From one list of colours, evenly spaced. */
const through = (stops: string[]) => (t: number): Rgb => {
  const at = t * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  const part = at - k;
  const rgb = (hex: string): Rgb => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)) as Rgb;
  const [from, to] = [rgb(stops[k]), rgb(stops[k + 1])];
  return from.map((c, i) => Math.round(c + part * (to[i] - c))) as Rgb;
};

export interface ColourMap {
  label: string;
  table: Uint8Array; // 256 times red, green, blue, opacity
}

/** The colours of the still pictures; from blue over pale grey to red, equally light on both sides; grey. */
export const maps: Record<string, ColourMap> = {
  even: {
    label: "dark to light",
    table: table(through([
      "#2b1f64", "#282970", "#22347b", "#153f85", "#004b8a", "#045788", "#026189", "#016c8c", "#04768e", "#018091",
      "#008a93", "#049594", "#02a094", "#0daa92", "#02b68d", "#38bf87", "#5dc681", "#7bcc7c", "#95d279", "#aed778",
      "#c5dc7a", "#dbe17e", "#f0e685", "#ffeba1",
    ])),
  },
  two_sided: {
    label: "blue, pale, red",
    table: table((t) => {
      const from_middle = Math.abs(2 * t - 1);
      return oklch(0.96 - 0.5 * from_middle, 0.17 * from_middle ** 0.8 + 0.004, t < 0.5 ? 255 : 28);
    }),
  },
  grey: { label: "grey", table: table((t) => oklch(0.2 + 0.78 * t, 0, 0)) },
};

export const css_colour = (map: ColourMap, k: number): string =>
  `rgb(${map.table[4 * k]} ${map.table[4 * k + 1]} ${map.table[4 * k + 2]})`;

/** Curves of a plot: told apart by people who see colours differently (Okabe and Ito 2008), on light and dark. */
export const curves = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#7f7f7f", "#b3a100", "#004c6d",
  "#a6444f", "#4d9221", "#c77cff", "#5c5c8a"];
