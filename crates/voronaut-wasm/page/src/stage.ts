// What is seen of a domain, of a mesh in the making, and of one that is made.

import { Store } from "../../../voronaut-draw/viewer/src/decode";
import { type Description, Mesh, bare, unpack } from "../../../voronaut-draw/viewer/src/model";
import { Panel } from "../../../voronaut-draw/viewer/src/panel";
import { type Box, CELLS, NOTHING, Viewer, bounds } from "../../../voronaut-draw/viewer/src/viewer";
import type { Answer } from "./engine";

type Point = [number, number, number];

export class Stage {
  readonly viewer: Viewer;
  readonly panel: Panel;
  /** The curves of a planar domain, two ends each. */
  outline: Point[][] = [];
  /** A surface as it is. */
  domain: Mesh | null = null;
  private box: Box = [[-1, -1, 0], [1, 1, 0]];
  private chosen = "quality";
  /** Whether a mesh that is made is seen, and none in the making. */
  isMade = false;

  constructor(canvas: HTMLCanvasElement, by: string) {
    this.viewer = new Viewer(canvas, [empty(this.box)]);
    this.panel = new Panel(this.viewer, "Playground", by);
  }

  get isPlanar() { return this.viewer.mesh.isPlanar; }

  /** An empty plane, to draw on. */
  clear(box: Box = [[-1, -1, 0], [1, 1, 0]]) {
    this.box = box;
    this.domain = null;
    this.outline = [];
    this.show([empty(box)], "Draw a domain", false);
  }

  /** A domain as it is. */
  look(answer: Answer, title: string) {
    const points = answer.reals("points"), isPlanar = answer.told["planar"] === true;
    const mesh = bare(title, isPlanar, answer.numbers("triangles"), points);
    const at = (v: number) => [...points.subarray(3 * v, 3 * v + 3)] as Point;
    const segments = answer.numbers("segments");
    this.outline = Array.from({ length: segments.length / 2 }, (_, i) => [at(segments[2 * i]), at(segments[2 * i + 1])]);
    this.box = bounds([mesh]);
    this.domain = isPlanar ? null : mesh;
    this.show([mesh], title, false);
  }

  /** The mesh in the making. */
  sketch(points: Float64Array, triangles: Uint32Array, title: string) {
    this.show([bare(title, this.isPlanar, triangles, points)], title, false);
  }

  /** The mesh that is made, from the page that the program would write of it. */
  async made(page: string, title: string) {
    const part = (id: string) => page.match(new RegExp(`id="${id}">([^<]*)<`))![1];
    const store = new Store(part("numbers")), description = JSON.parse(part("description")) as Description;
    const meshes: Mesh[] = [];
    for (const told of description.meshes) meshes.push(await unpack(store, told));
    this.show(meshes, title, true);
  }

  private show(meshes: Mesh[], title: string, isMade: boolean) {
    const { viewer, panel } = this;
    if (this.isMade) this.chosen = viewer.colourBy;
    const hasCells = meshes[0].cells !== null, wasOfCells = this.chosen === CELLS;
    viewer.colourBy = !isMade ? NOTHING : hasCells ? CELLS : wasOfCells ? "quality" : this.chosen;
    if (isMade) {
      viewer.layers.edges = !hasCells;
      viewer.layers.geodesics = hasCells;
    } else viewer.layers.edges = true;
    this.isMade = isMade;
    viewer.renew(meshes, this.box);
    panel.renew(title);
  }

  /** The point of the plane, or of the surface in front, that is at a pixel. */
  pointAt(x: number, y: number): Point | null {
    const { camera, world, mesh } = this.viewer;
    if (mesh.isPlanar) {
      const [dx, dy] = [(x - camera.width / 2) / camera.scale, -(y - camera.height / 2) / camera.scale];
      const [right, up] = camera.rows;
      return [0, 1, 2].map((k) => (camera.centre[k] + dx * right[k] + dy * up[k]) * world.size + world.middle[k]) as Point;
    }
    return this.domain && this.onSurface(this.domain, [x, y]);
  }

  /** The point of the surface itself, for meshes of it have chords, that is in front at a pixel. */
  private onSurface(surface: Mesh, pixel: [number, number]): Point | null {
    const { corners, positions, vertices, triangles } = surface;
    const pixels = Array.from({ length: vertices }, (_, v) => this.pixel(surface.at(v)));
    let found: Point | null = null, depth = -Infinity;
    for (let t = 0; t < triangles; t++) {
      const ends = [0, 1, 2].map((k) => corners[3 * t + k]), weights = within(ends.map((v) => pixels[v]), pixel);
      if (Math.min(...weights) < 0) continue;
      const sum = (value: (v: number) => number) => ends.reduce((all, v, i) => all + weights[i] * value(v), 0);
      const near = sum((v) => pixels[v][2]);
      if (near > depth) [found, depth] = [[0, 1, 2].map((k) => sum((v) => positions[3 * v + k])) as Point, near];
    }
    return found;
  }

  /** Where a point is on the screen. */
  pixel(p: ArrayLike<number>): Point {
    const { camera, world } = this.viewer;
    return camera.project([0, 1, 2].map((k) => (p[k] - world.middle[k]) / world.size));
  }

  /** How long a unit of the domain is on the screen, in pixels. */
  get scale() { return this.viewer.camera.scale / this.viewer.world.size; }
}

/** What has a box, and nothing in it. */
function empty([low, high]: Box) {
  return bare("", low[2] === high[2], new Uint32Array(0), new Float64Array([...low, ...high]));
}

/** The weights of a triangle's corners at a pixel. */
export function within([p, q, r]: number[][], [x, y]: number[]): number[] {
  const area = (a: number[], b: number[], c: number[]) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const all = area(p, q, r), [u, v] = [area([x, y], q, r) / all, area(p, [x, y], r) / all];
  return Number.isFinite(u + v) ? [u, v, 1 - u - v] : [1, 1, -1];
}
