// A mesh on the graphics card: its faces, edges, cells, ellipses and curves, made when they are first shown.

import { type Batch, MISSING, type Painter } from "./gl";
import { CAUSE_HUES, KINDS, Rgb, Scale, colour } from "./colours";
import { key, type Cells, type Field, type Mesh } from "./model";

/** How a field is coloured: between which values, on which scale, whether by logarithm. */
export interface Tone { low: number; high: number; scale: Scale; isLog: boolean }
/** From the coordinates of meshes to those that are drawn. */
export interface World { middle: number[]; size: number }

export class Scene {
  readonly faces: Batch;
  private readonly painter: Painter;
  private shown = "";
  private cellBatch: Batch | null = null;
  private canvasBatch: Batch | null = null;
  private borderBatch: Batch | null = null;
  private ballBatch: Batch | null = null;
  private curveBatch: Batch | null = null;
  private edgeBatch: Batch | null = null;
  private everyEdge: Batch | null = null;
  private edgesShown = "";
  /** What is selected: 1, or 0 where it is not. */
  chosenTriangles: Uint8Array;
  chosenEdges: Uint8Array;

  constructor(painter: Painter, readonly mesh: Mesh, readonly world: World) {
    this.painter = painter;
    this.chosenTriangles = new Uint8Array(mesh.triangles).fill(1);
    this.chosenEdges = new Uint8Array(mesh.sides.length).fill(1);
    this.faces = painter.triangles().set(0, 3, this.expanded(mesh.corners, mesh.positions));
    this.show(null, false);
    this.choose();
  }

  /** Takes everything off the graphics card. */
  free() {
    const all = [this.faces, this.cellBatch, this.canvasBatch, this.borderBatch, this.ballBatch, this.curveBatch, this.edgeBatch, this.everyEdge];
    for (const batch of all) batch?.free();
  }

  /** A point as it is drawn. */
  place(positions: ArrayLike<number>, v: number): [number, number, number] {
    const { middle, size } = this.world;
    return [0, 1, 2].map((k) => (positions[3 * v + k] - middle[k]) / size) as [number, number, number];
  }

  private expanded(corners: Uint32Array, positions: Float64Array) {
    const found = new Float32Array(3 * corners.length), { middle, size } = this.world;
    for (let i = 0, at = 0; i < corners.length; i++) {
      const p = 3 * corners[i];
      for (let k = 0; k < 3; k++) found[at++] = (positions[p + k] - middle[k]) / size;
    }
    return found;
  }

  /** The values by which faces are coloured, by their logarithms if the scale is of those. */
  show(field: Field | null, isLog: boolean) {
    const name = `${field?.name} ${field?.on} ${isLog}`;
    if (name === this.shown) return;
    this.shown = name;
    const { corners } = this.mesh, values = new Float32Array(corners.length);
    if (field && field.on !== "edge") {
      for (let i = 0; i < corners.length; i++) {
        const x = field.values[field.on === "vertex" ? corners[i] : Math.floor(i / 3)];
        const y = isLog ? Math.log(x) : x;
        values[i] = Number.isFinite(y) ? y : MISSING;
      }
    }
    this.faces.set(1, 1, values);
  }

  /** Sends what is selected to the graphics card, with a mark for each edge of a triangle that is a border. */
  choose() {
    const { mesh } = this, marks = new Uint8Array(3 * mesh.triangles);
    this.borders ??= bordersOf(mesh);
    for (let t = 0, i = 0; t < mesh.triangles; t++) {
      // An edge is marked by the corner that is opposite to it.
      const mark = (this.chosenTriangles[t] ? 8 : 0) + this.borders[mesh.edgesOf[i + 1]] + 2 * this.borders[mesh.edgesOf[i + 2]] + 4 * this.borders[mesh.edgesOf[i]];
      marks[i++] = marks[i++] = marks[i++] = mark;
    }
    this.faces.set(2, 1, marks);
    this.edgesShown = "";
  }
  /** For each edge 1 where it is a border or has a label. */
  private borders: Uint8Array | null = null;
  get borderCount() { return (this.count ??= this.borders!.reduce((sum, is) => sum + is, 0)); }
  private count: number | null = null;

  /** All edges by a field's values, or those that are selected alone. */
  edges(field: Field, tone: Tone): Batch {
    const name = `${field.name} ${tone.low} ${tone.high} ${tone.scale}`;
    if (this.edgeBatch && name === this.edgesShown) return this.edgeBatch;
    this.edgesShown = name;
    const { edges, sides } = this.mesh, count = sides.length, paint = new Uint8Array(4 * count);
    for (let e = 0; e < count; e++) {
      const alpha = !this.chosenEdges[e] ? 10 : field.name === "cause" && field.values[e] === 0 ? 70 : 255;
      paint.set([...hueOf(field, tone, field.values[e]), alpha], 4 * e);
    }
    const batch = this.edgeBatch ?? this.lines(count, (e) => [edges[2 * e], edges[2 * e + 1]]);
    this.edgeBatch = batch.set(3, 4, paint);
    return batch;
  }

  private lines(count: number, ends: (i: number) => [number, number]): Batch {
    const [from, to] = [new Float32Array(3 * count), new Float32Array(3 * count)];
    for (let i = 0; i < count; i++) {
      const [a, b] = ends(i);
      from.set(this.place(this.mesh.positions, a), 3 * i);
      to.set(this.place(this.mesh.positions, b), 3 * i);
    }
    return this.painter.quads().set(1, 3, from).set(2, 3, to);
  }

  /** Borders and labelled edges. */
  borderLines(ink: Rgb): Batch {
    if (!this.borderBatch) {
      const { edges } = this.mesh, list: number[] = [];
      this.borders!.forEach((is, e) => { if (is) list.push(e); });
      this.borderBatch = this.lines(list.length, (i) => [edges[2 * list[i]], edges[2 * list[i] + 1]]);
    }
    return tint(this.borderBatch, ink, 230);
  }

  /** All edges in one colour. */
  allEdges(ink: Rgb): Batch {
    const { edges, sides } = this.mesh;
    this.everyEdge ??= this.lines(sides.length, (e) => [edges[2 * e], edges[2 * e + 1]]);
    return tint(this.everyEdge, ink, 120);
  }

  curves(ink: Rgb): Batch {
    if (!this.curveBatch) {
      const [from, to]: [number[], number[]] = [[], []];
      for (const curve of this.mesh.curves) {
        for (let i = 1; i < curve.length / 3; i++) {
          from.push(...this.place(curve, i - 1));
          to.push(...this.place(curve, i));
        }
      }
      this.curveBatch = this.painter.quads().set(1, 3, new Float32Array(from)).set(2, 3, new Float32Array(to));
    }
    return tint(this.curveBatch, ink, 255);
  }

  /** Cells of the canvas. */
  cells(): Batch | null {
    const { cells } = this.mesh;
    if (!cells || this.cellBatch) return this.cellBatch;
    const count = cells.corners.length, forms = new Float32Array(3 * count), hues = new Uint8Array(3 * count);
    const step = stepOf(cells);
    for (let i = 0; i < count; i += 3) {
      const corners = [0, 1, 2].map((k) => cells.corners[i + k]);
      const form = formOf(corners.map((v) => cells.cells[v]), corners.map((v) => cells.distances[v]), step);
      const hue = corners.map((v) => cells.hues[v]);
      for (let k = 0; k < 3; k++) {
        forms.set(form, 3 * (i + k));
        hues.set(hue, 3 * (i + k));
      }
    }
    return (this.cellBatch = this.canvasPlaces().set(1, 3, forms).set(2, 3, hues));
  }

  /** Distances on the canvas. */
  distances(): Batch | null {
    const { cells } = this.mesh;
    if (!cells || this.canvasBatch) return this.canvasBatch;
    const values = Float32Array.from(cells.corners, (v) => (Number.isFinite(cells.distances[v]) ? cells.distances[v] : MISSING));
    return (this.canvasBatch = this.canvasPlaces().set(1, 1, values).set(2, 1, new Uint8Array(values.length).fill(8)));
  }

  private canvasPlaces() {
    const cells = this.mesh.cells!;
    return this.painter.triangles().set(0, 3, this.expanded(cells.corners, cells.positions));
  }

  /** Around each vertex what is no farther than one half in its metric, in the tangent plane. */
  balls(): Batch {
    if (this.ballBatch) return this.ballBatch;
    const { mesh } = this;
    const [middles, us, ws]: [number[], number[], number[]] = [[], [], []];
    for (let v = 0; v < mesh.vertices; v++) {
      const axes = ball(mesh, v);
      if (!axes) continue;
      middles.push(...this.place(mesh.positions, v));
      us.push(...axes[0].map((x) => x / this.world.size));
      ws.push(...axes[1].map((x) => x / this.world.size));
    }
    const [middle, u, w] = [middles, us, ws].map((list) => new Float32Array(list));
    return (this.ballBatch = this.painter.quads().set(1, 3, middle).set(2, 3, u).set(3, 3, w));
  }

  /** A few segments, for what is picked. */
  marks(segments: [number[], number[]][], ink: Rgb): Batch {
    const batch = this.painter.quads();
    batch.set(1, 3, new Float32Array(segments.flatMap(([p]) => p))).set(2, 3, new Float32Array(segments.flatMap(([, q]) => q)));
    return tint(batch, ink, 255);
  }
}

/** How long edges of a canvas are in the metric, roughly: distances along them differ by no more. */
function stepOf(cells: Cells): number {
  const { corners, distances } = cells, some: number[] = [];
  const stride = 3 * Math.max(1, Math.floor(corners.length / 30000));
  for (let i = 0; i + 1 < corners.length; i += stride) {
    const [a, b] = [corners[i], corners[i + 1]];
    if (cells.cells[a] === cells.cells[b]) some.push(Math.abs(distances[a] - distances[b]));
  }
  some.sort((x, y) => x - y);
  return some[Math.floor(0.95 * some.length)] || 1;
}

/**
 * Where cells meet in a triangle of a canvas. Of two cells: a linear form that is positive on the side of the corner that is alone. Else
 * weights of the corners. An edge of this length is cut where the distances from both sides are equal.
 */
function formOf(cells: number[], distances: number[], step: number): number[] {
  const alone = [0, 1, 2].filter((k) => cells[k] !== cells[(k + 1) % 3] && cells[k] !== cells[(k + 2) % 3]);
  if (alone.length === 0) return [1, 1, 1];
  if (alone.length === 1) {
    const k = alone[0];
    const part = (j: number) => Math.min(Math.max(0.5 + (distances[j] - distances[k]) / (2 * step), 0.06), 0.94);
    return [0, 1, 2].map((j) => (j === k ? 1 : 1 - 1 / part(j)));
  }
  const mean = (distances[0] + distances[1] + distances[2]) / 3;
  return distances.map((d) => Math.max(step + 2 * (mean - d), 0.1 * step));
}

const tinted = new WeakMap<Batch, string>();

/** A batch in one colour. */
function tint(batch: Batch, ink: Rgb, alpha: number): Batch {
  if (tinted.get(batch) === `${ink}`) return batch;
  tinted.set(batch, `${ink}`);
  const paint = new Uint8Array(4 * batch.count);
  for (let i = 0; i < batch.count; i++) paint.set([...ink, alpha], 4 * i);
  return batch.set(3, 4, paint);
}

/** The colour of a value. */
export function hueOf(field: Field, tone: Tone, value: number): Rgb {
  if (field.name === "cause") return CAUSE_HUES[value];
  if (field.kinds) return KINDS[((value % 8) + 8) % 8];
  const x = tone.isLog ? Math.log(value) : value;
  return Number.isFinite(x) ? colour(tone.scale, (x - tone.low) / (tone.high - tone.low)) : KINDS[8];
}

function bordersOf(mesh: Mesh): Uint8Array {
  const found = Uint8Array.from(mesh.sides, (count) => Number(count !== 2));
  if (mesh.labelOfEdge.size === 0) return found;
  for (let e = 0; e < found.length; e++) {
    if (!found[e] && mesh.labelOfEdge.has(key(mesh, mesh.edges[2 * e], mesh.edges[2 * e + 1]))) found[e] = 1;
  }
  return found;
}

const known = new WeakMap<Mesh, Float64Array>();

function normalsOf(mesh: Mesh) {
  const there = known.get(mesh);
  if (there) return there;
  const normals = new Float64Array(3 * mesh.vertices);
  for (let t = 0; t < mesh.triangles; t++) {
    const [a, b, c] = [0, 1, 2].map((k) => mesh.at(mesh.corners[3 * t + k]));
    const n = cross(minus(b, a), minus(c, a));
    for (let k = 0; k < 3; k++) for (let i = 0; i < 3; i++) normals[3 * mesh.corners[3 * t + k] + i] += n[i];
  }
  known.set(mesh, normals);
  return normals;
}

const minus = (p: number[], q: number[]) => p.map((x, i) => x - q[i]);
const cross = (p: number[], q: number[]) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];

/** The axes of the metric's ellipse of radius one half at a vertex. */
function ball(mesh: Mesh, v: number): [number[], number[]] | null {
  const found = sizes(mesh, v);
  return found && [0, 1].map((k) => found.axes[k].map((x) => 0.5 * found.sizes[k] * x)) as [number[], number[]];
}

/** The sizes that the metric asks for at a vertex, the smaller first, and their directions. */
export function sizes(mesh: Mesh, v: number) {
  const m = mesh.tensors.map((entries) => entries[v]);
  if (m.length === 0 || !m.every(Number.isFinite)) return null;
  let [u, w] = [[1, 0, 0], [0, 1, 0]];
  if (!mesh.isPlanar) {
    const n = [...normalsOf(mesh).subarray(3 * v, 3 * v + 3)];
    const length = Math.hypot(...n);
    if (!(length > 0)) return null;
    const unit = n.map((x) => x / length);
    const other = Math.abs(unit[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
    const first = cross(unit, other), size = Math.hypot(...first);
    u = first.map((x) => x / size);
    w = cross(unit, u);
  }
  const times = (p: number[]) => m.length === 3
    ? [m[0] * p[0] + m[1] * p[1], m[1] * p[0] + m[2] * p[1], 0]
    : [m[0] * p[0] + m[1] * p[1] + m[3] * p[2], m[1] * p[0] + m[2] * p[1] + m[4] * p[2], m[3] * p[0] + m[4] * p[1] + m[5] * p[2]];
  const dot = (p: number[], q: number[]) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  const [xx, xy, yy] = [dot(u, times(u)), dot(u, times(w)), dot(w, times(w))];
  const [mean, radius] = [(xx + yy) / 2, Math.hypot((xx - yy) / 2, xy)];
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [large, small] = [mean + radius, Math.max(mean - radius, (xx * yy - xy * xy) / (mean + radius))];
  if (!(small > 0)) return null;
  const axis = (a: number, b: number) => u.map((x, k) => a * x + b * w[k]);
  return { sizes: [1 / Math.sqrt(large), 1 / Math.sqrt(small)], axes: [axis(c, s), axis(-s, c)] };
}
