// Draws the bodies with WebGL. Corners, places and values lie in textures that the shaders read by number: a new frame is
// an upload of two arrays, whatever is drawn from them.
import * as twgl from "twgl.js";
import type { ColourMap } from "./colours.ts";

const texture_width = 2048;
/** Stands for "no number" on the way to the shader, where NaN cannot be relied on. */
const nothing = 3e38;

const common = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform vec2 centre;   // of the view, m
uniform vec2 to_clip;  // clip coordinates per m
ivec2 at(int k) { return ivec2(k & ${texture_width - 1}, k / ${texture_width}); }
`;

const fill_vertex = `${common}
uniform usampler2D corners;
uniform sampler2D places;
uniform sampler2D values;
uniform int elements;
uniform bool by_node;
flat out float value_of_element;
out float value_of_node;
out vec3 weight;  // of the corners
void main() {
  int element = gl_VertexID / 3;
  int corner = gl_VertexID % 3;
  int node = int(texelFetch(corners, at(corner * elements + element), 0).r);
  value_of_element = by_node ? 0.0 : texelFetch(values, at(element), 0).r;
  value_of_node = by_node ? texelFetch(values, at(node), 0).r : 0.0;
  weight = vec3(corner == 0, corner == 1, corner == 2);
  gl_Position = vec4((texelFetch(places, at(node), 0).rg - centre) * to_clip, 0, 1);
}`;

const fill_fragment = `${common}
uniform sampler2D colours;
uniform bool by_node;
uniform bool is_flag;
uniform vec2 range;
uniform vec4 none;
uniform vec4 plain;
uniform vec4 flowed;
uniform vec4 flagged;
uniform float line;  // opacity of the mesh; 0 where elements are too small
flat in float value_of_element;
in float value_of_node;
in vec3 weight;
out vec4 colour;
void main() {
  float value = by_node ? value_of_node : value_of_element;
  if (value > 1e38) {
    colour = none;
  } else if (is_flag) {
    colour = value > 0.75 ? flagged : value > 0.25 ? flowed : plain;
  } else {
    float part = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
    colour = texture(colours, vec2((part * 255.0 + 0.5) / 256.0, 0.5));
  }
  vec3 px = weight / fwidth(weight);
  float near = 1.0 - smoothstep(0.3, 0.9, min(px.x, min(px.y, px.z)));
  // Dark lines on light elements, light ones on dark elements.
  float lightness = dot(colour.rgb, vec3(0.3, 0.6, 0.1));
  vec3 ink = lightness < 0.35 ? vec3(0.75) : vec3(0.1);
  colour.rgb = mix(colour.rgb, ink, near * line);
}`;

// Lines as narrow rectangles: WebGL's own are one px wide everywhere.
const edge_vertex = `${common}
uniform usampler2D ends;
uniform sampler2D places;
uniform vec2 px_per_clip;
uniform float half_width;  // px
void main() {
  int edge = gl_VertexID / 6;
  int corner = gl_VertexID % 6;
  vec2 p[2];
  for (int k = 0; k < 2; ++k) {
    int node = int(texelFetch(ends, at(2 * edge + k), 0).r);
    p[k] = (texelFetch(places, at(node), 0).rg - centre) * to_clip;
  }
  vec2 along = normalize((p[1] - p[0]) * px_per_clip + vec2(1e-9, 0));
  float side = (corner == 0 || corner == 2 || corner == 5) ? -1.0 : 1.0;
  bool first = corner == 0 || corner == 1 || corner == 3;
  vec2 beyond = (first ? -along : along) * 0.5 * half_width;
  vec2 aside = vec2(-along.y, along.x) * side * half_width;
  gl_Position = vec4((first ? p[0] : p[1]) + (aside + beyond) / px_per_clip, 0, 1);
}`;

const edge_fragment = `${common}
uniform vec4 line;
out vec4 colour;
void main() { colour = vec4(line.rgb * line.a, line.a); }`;

/** Numbers in a texture. */
class Data {
  readonly texture: WebGLTexture;
  #rows = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly kind: "R32UI" | "R32F" | "RG32F",
  ) {
    this.texture = gl.createTexture()!;
  }

  set(values: Uint32Array | Float32Array): void {
    const { gl } = this;
    const parts = this.kind === "RG32F" ? 2 : 1;
    const [format, type] = {
      R32UI: [gl.RED_INTEGER, gl.UNSIGNED_INT],
      R32F: [gl.RED, gl.FLOAT],
      RG32F: [gl.RG, gl.FLOAT],
    }[this.kind];
    const count = values.length / parts;
    const rows = Math.max(1, Math.ceil(count / texture_width));
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    if (rows !== this.#rows) {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl[this.kind], texture_width, rows, 0, format, type, null);
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
        gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
      }
      this.#rows = rows;
    }
    const whole = Math.floor(count / texture_width);
    const rest = count - whole * texture_width;
    const put = (row: number, width: number, height: number, first: number): void => {
      if (width * height > 0) {
        const part = values.subarray(first * parts, (first + width * height) * parts);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, width, height, format, type, part);
      }
    };
    put(0, texture_width, whole, 0);
    put(whole, rest, 1, whole * texture_width);
  }
}

export type Colour = [number, number, number, number]; // 0 to 1

/** How the bodies look. */
export interface Look {
  map: ColourMap;
  low: number;
  high: number;
  is_flag: boolean;
  mesh: number; // opacity of its lines
  none: Colour;
  plain: Colour;
  flowed: Colour;
  flagged: Colour;
  outline: Colour | null;
  ghost: Colour | null;
}

/** A part of the plane as px: `centre` in m against the origin of the frames, `scale` in px per m. */
export interface Window {
  centre: [number, number];
  scale: number;
  width: number;
  height: number;
  ratio: number; // px of the picture for one of the page
}

export class Scene {
  readonly #gl: WebGL2RenderingContext;
  readonly #fill: twgl.ProgramInfo;
  readonly #edge: twgl.ProgramInfo;
  readonly #corners: Data;
  readonly #ends: Data;
  readonly #places: Data;
  readonly #first: Data; // places in the first frame
  readonly #values: Data;
  readonly #colours: WebGLTexture;
  #elements = 0;
  #edges = 0;
  #by_node = false;
  #map: ColourMap | null = null;

  /** Throws where the browser has no WebGL 2. */
  constructor(canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    if (!gl) throw new Error("this browser has no WebGL 2, which draws the bodies; everything else is shown");
    this.#gl = gl;
    this.#fill = twgl.createProgramInfo(gl, [fill_vertex, fill_fragment]);
    this.#edge = twgl.createProgramInfo(gl, [edge_vertex, edge_fragment]);
    [this.#corners, this.#ends] = [new Data(gl, "R32UI"), new Data(gl, "R32UI")];
    [this.#places, this.#first, this.#values] = [new Data(gl, "RG32F"), new Data(gl, "RG32F"), new Data(gl, "R32F")];
    this.#colours = gl.createTexture()!;
    gl.bindVertexArray(gl.createVertexArray());
  }

  /** `corners`: three rows of nodes. */
  set_mesh(corners: Uint32Array, elements: number): void {
    this.#corners.set(corners);
    this.#elements = elements;
  }

  /** `ends`: two nodes for each edge of the outline. */
  set_outline(ends: Uint32Array): void {
    this.#ends.set(ends);
    this.#edges = ends.length / 2;
  }

  set_places(places: Float32Array): void {
    this.#places.set(places);
  }

  set_first_places(places: Float32Array): void {
    this.#first.set(places);
  }

  /** A number for each element, or for each node. */
  set_values(values: Float32Array, by_node: boolean): void {
    this.#values.set(values.map((value) => (value === value ? value : nothing)));
    this.#by_node = by_node;
  }

  #use_map(map: ColourMap): void {
    if (map === this.#map) return;
    this.#map = map;
    const gl = this.#gl;
    gl.bindTexture(gl.TEXTURE_2D, this.#colours);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, map.table);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    }
  }

  draw(window: Window, look: Look): void {
    const gl = this.#gl;
    gl.viewport(0, 0, window.width, window.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    if (this.#elements === 0) return;
    const view = {
      centre: window.centre,
      to_clip: [(2 * window.scale) / window.width, (2 * window.scale) / window.height],
    };
    this.#use_map(look.map);
    gl.disable(gl.BLEND);
    gl.useProgram(this.#fill.program);
    twgl.setUniforms(this.#fill, {
      ...view,
      corners: this.#corners.texture,
      places: this.#places.texture,
      values: this.#values.texture,
      colours: this.#colours,
      elements: this.#elements,
      by_node: this.#by_node,
      is_flag: look.is_flag,
      range: [look.low, look.high],
      none: look.none,
      plain: look.plain,
      flowed: look.flowed,
      flagged: look.flagged,
      line: look.mesh,
    });
    gl.drawArrays(gl.TRIANGLES, 0, 3 * this.#elements);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (look.ghost) this.#draw_edges(view, window, this.#first, look.ghost, 0.6);
    if (look.outline) this.#draw_edges(view, window, this.#places, look.outline, 0.75);
  }

  #draw_edges(view: object, window: Window, places: Data, line: Colour, half_width: number): void {
    const gl = this.#gl;
    if (this.#edges === 0) return;
    gl.useProgram(this.#edge.program);
    twgl.setUniforms(this.#edge, {
      ...view,
      ends: this.#ends.texture,
      places: places.texture,
      px_per_clip: [window.width / 2, window.height / 2],
      half_width: half_width * window.ratio,
      line,
    });
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.#edges);
  }
}
