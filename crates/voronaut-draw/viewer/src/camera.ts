// From where meshes are seen: in parallel projection, for lengths stay comparable.

type Vec = [number, number, number];

export class Camera {
  /** Rows of the rotation: right, up, towards the eye. */
  rows: [Vec, Vec, Vec] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  centre: Vec = [0, 0, 0];
  /** Pixels for a unit. */
  scale = 1;
  width = 1;
  height = 1;
  private home: { rows: [Vec, Vec, Vec]; centre: Vec; size: Vec } = { rows: this.rows, centre: [0, 0, 0], size: [1, 1, 1] };

  constructor(readonly isPlanar: boolean, centre: Vec, size: Vec) {
    if (!isPlanar) this.rows = turned(turned([[1, 0, 0], [0, 1, 0], [0, 0, 1]], 0.6, 0), 0, 0.35);
    this.home = { rows: this.rows, centre, size };
  }

  /** Shows everything, between margins in pixels. */
  fit(margin: { left: number; right: number; top: number; bottom: number }) {
    this.rows = this.home.rows;
    this.centre = [...this.home.centre];
    const half = this.home.size;
    const span = (row: Vec) => 2 * (Math.abs(row[0]) * half[0] + Math.abs(row[1]) * half[1] + Math.abs(row[2]) * half[2]);
    const [w, h] = [this.width - margin.left - margin.right, this.height - margin.top - margin.bottom];
    this.scale = 0.94 * Math.min(Math.max(w, 50) / Math.max(span(this.rows[0]), 1e-9), Math.max(h, 50) / Math.max(span(this.rows[1]), 1e-9));
    this.pan((margin.left - margin.right) / 2, (margin.top - margin.bottom) / 2);
  }

  pan(dx: number, dy: number) {
    for (let k = 0; k < 3; k++) this.centre[k] -= (dx * this.rows[0][k] - dy * this.rows[1][k]) / this.scale;
  }

  /** Zooms so that what is at a pixel stays there. */
  zoom(factor: number, x = this.width / 2, y = this.height / 2) {
    const [dx, dy] = [x - this.width / 2, y - this.height / 2];
    this.pan(-dx, -dy);
    this.scale = Math.min(Math.max(this.scale * factor, 1), 1e12);
    this.pan(dx, dy);
  }

  turn(dx: number, dy: number) { this.rows = turned(this.rows, dx, dy); }

  look(at: Vec, scale?: number) {
    this.centre = [...at];
    if (scale) this.scale = scale;
  }

  /** Pixels from the upper left, and depth, larger nearer the eye. */
  project(p: ArrayLike<number>, at = 0): Vec {
    const d = [p[at] - this.centre[0], p[at + 1] - this.centre[1], p[at + 2] - this.centre[2]];
    const along = (row: Vec) => row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
    return [this.width / 2 + this.scale * along(this.rows[0]), this.height / 2 - this.scale * along(this.rows[1]), along(this.rows[2])];
  }

  /** For WebGL, by columns; `at` and `across` are the pixel and the width that fill everything, for picking. */
  matrix(at?: [number, number], across = 1): Float32Array {
    let [sx, sy, ox, oy] = [(2 * this.scale) / this.width, (2 * this.scale) / this.height, 0, 0];
    if (at) {
      const [fx, fy] = [this.width / across, this.height / across];
      ox = -fx * ((2 * at[0]) / this.width - 1); oy = -fy * (1 - (2 * at[1]) / this.height);
      sx *= fx; sy *= fy;
    }
    const [r, u, e] = this.rows, c = this.centre, depth = -0.2;
    // Depth is about the middle of everything, so that nothing is cut off.
    const dot = (row: Vec, p: Vec = c) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
    return new Float32Array([
      sx * r[0], sy * u[0], depth * e[0], 0, sx * r[1], sy * u[1], depth * e[1], 0, sx * r[2], sy * u[2], depth * e[2], 0,
      ox - sx * dot(r), oy - sy * dot(u), -depth * dot(e, this.home.centre), 1]);
  }
}

/** A rotation, turned further by angles about the screen's upright and level axes. */
function turned(rows: [Vec, Vec, Vec], dx: number, dy: number): [Vec, Vec, Vec] {
  const mix = (p: Vec, q: Vec, c: number, s: number): Vec => [c * p[0] + s * q[0], c * p[1] + s * q[1], c * p[2] + s * q[2]];
  const [r, u, e] = rows;
  const [c, s] = [Math.cos(dx), Math.sin(dx)];
  const right = mix(r, e, c, s), eye = mix(e, r, c, -s);
  const [d, t] = [Math.cos(dy), Math.sin(dy)];
  return [right, mix(u, eye, d, -t), mix(eye, u, d, t)];
}
