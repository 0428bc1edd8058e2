// Meshes as the page knows them: positions, edges, figures, fields.

import { Packed, Part, Shape, Store } from "./decode";

interface PackedField extends Part { name: string; on: "vertex" | "triangle" | "edge" | "cause" }
interface PackedMesh extends Packed {
  name: string; vertex_numbers?: Part; triangle_numbers?: Part; point_labels: Part | null; triangle_labels: Part | null;
  edges: { from: Part; over: Part; labels: Part }; fields: PackedField[]; tensors: Part[];
  canvas?: Packed & { cells: Part; distances: Part }; curves: { counts: Part; axes: Part[] };
}
export interface Description { title: string; by: string; meshes: PackedMesh[] }

export type Place = "vertex" | "triangle" | "edge";
/** Values on vertices, triangles or edges; those of kinds are small integers. */
export interface Field { name: string; on: Place; values: Float32Array; kinds?: (value: number) => string; bytes: number; isOurs: boolean }

/** Why an edge is not of unit length, as `quality::Cause` has it. */
export const CAUSES = ["unit length", "boundary", "count", "turning metric", "irregular"];

/** A canvas of cells: its own triangles, the cell at each vertex, and the distance there. */
export interface Cells { corners: Uint32Array; positions: Float64Array; cells: Int32Array; hues: Uint8Array; distances: Float32Array }

export class Mesh {
  readonly name: string;
  readonly isPlanar: boolean;
  readonly hasMetric: boolean;
  /** Ends of edges, edges of triangles, how many triangles edges have. */
  edges = new Uint32Array(0);
  edgesOf = new Uint32Array(0);
  sides = new Uint8Array(0);
  fields: Field[] = [];
  tensors: Float32Array[] = [];
  pointLabels: Int32Array | null = null;
  triangleLabels: Int32Array | null = null;
  vertexNumbers: Int32Array | null = null;
  triangleNumbers: Int32Array | null = null;
  /** Labelled edges, two vertices and a label each. */
  listed = new Int32Array(0);
  labelOfEdge = new Map<number, number>();
  curves: Float64Array[] = [];
  cells: Cells | null = null;
  readonly geometryBytes: number;

  constructor(told: Pick<PackedMesh, "name" | "planar" | "geometry_bytes"> & { fields: { on: string }[] }, readonly corners: Uint32Array, readonly positions: Float64Array) {
    this.name = told.name;
    this.isPlanar = told.planar;
    this.hasMetric = told.fields.some((field) => field.on === "edge");
    this.geometryBytes = told.geometry_bytes;
  }

  get vertices() { return this.positions.length / 3; }
  get triangles() { return this.corners.length / 3; }
  vertexNumber(v: number) { return (this.vertexNumbers ? this.vertexNumbers[v] : v) + 1; }
  triangleNumber(t: number) { return (this.triangleNumbers ? this.triangleNumbers[t] : t) + 1; }
  at(v: number): [number, number, number] { return [this.positions[3 * v], this.positions[3 * v + 1], this.positions[3 * v + 2]]; }
  field(name: string) { return this.fields.find((field) => field.name === name); }

  /** The vertex with a number of the user's. */
  vertexOf(number: number) { return find(this.vertexNumbers, number, this.vertices); }
  triangleOf(number: number) { return find(this.triangleNumbers, number, this.triangles); }
  edgeOf(a: number, b: number) {
    for (let e = 0; e < this.sides.length; e++) {
      const [c, d] = [this.edges[2 * e], this.edges[2 * e + 1]];
      if ((a === c && b === d) || (a === d && b === c)) return e;
    }
    return -1;
  }
  distance(a: number, b: number) { return Math.hypot(...[0, 1, 2].map((k) => this.positions[3 * a + k] - this.positions[3 * b + k])); }
}

/** A mesh of which nothing but its triangles is known. */
export function bare(name: string, isPlanar: boolean, corners: Uint32Array, positions: Float64Array): Mesh {
  const told = { name, planar: isPlanar, fields: [], geometry_bytes: 0 };
  const mesh = new Mesh(told, corners, positions);
  findEdges(mesh);
  if (mesh.triangles > 0) addEuclidean(mesh, (name, on, values, bytes) => mesh.fields.push({ name, on, values, bytes, isOurs: false }));
  return mesh;
}

function find(numbers: Int32Array | null, number: number, count: number) {
  if (numbers) return numbers.indexOf(number - 1);
  return number >= 1 && number <= count ? number - 1 : -1;
}

function positions(told: Packed, shape: Shape) {
  const found = new Float64Array(shape.places.length);
  for (let i = 0; i < found.length; i++) found[i] = told.low[i % 3] + shape.places[i] * told.step;
  return found;
}

export async function unpack(store: Store, told: PackedMesh): Promise<Mesh> {
  const shape = await store.shape(told);
  const mesh = new Mesh(told, shape.corners, positions(told, shape));
  findEdges(mesh);
  const maybe = async (part?: Part | null) => (part ? store.integers(part) : null);
  mesh.vertexNumbers = await maybe(told.vertex_numbers);
  mesh.triangleNumbers = await maybe(told.triangle_numbers);
  mesh.pointLabels = await maybe(told.point_labels);
  mesh.triangleLabels = await maybe(told.triangle_labels);
  await addFields(mesh, store, told);
  for (const part of told.tensors) mesh.tensors.push(await store.reals(part));
  await addEdges(mesh, store, told);
  await addCurves(mesh, store, told);
  if (told.canvas) mesh.cells = await cells(store, told.canvas);
  return mesh;
}

async function addFields(mesh: Mesh, store: Store, told: PackedMesh) {
  const add = (name: string, on: Place, values: Float32Array, bytes: number, kinds?: (value: number) => string) =>
    mesh.fields.push({ name, on, values, bytes, isOurs: true, ...(kinds && { kinds }) });
  for (const part of told.fields) {
    if (part.on === "cause") {
      add(part.name, "edge", Float32Array.from(await store.integers(part)), part.bytes, (value) => CAUSES[value]);
    } else add(part.name, part.on, await store.reals(part), part.bytes);
  }
  const ours = ["quality", "smallest angle", "length"];
  for (const field of mesh.fields) field.isOurs = field.on === "edge" || (mesh.hasMetric && ours.includes(field.name));
  if (!mesh.hasMetric) addEuclidean(mesh, add);
  const labels = (name: string, on: Place, all: Int32Array | null) => {
    if (all) add(name, on, Float32Array.from(all), 0, (value) => `${value}`);
  };
  labels("triangle label", "triangle", mesh.triangleLabels);
  labels("vertex label", "vertex", mesh.pointLabels);
}

/** Quality, angles and lengths where there is no metric. */
function addEuclidean(mesh: Mesh, add: (name: string, on: Place, values: Float32Array, bytes: number) => void) {
  const count = mesh.triangles;
  const quality = new Float32Array(count), angles = new Float32Array(count);
  const lengths = new Float32Array(mesh.sides.length);
  for (let e = 0; e < lengths.length; e++) lengths[e] = mesh.distance(mesh.edges[2 * e], mesh.edges[2 * e + 1]);
  for (let t = 0; t < count; t++) {
    const squares = [0, 1, 2].map((k) => lengths[mesh.edgesOf[3 * t + k]] ** 2);
    const sum = squares[0] + squares[1] + squares[2];
    // Heron: 16 A^2.
    const sixteen = Math.max(0, sum * sum - 2 * (squares[0] ** 2 + squares[1] ** 2 + squares[2] ** 2));
    const area = Math.sqrt(sixteen) / 4;
    quality[t] = sum > 0 ? (4 * Math.sqrt(3) * area) / sum : 0;
    const least = Math.min(...squares);
    angles[t] = (Math.atan2(4 * area, sum - 2 * least) * 180) / Math.PI;
  }
  add("quality", "triangle", quality, 0);
  add("smallest angle", "triangle", angles, 0);
  add("length", "edge", lengths, 0);
}

/** Edges in the order in which triangles have them first: that of the page's values. */
function findEdges(mesh: Mesh) {
  const { corners, vertices } = mesh;
  const most = corners.length;
  const first = new Int32Array(vertices).fill(-1), next = new Int32Array(most);
  const ends = new Uint32Array(2 * most), of = new Uint32Array(most), sides = new Uint8Array(most);
  let count = 0;
  for (let h = 0; h < most; h++) {
    const t = h - (h % 3);
    const [p, q] = [corners[h], corners[t + ((h + 1) % 3)]];
    const [a, b] = p < q ? [p, q] : [q, p];
    let e = first[a];
    while (e >= 0 && ends[2 * e + 1] !== b) e = next[e];
    if (e < 0) {
      e = count++;
      ends[2 * e] = a; ends[2 * e + 1] = b;
      next[e] = first[a]; first[a] = e;
    }
    of[h] = e;
    if (sides[e] < 255) sides[e]++;
  }
  mesh.edges = ends.slice(0, 2 * count);
  mesh.sides = sides.slice(0, count);
  mesh.edgesOf = of;
}

async function addEdges(mesh: Mesh, store: Store, told: PackedMesh) {
  const [from, over, labels] = [
    await store.integers(told.edges.from), await store.integers(told.edges.over), await store.integers(told.edges.labels)];
  mesh.listed = new Int32Array(3 * from.length);
  for (let i = 0; i < from.length; i++) {
    mesh.listed.set([from[i], from[i] + over[i], labels[i]], 3 * i);
    mesh.labelOfEdge.set(key(mesh, from[i], from[i] + over[i]), labels[i]);
  }
}

export function key(mesh: Mesh, a: number, b: number) { return Math.min(a, b) * mesh.vertices + Math.max(a, b); }

async function addCurves(mesh: Mesh, store: Store, told: PackedMesh) {
  const counts = await store.integers(told.curves.counts);
  const axes: Int32Array[] = [];
  for (const part of told.curves.axes) axes.push(await store.integers(part));
  let at = 0;
  for (const count of counts) {
    const curve = new Float64Array(3 * count);
    for (let i = 0; i < count; i++, at++) {
      for (let axis = 0; axis < 3; axis++) curve[3 * i + axis] = axes[axis] ? told.low[axis] + axes[axis][at] * told.step : 0;
    }
    mesh.curves.push(curve);
  }
}

async function cells(store: Store, told: Packed & { cells: Part; distances: Part }): Promise<Cells> {
  const shape = await store.shape(told);
  const found = await store.integers(told.cells);
  return {
    corners: shape.corners, positions: positions(told, shape), cells: found,
    hues: hues(shape.corners, found), distances: await store.reals(told.distances),
  };
}

/** A small number for each vertex of a canvas: that of its cell, which differs from those of the cells beside it. */
function hues(corners: Uint32Array, cells: Int32Array) {
  const count = cells.reduce((most, cell) => Math.max(most, cell), -1) + 1;
  const beside = Array.from({ length: count }, () => new Set<number>());
  for (let i = 0; i < corners.length; i++) {
    const [a, b] = [cells[corners[i]], cells[corners[i % 3 === 2 ? i - 2 : i + 1]]];
    if (a !== b && a >= 0 && b >= 0) { beside[a].add(b); beside[b].add(a); }
  }
  const hue = new Uint8Array(count).fill(255);
  for (let c = 0; c < count; c++) {
    const used = new Set([...beside[c]].map((other) => hue[other]));
    // Where several are free, they take turns.
    let pick = (c * 5) % 8;
    for (let tries = 0; tries < 8 && used.has(pick); tries++) pick = (pick + 1) % 8;
    hue[c] = pick;
  }
  return Uint8Array.from(cells, (cell) => (cell < 0 ? 8 : hue[cell]));
}
