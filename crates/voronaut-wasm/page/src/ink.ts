// What is drawn over the mesh, with a pen: outlines, seeds, paths, the ellipse under the pointer.

import { sizes } from "../../../voronaut-draw/viewer/src/scene";
import { type Stage, within } from "./stage";

type Point = [number, number, number];

export class Ink {
  /** Rings that are being drawn; the last one is open. */
  rings: Point[][] = [];
  isOpen = false;
  seeds: Point[] = [];
  held = -1;
  /** Ends of a geodesic, and its segments. */
  ends: Point[] = [];
  path: Point[][] = [];
  /** The place that a fault names. */
  fault: Point | null = null;
  pointer: [number, number] | null = null;
  hasEllipse = true;
  private readonly context: CanvasRenderingContext2D;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly stage: Stage) {
    // A few lines: where graphics cards are busy with the mesh, processors draw them sooner.
    this.context = canvas.getContext("2d", { willReadFrequently: true })!;
    stage.viewer.drawn = () => this.draw();
  }

  draw() {
    const { viewer } = this.stage, { canvas, context } = this, ratio = viewer.canvas.width / Math.max(viewer.canvas.clientWidth, 1);
    if (canvas.width !== viewer.canvas.width || canvas.height !== viewer.canvas.height) {
      [canvas.width, canvas.height] = [viewer.canvas.width, viewer.canvas.height];
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    const ink = viewer.isDark ? "#dfe6f0" : "#16233c", mark = viewer.isDark ? "#ff4f8b" : "#e0004d";
    if (!this.stage.isMade) for (const segment of this.stage.outline) this.line(segment, ink, 1);
    this.rings.forEach((ring, i) => this.ring(ring, ink, this.isOpen && i === this.rings.length - 1));
    for (const segment of this.path) this.line(segment, mark, 2.5);
    for (const end of this.ends) this.dot(end, mark, 5);
    this.seeds.forEach((seed, i) => this.dot(seed, i === this.held ? mark : ink, i === this.held ? 6 : 4));
    if (this.fault) this.cross(this.fault, "#d62839");
    if (this.hasEllipse && this.pointer) this.ellipse(this.pointer, mark);
  }

  private line(points: Point[], colour: string, width: number) {
    const { context } = this;
    context.beginPath();
    points.forEach((p, i) => { const [x, y] = this.stage.pixel(p); i === 0 ? context.moveTo(x, y) : context.lineTo(x, y); });
    [context.strokeStyle, context.lineWidth, context.lineJoin, context.lineCap] = [colour, width, "round", "round"];
    context.stroke();
  }

  private ring(ring: Point[], colour: string, isOpen: boolean) {
    const end = isOpen && this.pointer ? this.stage.pointAt(...this.pointer) : isOpen ? null : ring[0];
    this.line(end ? [...ring, end] : ring, colour, 1.5);
    for (const p of ring) this.dot(p, colour, 3);
  }

  private dot(p: Point, colour: string, radius: number) {
    const { context } = this, [x, y] = this.stage.pixel(p);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [colour, "#fff", 1.5];
    context.fill();
    context.stroke();
  }

  private cross(p: Point, colour: string) {
    const { context } = this, [x, y] = this.stage.pixel(p);
    context.beginPath();
    context.arc(x, y, 11, 0, 2 * Math.PI);
    for (const k of [-1, 1]) { context.moveTo(x - 6, y - 6 * k); context.lineTo(x + 6, y + 6 * k); }
    [context.strokeStyle, context.lineWidth] = [colour, 2.5];
    context.stroke();
  }

  /** What is at distance one half of the pointer in the metric, as the corners of its triangle have it. */
  private ellipse([x, y]: [number, number], colour: string) {
    const { stage, context } = this, { viewer } = stage, { mesh, scene, camera } = viewer;
    if (mesh.tensors.length === 0 || viewer.other !== null) return;
    const t = viewer.triangleAt(x, y);
    if (t < 0) return;
    const corners = [0, 1, 2].map((k) => mesh.corners[3 * t + k]);
    const weights = within(corners.map((v) => camera.project(scene.place(mesh.positions, v))), [x, y]);
    // The nearest corner's directions and sizes; those between are as good a guess where triangles are small.
    const found = sizes(mesh, corners[weights.indexOf(Math.max(...weights))]);
    if (!found) return;
    const [u, w] = [0, 1].map((k) => {
      const along = found.axes[k], reach = 0.5 * found.sizes[k] * stage.scale, flat = (row: number[]) => row[0] * along[0] + row[1] * along[1] + row[2] * along[2];
      return [reach * flat(camera.rows[0]), -reach * flat(camera.rows[1])];
    });
    context.beginPath();
    for (let i = 0; i <= 48; i++) {
      const [c, s] = [Math.cos((i * Math.PI) / 24), Math.sin((i * Math.PI) / 24)];
      context.lineTo(x + c * u[0] + s * w[0], y + c * u[1] + s * w[1]);
    }
    [context.strokeStyle, context.lineWidth, context.fillStyle] = [colour, 2, `${colour}26`];
    context.fill();
    context.stroke();
  }
}
