// Figures as people read them.

import { sizes } from "./scene";
import { key, type Mesh } from "./model";

/** A number with a few digits. */
export function short(x: number): string {
  if (!Number.isFinite(x)) return x > 0 ? "∞" : x < 0 ? "−∞" : "none";
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return x.toExponential(2).replace("e+", "e").replace("-", "−");
  return String(Number(x.toPrecision(size >= 1000 ? 6 : 4))).replace("-", "−");
}

/** A value in single precision with all its digits. */
export function exact(x: number): string {
  return Number.isFinite(x) ? String(Number(x.toPrecision(8))).replace("-", "−") : "none";
}

export const count = (n: number) => n.toLocaleString("en").replaceAll(",", " ");

export type Kind = "vertex" | "edge" | "triangle";
export interface Hit { kind: Kind; index: number }
export type Rows = [string, string][];

/** What there is to say of an element: a title, and rows of names and values. */
export function figures(mesh: Mesh, { kind, index }: Hit): { title: string; rows: Rows } {
  const rows: Rows = [];
  const fields = () => {
    for (const field of mesh.fields) {
      if (field.on === kind) rows.push([nameOf(mesh, field.name), field.kinds ? field.kinds(field.values[index]) : exact(field.values[index])]);
    }
  };
  const coordinate = (x: number) => String(Number(x.toPrecision(10))).replace("-", "−");
  if (kind === "vertex") {
    const p = mesh.at(index);
    rows.push([mesh.isPlanar ? "x, y" : "x, y, z", p.slice(0, mesh.isPlanar ? 2 : 3).map(coordinate).join(", ")]);
    fields();
    const found = sizes(mesh, index);
    if (found) {
      rows.push(["sizes asked for", found.sizes.map(short).join(", ")], ["ratio", short(found.sizes[1] / found.sizes[0])]);
      const [x, y] = found.axes[1];
      if (mesh.isPlanar) rows.push(["long direction", `${short((((Math.atan2(y, x) * 180) / Math.PI) % 180 + 180) % 180)}°`]);
    }
    return { title: `Vertex ${count(mesh.vertexNumber(index))}`, rows };
  }
  if (kind === "edge") {
    const [a, b] = [mesh.edges[2 * index], mesh.edges[2 * index + 1]];
    rows.push(["vertices", `${mesh.vertexNumber(a)}, ${mesh.vertexNumber(b)}`]);
    fields();
    if (mesh.hasMetric) rows.push(["Euclidean length", short(mesh.distance(a, b))]);
    const label = mesh.labelOfEdge.get(key(mesh, a, b));
    if (label !== undefined) rows.push(["edge label", `${label}`]);
    if (mesh.sides[index] === 1) rows.push(["", "on the border"]);
    return { title: `Edge ${mesh.vertexNumber(a)}–${mesh.vertexNumber(b)}`, rows };
  }
  const corners = [0, 1, 2].map((k) => mesh.corners[3 * index + k]);
  rows.push(["vertices", corners.map((v) => mesh.vertexNumber(v)).join(", ")]);
  fields();
  const length = mesh.field("length");
  if (length) rows.push([nameOf(mesh, "lengths"), [0, 1, 2].map((k) => short(length.values[mesh.edgesOf[3 * index + k]])).join(", ")]);
  const [p, q, r] = corners.map((v) => mesh.at(v));
  const [u, w] = [q.map((x, i) => x - p[i]), r.map((x, i) => x - p[i])];
  const area = 0.5 * Math.hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]);
  rows.push(["area", short(area)]);
  return { title: `Triangle ${count(mesh.triangleNumber(index))}`, rows };
}

/** A field's name, and whether it is measured in the metric. */
export function nameOf(mesh: Mesh, name: string): string {
  const ours = ["quality", "smallest angle", "length", "lengths"].includes(name);
  const unit = name === "smallest angle" ? " (°)" : "";
  return ours && mesh.hasMetric ? `${name} in the metric${unit}` : `${name}${unit}`;
}
