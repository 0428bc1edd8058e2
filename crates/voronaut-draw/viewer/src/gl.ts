// What is drawn, by WebGL2 without a library: four programs and buffers are all that a mesh takes.

import type { Rgb } from "./colours";

/** One value missing: no colour. */
export const MISSING = -3e38;

// What a shader does not need is left out: each number that corners hand to pixels takes time for every triangle.
const FACE_VERTEX = `
layout(location=0) in vec3 place;
layout(location=1) in float value;
layout(location=2) in float marks;
uniform mat4 view;
out vec2 corner; out float v; flat out float mark;
#ifdef SURFACE
out vec3 at;
#endif
void main() {
  int k = gl_VertexID % 3;
  corner = vec2(k == 0, k == 1);
  v = value; mark = marks * 255.0;
#ifdef SURFACE
  at = place;
#endif
  gl_Position = view * vec4(place, 1.0);
}`;

const FACE_FRAGMENT = `
precision highp float;
in vec2 corner; in float v; flat in float mark;
uniform sampler2D scale;
uniform vec2 range;
uniform int mode;        // 0 plain, 1 a scale, 2 kinds, 3 a scale with lines of equal value
uniform vec3 plain, faint, ink, border;
uniform float wire, rim; // widths of edges and of borders, zero for none
uniform float gaps;      // distance of lines of equal value
#ifdef SURFACE
in vec3 at;
uniform vec4 clip;       // what is beyond this plane is not there
uniform vec3 eye;
#endif
out vec4 colour;
void main() {
  int bits = int(mark + 0.5);
  bool isChosen = bits >= 8;
#ifdef SURFACE
  if (dot(at, clip.xyz) > clip.w) discard;
#endif
  vec3 fill = plain;
  if (mode == 1 || mode == 3) {
    fill = v < -1e38 ? faint : texture(scale, vec2(clamp((v - range.x) / (range.y - range.x), 0.002, 0.998), 0.5)).rgb;
    if (mode == 3) {
      float t = v / gaps, w = fwidth(t);
      float line = abs(fract(t - 0.5) - 0.5) / max(w, 1e-6);
      fill = mix(fill, ink, 0.45 * (1.0 - smoothstep(0.3, 1.1, line)) * clamp(1.2 - 2.0 * w, 0.0, 1.0));
    }
  } else if (mode == 2) fill = texelFetch(scale, ivec2(int(mod(v + 0.5, 256.0)), 0), 0).rgb;
  if (!isChosen) fill = mix(fill, faint, 0.86);
#ifdef SURFACE
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  fill *= 0.52 + 0.36 * abs(dot(n, eye)) + 0.14 * abs(dot(n, normalize(eye + vec3(0.0, 0.0, 0.35))));
#endif
  if (wire > 0.0 || rim > 0.0) {
    vec3 bary = vec3(corner, 1.0 - corner.x - corner.y);
    vec3 w = fwidth(bary), near = bary / w;
    float edge = clamp(wire + 0.5 - min(near.x, min(near.y, near.z)), 0.0, 1.0);
    // Where triangles are as small as pixels, edges would hide everything.
    float room = clamp(1.15 - 1.6 * max(w.x, max(w.y, w.z)), 0.0, 1.0);
    if (wire > 0.0) fill = mix(fill, ink, edge * room * (isChosen ? 0.62 : 0.2));
    if (rim > 0.0 && (bits & 7) != 0) {
      vec3 far = vec3((bits & 1) != 0 ? near.x : 1e9, (bits & 2) != 0 ? near.y : 1e9, (bits & 4) != 0 ? near.z : 1e9);
      fill = mix(fill, border, 0.9 * clamp(rim + 0.5 - min(far.x, min(far.y, far.z)), 0.0, 1.0));
    }
  }
  colour = vec4(fill, 1.0);
}`;

const PICK_VERTEX = `
layout(location=0) in vec3 place;
uniform mat4 view;
out vec3 at; flat out int id;
void main() {
  id = gl_VertexID / 3; at = place;
  gl_Position = view * vec4(place, 1.0);
}`;

const PICK_FRAGMENT = `
precision highp float;
in vec3 at; flat in int id;
uniform vec4 clip;
out uint found;
void main() {
  if (dot(at, clip.xyz) > clip.w) discard;
  found = uint(id) + 1u;
}`;

const CELL_VERTEX = `
layout(location=0) in vec3 place;
layout(location=1) in vec3 forms;
layout(location=2) in vec3 hues;
uniform mat4 view;
out vec3 bary; out vec3 at; flat out vec3 form; flat out vec3 hue;
void main() {
  int k = gl_VertexID % 3;
  bary = vec3(k == 0, k == 1, k == 2);
  form = forms; hue = hues * 255.0; at = place;
  gl_Position = view * vec4(place, 1.0);
}`;

const CELL_FRAGMENT = `
precision highp float;
in vec3 bary; in vec3 at; flat in vec3 form; flat in vec3 hue;
uniform sampler2D scale;
uniform vec4 clip;
uniform vec3 eye, ink;
out vec4 colour;
vec3 filled(float kind) { return texelFetch(scale, ivec2(int(kind + 0.5), 0), 0).rgb; }
void main() {
  if (dot(at, clip.xyz) > clip.w) discard;
  vec3 part = form * bary;
  vec3 fill = filled(hue.x);
  bool isMixed = hue.x != hue.y || hue.y != hue.z;
  float gap = 1e3;
  if (min(form.x, min(form.y, form.z)) > 0.0) {
    // One cell, or three: the heaviest corner's.
    float most = max(part.x, max(part.y, part.z)), least = min(part.x, min(part.y, part.z));
    fill = filled(part.x == most ? hue.x : part.y == most ? hue.y : hue.z);
    gap = 2.0 * most + least - part.x - part.y - part.z;
  } else {
    // Two: on one side of a straight line is the corner that has a cell for itself.
    gap = part.x + part.y + part.z;
    bool first = form.x > 0.0, second = form.y > 0.0;
    if (gap > 0.0) fill = filled(first ? hue.x : second ? hue.y : hue.z);
    else fill = filled(first ? hue.y : hue.x);
  }
  float border = isMixed ? 1.0 - smoothstep(0.3, 1.3, abs(gap) / max(fwidth(gap), 1e-6)) : 0.0;
  if (eye != vec3(0.0)) {
    vec3 n = normalize(cross(dFdx(at), dFdy(at)));
    fill *= 0.58 + 0.44 * abs(dot(n, eye));
  }
  colour = vec4(mix(fill, ink, 0.6 * border), 1.0);
}`;

// Instances would be the plain way; processors draw them a hundred times more slowly than triangles that fetch their own numbers.
const FETCH = `
precision highp float;
precision highp sampler2D;
vec4 fetched(sampler2D list) { int i = gl_VertexID / 6; return texelFetch(list, ivec2(i % 2048, i / 2048), 0); }
vec2 cornered() {
  int k = gl_VertexID % 6;
  return vec2(k == 2 || k == 3 || k == 5, k == 1 || k > 3 ? 1.0 : -1.0);
}`;

const LINE_VERTEX = `
${FETCH}
uniform sampler2D first, second, third;
uniform mat4 view; uniform vec2 size; uniform float width, lift;
out vec3 at; out float across; flat out vec4 tint;
void main() {
  vec2 corner = cornered();
  vec3 from = fetched(first).xyz, to = fetched(second).xyz;
  vec4 paint = fetched(third);
  vec4 p = view * vec4(from, 1.0), q = view * vec4(to, 1.0);
  vec2 along = (q.xy - p.xy) * size;
  float len = length(along);
  vec2 dir = len > 0.0 ? along / len : vec2(1.0, 0.0);
  vec2 side = vec2(-dir.y, dir.x);
  vec4 r = corner.x < 0.5 ? p : q;
  float reach = 0.5 * width + 0.6;
  r.xy += (side * corner.y * reach + dir * (corner.x * 2.0 - 1.0) * 0.5 * width) * 2.0 / size;
  r.z -= lift;
  at = corner.x < 0.5 ? from : to;
  across = corner.y * reach; tint = paint;
  gl_Position = r;
}`;

const LINE_FRAGMENT = `
precision highp float;
in vec3 at; in float across; flat in vec4 tint;
uniform vec4 clip; uniform float width;
out vec4 colour;
void main() {
  if (dot(at, clip.xyz) > clip.w) discard;
  float a = tint.a * (1.0 - smoothstep(0.5 * width - 0.4, 0.5 * width + 0.6, abs(across)));
  if (a < 0.02) discard;
  colour = vec4(tint.rgb, a);
}`;

const BALL_VERTEX = `
${FETCH}
uniform sampler2D first, second, third;
uniform mat4 view; uniform float lift;
out vec3 at; out vec2 c;
void main() {
  vec2 corner = cornered();
  vec3 middle = fetched(first).xyz, u = fetched(second).xyz, w = fetched(third).xyz;
  c = vec2(corner.x * 2.0 - 1.0, corner.y) * 1.06;
  at = middle + c.x * u + c.y * w;
  gl_Position = view * vec4(at, 1.0);
  gl_Position.z -= lift;
}`;

const BALL_FRAGMENT = `
precision highp float;
in vec3 at; in vec2 c;
uniform vec4 clip; uniform vec3 ink;
out vec4 colour;
void main() {
  if (dot(at, clip.xyz) > clip.w) discard;
  float r = length(c), w = fwidth(r);
  float ring = 1.0 - smoothstep(0.7, 1.5, abs(r - 1.0) / max(w, 1e-6));
  float a = max(0.85 * ring, r < 1.0 ? 0.13 : 0.0);
  if (a < 0.02) discard;
  colour = vec4(ink, a);
}`;

type Setting = number | number[] | Float32Array;

class Program {
  readonly program: WebGLProgram;
  private readonly places = new Map<string, { at: WebGLUniformLocation | null; type: number }>();

  constructor(private readonly gl: WebGL2RenderingContext, vertex: string, fragment: string, define = "") {
    this.program = gl.createProgram()!;
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(type)!;
      gl.shaderSource(shader, `#version 300 es\n${define}${text}`);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? "shader");
      gl.attachShader(this.program, shader);
    }
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program) ?? "program");
    for (let i = 0; i < gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS); i++) {
      const { name, type } = gl.getActiveUniform(this.program, i)!;
      this.places.set(name, { at: gl.getUniformLocation(this.program, name), type });
    }
  }

  use(settings: Record<string, Setting>) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(settings)) {
      const place = this.places.get(name);
      if (!place) continue;
      if (typeof value === "number") place.type === gl.FLOAT ? gl.uniform1f(place.at, value) : gl.uniform1i(place.at, value);
      else if (value.length === 16) gl.uniformMatrix4fv(place.at, false, value);
      else if (value.length === 4) gl.uniform4fv(place.at, value);
      else if (value.length === 3) gl.uniform3fv(place.at, value);
      else gl.uniform2fv(place.at, value);
    }
  }
}

/** What is drawn at once. */
export interface Batch { count: number; set(at: number, size: number, data: Float32Array | Uint8Array): this; draw(): void; free(): void }

/** Triangles, with a list of numbers for each place of the shader, corner by corner. */
class Triangles implements Batch {
  private readonly array: WebGLVertexArrayObject;
  private readonly buffers = new Map<number, WebGLBuffer>();
  count = 0;

  constructor(private readonly gl: WebGL2RenderingContext) { this.array = gl.createVertexArray()!; }

  set(at: number, size: number, data: Float32Array | Uint8Array) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    let buffer = this.buffers.get(at);
    if (!buffer) this.buffers.set(at, (buffer = gl.createBuffer()!));
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(at);
    const isBytes = data instanceof Uint8Array;
    gl.vertexAttribPointer(at, size, isBytes ? gl.UNSIGNED_BYTE : gl.FLOAT, isBytes, 0, 0);
    this.count = data.length / size;
    return this;
  }

  draw() {
    this.gl.bindVertexArray(this.array);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, this.count);
  }

  free() {
    this.gl.deleteVertexArray(this.array);
    for (const buffer of this.buffers.values()) this.gl.deleteBuffer(buffer);
  }
}

const ROW = 2048;

/** Things of two triangles each, which fetch their numbers, thing by thing, from lists 1 to 3. */
class Quads implements Batch {
  private readonly lists = new Map<number, WebGLTexture>();
  count = 0;

  constructor(private readonly gl: WebGL2RenderingContext, private readonly empty: WebGLVertexArrayObject) {}

  set(at: number, size: number, data: Float32Array | Uint8Array) {
    const gl = this.gl;
    this.count = data.length / size;
    let list = this.lists.get(at);
    if (!list) this.lists.set(at, (list = gl.createTexture()!));
    gl.bindTexture(gl.TEXTURE_2D, list);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    const rows = Math.max(1, Math.ceil(this.count / ROW)), isBytes = data instanceof Uint8Array;
    const filled = isBytes ? new Uint8Array(rows * ROW * size) : new Float32Array(rows * ROW * size);
    filled.set(data);
    if (isBytes) gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, ROW, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, filled);
    else gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB32F, ROW, rows, 0, gl.RGB, gl.FLOAT, filled);
    return this;
  }

  draw() {
    const gl = this.gl;
    if (this.count === 0) return;
    for (const [at, list] of this.lists) {
      gl.activeTexture(gl.TEXTURE0 + at);
      gl.bindTexture(gl.TEXTURE_2D, list);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.count);
  }

  free() { for (const list of this.lists.values()) this.gl.deleteTexture(list); }
}

const LISTS = { first: 1, second: 2, third: 3 };

export class Painter {
  readonly gl: WebGL2RenderingContext;
  private readonly flat: Program; private readonly faces: Program; private readonly picks: Program; private readonly cells: Program;
  private readonly lines: Program; private readonly balls: Program;
  private readonly empty: WebGLVertexArrayObject;
  private readonly textures = new Map<string, WebGLTexture>();
  private readonly picked: WebGLFramebuffer;

  constructor(canvas: HTMLCanvasElement, antialias: boolean) {
    const gl = canvas.getContext("webgl2", { antialias, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("This browser has no WebGL2, which the page needs to draw.");
    this.gl = gl;
    this.flat = new Program(gl, FACE_VERTEX, FACE_FRAGMENT);
    this.faces = new Program(gl, FACE_VERTEX, FACE_FRAGMENT, "#define SURFACE\n");
    this.picks = new Program(gl, PICK_VERTEX, PICK_FRAGMENT);
    this.cells = new Program(gl, CELL_VERTEX, CELL_FRAGMENT);
    this.lines = new Program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.balls = new Program(gl, BALL_VERTEX, BALL_FRAGMENT);
    this.empty = gl.createVertexArray()!;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.picked = this.pickTarget();
  }

  triangles(): Batch { return new Triangles(this.gl); }
  quads(): Batch { return new Quads(this.gl, this.empty); }

  /** A row of 256 colours, made once. */
  texture(name: string, texels: () => Uint8Array) {
    const gl = this.gl;
    let texture = this.textures.get(name);
    if (!texture) {
      this.textures.set(name, (texture = gl.createTexture()!));
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels());
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
      for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    }
    gl.bindTexture(gl.TEXTURE_2D, texture);
  }

  /** Begins a part of the picture, in pixels from the left. */
  begin(from: number, to: number, paper: Rgb) {
    const gl = this.gl, height = gl.drawingBufferHeight;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, gl.drawingBufferWidth, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(from, 0, Math.max(to - from, 0), height);
    gl.clearColor(paper[0] / 255, paper[1] / 255, paper[2] / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.disable(gl.BLEND);
  }

  drawFaces(batch: Batch, isPlanar: boolean, settings: Record<string, Setting>) {
    (isPlanar ? this.flat : this.faces).use(settings);
    batch.draw();
  }
  drawCells(batch: Batch, settings: Record<string, Setting>) { this.cells.use(settings); batch.draw(); }
  drawLines(batch: Batch, settings: Record<string, Setting>) { this.over(() => { this.lines.use({ ...settings, ...LISTS }); batch.draw(); }); }
  drawBalls(batch: Batch, settings: Record<string, Setting>) { this.over(() => { this.balls.use({ ...settings, ...LISTS }); batch.draw(); }); }

  /** Over what is there, without hiding what comes. */
  private over(draw: () => void) {
    const gl = this.gl;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    draw();
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  private pickTarget() {
    const gl = this.gl, target = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    for (const [attachment, format] of [[gl.COLOR_ATTACHMENT0, gl.R32UI], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]] as const) {
      const buffer = gl.createRenderbuffer()!;
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return target;
  }

  /** The triangle in front at the pixel that the view is narrowed to, or -1. */
  pick(batch: Batch, view: Float32Array, clip: number[]): number {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.picked);
    gl.viewport(0, 0, 1, 1);
    gl.disable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.clearBufferuiv(gl.COLOR, 0, new Uint32Array(4));
    gl.clearBufferfv(gl.DEPTH, 0, new Float32Array([1]));
    this.picks.use({ view, clip });
    batch.draw();
    const found = new Uint32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return found[0] - 1;
  }
}
