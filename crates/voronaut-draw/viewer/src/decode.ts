// From a page's numbers back to meshes: what `page/bytes.rs` and `page/order.rs` do, backwards.

/** Where a list of numbers is: deflated bytes, how many numbers, and how many bytes each takes. */
export interface Part { at: number; bytes: number; count: number; width: number }

/** The geometry of a mesh as the page describes it. */
export interface Packed {
  planar: boolean; vertices: number; triangles: number; low: number[]; step: number; bits: number;
  steps: Part; named: Part; axes: Part[]; geometry_bytes: number;
}

/** A mesh: coordinates in steps, three for each vertex, and corners, three for each triangle. */
export interface Shape { places: Int32Array; corners: Uint32Array }

const [NOTHING, NEW, AFTER, BEFORE, CLOSES, OTHER, START] = [0, 1, 2, 3, 4, 5, 6];
const NONE = 0xffffffff;

/** All numbers of a page. */
export class Store {
  private readonly all: Uint8Array<ArrayBuffer>;

  constructor(text: string) {
    const digits = atob(text.trim());
    this.all = new Uint8Array(digits.length);
    for (let i = 0; i < digits.length; i++) this.all[i] = digits.charCodeAt(i);
  }

  async bytes(part: Part): Promise<Uint8Array> {
    const deflated = new Blob([this.all.subarray(part.at, part.at + part.bytes)]);
    const inflated = deflated.stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(inflated).arrayBuffer());
  }

  /** Numbers whose lowest bytes stand together, then the next. */
  async numbers(part: Part): Promise<Uint32Array> {
    const [bytes, found] = [await this.bytes(part), new Uint32Array(part.count)];
    for (let place = 0, at = 0; place < part.width; place++) {
      const shift = 8 * place;
      for (let i = 0; i < part.count; i++) found[i] |= bytes[at++] << shift;
    }
    return found;
  }

  /** Numbers of either sign. */
  async signed(part: Part): Promise<Int32Array> {
    const found = new Int32Array((await this.numbers(part)).buffer);
    for (let i = 0; i < found.length; i++) found[i] = (found[i] >>> 1) ^ -(found[i] & 1);
    return found;
  }

  /** Integers, each of which is told by its difference from the one before. */
  async integers(part: Part): Promise<Int32Array> {
    const found = await this.signed(part);
    for (let i = 1; i < found.length; i++) found[i] = (found[i] + found[i - 1]) | 0;
    return found;
  }

  /** Numbers in single precision. */
  async reals(part: Part): Promise<Float32Array> {
    const found = await this.integers(part);
    for (let i = 0; i < found.length; i++) found[i] ^= (found[i] >> 31) >>> 1;
    return new Float32Array(found.buffer);
  }

  async shape(packed: Packed): Promise<Shape> {
    const { corners, guesses } = connect(packed, await this.bytes(packed.steps), await this.numbers(packed.named));
    const places = new Int32Array(3 * packed.vertices);
    for (let axis = 0; axis < packed.axes.length; axis++) {
      const off = await this.signed(packed.axes[axis]);
      let last = 0;
      for (let v = 0, at = axis, g = 0; v < packed.vertices; v++, at += 3, g += 3) {
        const guess = guesses[g] < 0
          ? last : places[3 * guesses[g] + axis] + places[3 * guesses[g + 1] + axis] - places[3 * guesses[g + 2] + axis];
        last = places[at] = guess + off[v];
      }
    }
    return { places, corners };
  }
}

/** Triangles from the steps that tell them, and for each vertex the corners of the parallelogram that foretells it, or -1. */
function connect(packed: Packed, steps: Uint8Array, named: Uint32Array) {
  const { vertices, triangles } = packed;
  const corners = new Uint32Array(3 * triangles), guesses = new Int32Array(3 * vertices).fill(-1);
  // Open edges: from, to, the third vertex behind, and neighbours in their ring.
  const from = new Uint32Array(3 * triangles), to = new Uint32Array(3 * triangles), behind = new Uint32Array(3 * triangles);
  const before = new Uint32Array(3 * triangles), after = new Uint32Array(3 * triangles), open = new Uint8Array(3 * triangles);
  const starting = new Uint32Array(vertices).fill(NONE);
  let [step, name, told, known, gates] = [0, 0, 0, 0, 0];

  const tell = (a: number, b: number, c: number) => {
    corners[3 * told] = a; corners[3 * told + 1] = b; corners[3 * told + 2] = c; told++;
  };
  const gate = (a: number, b: number, c: number) => {
    from[gates] = a; to[gates] = b; behind[gates] = c; open[gates] = 1;
    starting[a] = gates; before[gates] = after[gates] = gates;
    return gates++;
  };
  const link = (g: number, h: number) => { after[g] = h; before[h] = g; };

  const start = () => {
    const bits = steps[step++] - START;
    const next = (bit: number) => (bits & bit ? known++ : known - named[name++]);
    const a = next(1), b = next(2), c = next(4);
    tell(a, b, c);
    const first = gate(b, a, c), second = gate(a, c, b), third = gate(c, b, a);
    link(first, second); link(second, third); link(third, first);
  };

  const pass = (g: number) => {
    open[g] = 0;
    const kind = steps[step++];
    if (kind === NOTHING) return;
    const [a, b] = [from[g], to[g]];
    let [left, right, v] = [before[g], after[g], 0];
    if (kind === NEW) {
      v = known++;
      guesses[3 * v] = a; guesses[3 * v + 1] = b; guesses[3 * v + 2] = behind[g];
    } else if (kind === OTHER) v = known - named[name++];
    else v = kind === BEFORE ? from[left] : to[right];
    tell(a, b, v);
    const closesLeft = kind === BEFORE || kind === CLOSES, closesRight = kind === AFTER || kind === CLOSES;
    if (closesLeft) { open[left] = 0; left = before[left]; }
    if (closesRight) { open[right] = 0; right = after[right]; }
    const meeting = starting[v];
    const one = closesLeft ? NONE : gate(a, v, b), two = closesRight ? NONE : gate(v, b, a);
    const first = one === NONE ? two : one, last = two === NONE ? one : two;
    if (first === NONE) { link(left, right); return; }
    link(left, first); link(last, right);
    if (kind === OTHER && meeting !== NONE && open[meeting]) {
      const earlier = before[meeting];
      link(first, meeting); link(earlier, last);
    } else if (first !== last) link(first, last);
  };

  // What stays open after the last triangle has nothing beyond it.
  for (let g = 0; told < triangles;) {
    start();
    for (; g < gates && told < triangles; g++) if (open[g]) pass(g);
  }
  return { corners, guesses };
}
