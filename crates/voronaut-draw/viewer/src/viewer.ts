// What is seen: which meshes, how coloured, from where; and the picture of it.

import { Camera } from "./camera";
import { CAUSE_HUES, CELL_HUES, KINDS, Rgb, kindTexels, rgb, texels } from "./colours";
import { type Batch, Painter } from "./gl";
import { spreadOf } from "./histogram";
import type { Field, Mesh } from "./model";
import { Scene, Tone, World } from "./scene";
import type { Hit } from "./text";

export const CELLS = "Voronoi cells", DISTANCES = "distance in the metric", NOTHING = "nothing";
/** More border edges than this are drawn within their triangles, which is faster; where those are thin they look dotted. */
const MOST_LINES = 30000;

/** Least and greatest coordinates. */
export type Box = [number[], number[]];
export type Layer = "edges" | "borders" | "ellipses" | "geodesics" | "lines";

const LIGHT = { paper: "f7f8fa", plain: "e3e9f1", faint: "e9ecf1", ink: "16233c", border: "16233c", ball: "b3261e", curve: "a3123a", mark: "e0004d" };
const DARK = { paper: "12161e", plain: "2c3644", faint: "1c222c", ink: "05080d", border: "dfe6f0", ball: "ff9d8a", curve: "ffd479", mark: "ff4f8b" };
type Inks = Record<keyof typeof LIGHT, Rgb>;

/** How long frames take, for tests and for the curious. */
export interface Course { frames: number; frameMs: number; loadMs: number }

export class Viewer {
  readonly painter: Painter;
  camera!: Camera;
  world!: World;
  readonly course: Course = { frames: 0, frameMs: 0, loadMs: 0 };
  private readonly scenes = new Map<number, Scene>();
  private readonly tones = new Map<Field, Tone>();
  private marks: Batch | null = null;
  private isDue = false;
  current = 0;
  other: number | null = null;
  split = 0.5;
  colourBy = "quality";
  layers: Record<Layer, boolean> = { edges: true, borders: true, ellipses: false, geodesics: false, lines: false };
  clip = { axis: -1, share: 0.5, isFlipped: false };
  picked: Hit | null = null;
  isDark = false;
  margin = { left: 0, right: 0, top: 0, bottom: 0 };

  constructor(readonly canvas: HTMLCanvasElement, public meshes: Mesh[]) {
    const triangles = meshes.reduce((sum, mesh) => sum + mesh.triangles, 0);
    // Smooth outlines cost a third of the time where processors draw.
    this.painter = new Painter(canvas, triangles <= 20000);
    this.frame(bounds(meshes));
  }
  half!: [number, number, number];
  /** Told of every picture that is drawn. */
  drawn: () => void = () => {};

  /** What is seen lies in this box, from now on. */
  private frame(box: Box) {
    const [low, high] = (this.box = box);
    const middle = low.map((x, k) => (x + high[k]) / 2);
    const size = Math.max(...low.map((x, k) => high[k] - x)) / 2 || 1;
    this.world = { middle, size };
    this.half = low.map((x, k) => (high[k] - x) / 2 / size) as [number, number, number];
    const { width, height } = this.camera ?? { width: 1, height: 1 };
    this.camera = new Camera(this.meshes.every((mesh) => mesh.isPlanar), [0, 0, 0], this.half);
    [this.camera.width, this.camera.height] = [width, height];
    if (width > 1) this.camera.fit(this.margin);
  }
  private box!: Box;

  /** Shows other meshes; in the same box from the same side as before. */
  renew(meshes: Mesh[], box: Box = bounds(meshes)) {
    for (const scene of this.scenes.values()) scene.free();
    this.scenes.clear();
    this.tones.clear();
    this.pick(null);
    [this.meshes, this.current, this.other] = [meshes, 0, null];
    const isSame = this.camera.isPlanar === meshes.every((mesh) => mesh.isPlanar) && box.flat().every((x, i) => x === this.box.flat()[i]);
    if (!isSame) this.frame(box);
    this.redraw();
  }

  get mesh() { return this.meshes[this.current]; }
  get scene() { return this.sceneOf(this.current); }
  get inks(): Inks {
    return Object.fromEntries(Object.entries(this.isDark ? DARK : LIGHT).map(([name, hex]) => [name, rgb(hex)])) as Inks;
  }

  sceneOf(i: number): Scene {
    let scene = this.scenes.get(i);
    if (!scene) this.scenes.set(i, (scene = new Scene(this.painter, this.meshes[i], this.world)));
    return scene;
  }

  /** The field that colours a mesh, if it has it. */
  fieldOf(mesh: Mesh): Field | null { return mesh.field(this.colourBy) ?? null; }

  /** How a field is coloured, the same for all meshes that have it. */
  tone(field: Field): Tone {
    let tone = this.tones.get(field);
    if (!tone) {
      const all = this.meshes.flatMap((mesh) => mesh.fields.filter((it) => it.name === field.name && it.on === field.on));
      tone = toneOf(field, all, this.mesh.hasMetric);
      for (const it of all) this.tones.set(it, tone);
    }
    return tone;
  }

  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (this.canvas.width !== Math.round(w * ratio) || this.canvas.height !== Math.round(h * ratio)) {
      this.canvas.width = Math.round(w * ratio);
      this.canvas.height = Math.round(h * ratio);
    }
    const isFirst = this.camera.width <= 1;
    [this.camera.width, this.camera.height] = [w, h];
    if (isFirst) this.camera.fit(this.margin);
    this.redraw();
  }

  redraw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => { this.isDue = false; this.draw(); });
  }

  /** Draws now. */
  draw() {
    const start = performance.now(), { gl } = this.painter, width = gl.drawingBufferWidth;
    const cut = this.other === null ? width : Math.round(this.split * width);
    this.part(this.current, 0, cut);
    if (this.other !== null) this.part(this.other, cut, width);
    this.drawn();
    this.course.frames++;
    this.course.frameMs = performance.now() - start;
  }

  /** So many frames in turn, each waited for: milliseconds for one, and of the processor's own work in it. */
  measure(frames: number) {
    const { gl } = this.painter, pixel = new Uint8Array(4);
    let own = 0;
    const start = performance.now();
    for (let i = 0; i < frames; i++) {
      this.camera.isPlanar ? this.camera.pan(1, 0) : this.camera.turn(0.02, 0.005);
      this.draw();
      own += this.course.frameMs;
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    }
    return { frame: (performance.now() - start) / frames, own: own / frames };
  }

  /** The plane beyond which nothing is, as its normal and how far along it lies. */
  plane(): number[] {
    const { axis, share, isFlipped } = this.clip;
    if (axis < 0) return [0, 0, 0, 1];
    const normal = axis === 3 ? [...this.camera.rows[2]] : [0, 1, 2].map((k) => (k === axis ? 1 : 0));
    const reach = normal.reduce((sum, x, k) => sum + Math.abs(x) * this.half[k], 0) * 1.001;
    const at = (2 * share - 1) * reach;
    return isFlipped ? [...normal.map((x) => -x), -at] : [...normal, at];
  }

  private part(i: number, from: number, to: number) {
    const { painter, camera, inks } = this, scene = this.sceneOf(i), { mesh } = scene;
    painter.begin(from, to, inks.paper);
    const unit = (c: Rgb) => c.map((x) => x / 255);
    const ratio = this.canvas.width / Math.max(camera.width, 1);
    const size = [this.canvas.width, this.canvas.height];
    const eye = mesh.isPlanar ? [0, 0, 0] : camera.rows[2];
    const common = { view: camera.matrix(), clip: this.plane(), eye, plain: unit(inks.plain), faint: unit(inks.faint), ink: unit(inks.ink), border: unit(inks.border), scale: 0 };
    const wire = this.layers.edges ? 0.45 * ratio : 0, areLines = this.isOfCanvas(mesh) || scene.borderCount <= MOST_LINES;
    const rim = this.layers.borders && !areLines ? 1.1 * ratio : 0;
    const thick = (pixels: number, lift: number) => ({ ...common, size, width: pixels * ratio, lift });
    this.fill(scene, { ...common, wire, rim });
    if (this.layers.edges && this.isOfCanvas(mesh)) painter.drawLines(scene.allEdges(inks.ink), thick(0.9, 0.002));
    const field = this.fieldOf(mesh);
    const shown = field?.on === "edge" ? field : this.areEdgesChosen(scene) ? mesh.field("length")! : null;
    if (shown) painter.drawLines(scene.edges(shown, this.tone(shown)), thick(mesh.triangles > 30000 ? 1.4 : 2, 0.002));
    if (this.layers.borders && areLines) painter.drawLines(scene.borderLines(inks.border), thick(1.5, 0.0025));
    if (this.layers.geodesics && mesh.curves.length > 0) painter.drawLines(scene.curves(inks.curve), thick(1.2, 0.004));
    if (this.layers.ellipses) painter.drawBalls(scene.balls(), { ...common, ink: unit(inks.ball), lift: 0.003 });
    if (this.picked && i === this.current) this.mark(thick(2.6, 0.006));
  }

  isOfCanvas(mesh: Mesh) { return !!mesh.cells && (this.colourBy === CELLS || this.colourBy === DISTANCES); }

  /** Whether a part of the edges is selected. */
  areEdgesChosen(scene: Scene) { return scene.chosenEdges.includes(0); }

  private fill(scene: Scene, common: Record<string, number | number[] | Float32Array>) {
    const { painter } = this, { mesh } = scene;
    if (this.colourBy === CELLS && mesh.cells) {
      painter.texture("cells", () => kindTexels(CELL_HUES));
      painter.drawCells(scene.cells()!, common);
      return;
    }
    if (this.colourBy === DISTANCES && mesh.cells) {
      painter.texture("sequential", () => texels("sequential"));
      const { high } = this.distanceTone();
      painter.drawFaces(scene.distances()!, mesh.isPlanar, { ...common, wire: 0, rim: 0, mode: 3, range: [0, high], gaps: high / 8 });
      return;
    }
    const field = this.fieldOf(mesh), isFilled = field !== null && field.on !== "edge";
    const tone = field ? this.tone(field) : null;
    scene.show(isFilled ? field : null, tone?.isLog ?? false);
    const mode = !isFilled ? 0 : field.kinds ? 2 : this.layers.lines && field.on === "vertex" ? 3 : 1;
    if (mode === 2) painter.texture("kinds", () => kindTexels(KINDS.slice(0, 8)));
    else painter.texture(tone?.scale ?? "sequential", () => texels(tone?.scale ?? "sequential"));
    const [low, high] = tone ? [tone.low, tone.high] : [0, 1];
    painter.drawFaces(scene.faces, mesh.isPlanar, { ...common, mode, range: [low, high], gaps: (high - low) / 12 });
  }

  /** Up to which distance the scale goes. */
  distanceTone(): Tone {
    const cells = this.meshes.map((mesh) => mesh.cells).find((it) => it !== null);
    return { low: 0, high: cells ? spreadOf(cells.distances, false).high : 1, scale: "sequential", isLog: false };
  }

  pick(hit: Hit | null) {
    this.picked = hit;
    this.marks?.free();
    this.marks = null;
    this.redraw();
  }

  private mark(settings: Record<string, number | number[] | Float32Array>) {
    const { mesh } = this, { kind, index } = this.picked!, at = (v: number) => this.scene.place(mesh.positions, v);
    if (kind === "vertex") {
      // A ring that keeps its size.
      const c = at(index), r = 7 / this.camera.scale, [right, up] = this.camera.rows;
      const point = (i: number) => c.map((x, k) => x + r * (Math.cos((i * Math.PI) / 12) * right[k] + Math.sin((i * Math.PI) / 12) * up[k]));
      this.marks?.free();
      this.marks = this.scene.marks(Array.from({ length: 24 }, (_, i) => [point(i), point(i + 1)]), this.inks.mark);
    } else if (!this.marks) {
      const ends = kind === "edge" ? [[0, 1]] : [[0, 1], [1, 2], [2, 0]];
      const list = kind === "edge" ? mesh.edges.subarray(2 * index, 2 * index + 2) : mesh.corners.subarray(3 * index, 3 * index + 3);
      this.marks = this.scene.marks(ends.map(([a, b]) => [at(list[a]), at(list[b])]), this.inks.mark);
    }
    this.painter.drawLines(this.marks!, settings);
  }

  /** The triangle in front at a pixel, or -1. */
  triangleAt(x: number, y: number, i = this.current): number {
    const { mesh, faces } = this.sceneOf(i);
    const t = this.painter.pick(faces, this.camera.matrix([x, y], 1 / Math.min(window.devicePixelRatio || 1, 2)), this.plane());
    return t < mesh.triangles ? t : -1;
  }

  /** What is at a pixel: the vertex or the edge that is near, or the triangle. */
  at(x: number, y: number): { mesh: number; hit: Hit } | null {
    const i = this.other !== null && x > this.split * this.camera.width ? this.other : this.current;
    const { mesh } = this.sceneOf(i), t = this.triangleAt(x, y, i);
    if (t < 0) return null;
    const corners = [0, 1, 2].map((k) => mesh.corners[3 * t + k]);
    const pixels = corners.map((v) => this.camera.project(this.sceneOf(i).place(mesh.positions, v)));
    const away = pixels.map(([px, py]) => Math.hypot(px - x, py - y));
    const nearest = away.indexOf(Math.min(...away));
    // Where triangles are small nothing but the nearest would ever be found.
    const room = Math.max(...pixels.map((p, k) => Math.hypot(p[0] - pixels[(k + 1) % 3][0], p[1] - pixels[(k + 1) % 3][1])));
    if (away[nearest] < Math.min(9, 0.25 * room)) return { mesh: i, hit: { kind: "vertex", index: corners[nearest] } };
    // Nor would thin triangles beside their edges.
    const height = doubleArea(pixels) / room;
    const off = pixels.map((p, k) => fromSegment([x, y], p, pixels[(k + 1) % 3]));
    const edge = off.indexOf(Math.min(...off));
    if (off[edge] < Math.min(5, 0.25 * height)) return { mesh: i, hit: { kind: "edge", index: mesh.edgesOf[3 * t + edge] } };
    return { mesh: i, hit: { kind: "triangle", index: t } };
  }

  /** Brings an element to the middle, as large as a tenth of the picture. */
  show(hit: Hit) {
    const { mesh } = this, { kind, index } = hit;
    const list = kind === "vertex" ? around(mesh, index)
      : kind === "edge" ? [...mesh.edges.subarray(2 * index, 2 * index + 2)] : [...mesh.corners.subarray(3 * index, 3 * index + 3)];
    const places = list.map((v) => this.scene.place(mesh.positions, v));
    const middle = [0, 1, 2].map((k) => places.reduce((sum, p) => sum + p[k], 0) / places.length) as [number, number, number];
    const reach = Math.max(...places.map((p) => Math.hypot(...p.map((x, k) => x - middle[k])))) || 0.01;
    if (!mesh.isPlanar) this.face(list);
    this.camera.look(kind === "vertex" ? places[0] : middle, (0.12 * Math.min(this.camera.width, this.camera.height)) / reach);
    this.camera.pan((this.margin.left - this.margin.right) / 2, 0);
    this.pick(hit);
  }

  /** Turns the side of a surface where some vertices are to the eye. */
  private face(vertices: number[]) {
    const { mesh } = this, set = new Set(vertices), normal = [0, 0, 0];
    for (let t = 0; t < mesh.triangles; t++) {
      const c = [0, 1, 2].map((k) => mesh.corners[3 * t + k]);
      if (!c.some((v) => set.has(v))) continue;
      const [p, q, r] = c.map((v) => mesh.at(v));
      const [u, w] = [q.map((x, i) => x - p[i]), r.map((x, i) => x - p[i])];
      [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]].forEach((x, k) => { normal[k] += x; });
    }
    const length = Math.hypot(...normal);
    if (!(length > 0)) return;
    const eye = normal.map((x) => x / length) as [number, number, number];
    const other = Math.abs(eye[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0];
    const dot = eye[0] * other[0] + eye[1] * other[1] + eye[2] * other[2];
    const raw = other.map((x, k) => x - dot * eye[k]), size = Math.hypot(...raw);
    const up = raw.map((x) => x / size) as [number, number, number];
    const right: [number, number, number] = [up[1] * eye[2] - up[2] * eye[1], up[2] * eye[0] - up[0] * eye[2], up[0] * eye[1] - up[1] * eye[0]];
    this.camera.rows = [right, up, eye];
  }
}

function around(mesh: Mesh, v: number): number[] {
  const found = [v];
  for (let e = 0; e < mesh.sides.length; e++) {
    const [a, b] = [mesh.edges[2 * e], mesh.edges[2 * e + 1]];
    if (a === v) found.push(b);
    else if (b === v) found.push(a);
  }
  return found;
}

function toneOf(field: Field, all: Field[], hasMetric: boolean): Tone {
  if (field.isOurs && field.name === "quality") return { low: 0, high: 1, scale: "sequential", isLog: false };
  if (field.isOurs && field.name === "smallest angle") return { low: 0, high: 60, scale: "sequential", isLog: false };
  // Two thirds of the way to the ends is where edges stop being unit edges, and worse.
  if (field.name === "length" && field.on === "edge" && hasMetric) return { low: -1.04, high: 1.04, scale: "diverging", isLog: true };
  const spreads = all.map((it) => spreadOf(it.values, false));
  const [low, high] = [Math.min(...spreads.map((it) => it.low)), Math.max(...spreads.map((it) => it.high))];
  const isLog = low > 0 && high > 200 * low;
  return { low: isLog ? Math.log(low) : low, high: isLog ? Math.log(high) : high, scale: "sequential", isLog };
}

/** The box that holds all vertices. */
export function bounds(meshes: Mesh[]): Box {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const { positions } of meshes) {
    for (let i = 0; i < positions.length; i++) {
      const k = i % 3;
      if (positions[i] < low[k]) low[k] = positions[i];
      if (positions[i] > high[k]) high[k] = positions[i];
    }
  }
  return [low, high];
}

function doubleArea([p, q, r]: number[][]) {
  return Math.abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
}

function fromSegment([x, y]: [number, number], p: number[], q: number[]) {
  const [dx, dy] = [q[0] - p[0], q[1] - p[1]], square = dx * dx + dy * dy;
  const t = square > 0 ? Math.min(Math.max(((x - p[0]) * dx + (y - p[1]) * dy) / square, 0), 1) : 0;
  return Math.hypot(p[0] + t * dx - x, p[1] + t * dy - y);
}

export { CAUSE_HUES };
