// The work: from what is asked for to what is seen.

import { Cancelled, type Engine, type Fault, Refused } from "./engine";
import { FILES } from "./examples";
import { type Form, fieldOf } from "./form";
import type { Ink } from "./ink";
import type { Progress } from "./progress";
import { type Report, showDistance, showFigures, showSeeds, showWords } from "./results";
import type { Stage } from "./stage";
import { stem, type Job } from "./words";

type Point = [number, number, number];
const option = (name: string, ...values: (string | number)[]): [string, string[]] => [name, values.map(String)];
/** Of the 4 GiB that a module can have at most. */
const MEMORY = option("memory_limit", 3);
/** Vertices of canvases for each seed while it is moved and when it rests, and for a geodesic in all. */
const [MOVING, RESTING, WAY] = [4, 20, 15_000];

export class Bench {
  /** What the mesh that is seen was made by, its report, and the page that the program would write of it. */
  made: { job: Job; report: Report; page: string } | null = null;
  private turn = 0;
  private looked = "";
  private isMeshing = false;
  private isFollowing = false;
  private isAgain = false;

  constructor(
    private readonly engine: Engine, private readonly stage: Stage, private readonly ink: Ink, private readonly form: Form,
    private readonly progress: Progress, private readonly shipped: (name: string) => Promise<Uint8Array>) {}

  /** Makes the mesh that is asked for, from the beginning. */
  async run() {
    const job = this.form.job, turn = this.begin();
    showWords(job);
    try {
      await this.look(job.domain);
      this.isMeshing = true;
      const out = stem(job.domain), cells: [string, string[]][] = job.cells ? [option("cells")] : [];
      const options = [option("domain", job.domain), option("metric", job.metric), option("vertices", job.vertices),
        option("out", `${out}.mesh`), option("view", `${out}.html`), MEMORY, ...cells];
      const answer = await this.engine.ask({ do: "perform", command: "mesh", options });
      if (turn !== this.turn) return;
      const report = answer.told["report"] as Report, page = answer.text("page")!;
      this.made = { job, report, page };
      await this.stage.made(page, job.domain);
      showFigures(report, answer.told["warnings"] as string[]);
    } catch (fault) {
      if (turn === this.turn) this.refuse(fault);
    } finally {
      if (turn === this.turn) this.end();
    }
  }

  /** Ends the work; what was seen last stays. */
  cancel() {
    this.turn++;
    // The worker that goes has the mesh.
    if (this.engine.isBusy) this.made = null;
    this.engine.cancel();
    this.end();
    document.getElementById("figures")!.innerHTML = "<p>cancelled</p>";
  }

  private begin() {
    this.engine.cancel();
    [this.made, this.ink.path, this.ink.ends, this.ink.fault] = [null, [], [], null];
    for (const id of ["figures", "way"]) document.getElementById(id)!.innerHTML = "";
    this.form.accept();
    this.progress.begin();
    this.tell("busy");
    return ++this.turn;
  }

  private end() {
    this.isMeshing = false;
    this.progress.end();
    this.tell("idle");
  }

  private tell(state: string) {
    document.documentElement.dataset["state"] = state;
    for (const button of document.querySelectorAll<HTMLButtonElement>(".take button")) button.disabled = !this.made;
  }

  /** The mesh in the making. */
  sketch(points: Float64Array, triangles: Uint32Array) {
    if (this.isMeshing) this.stage.sketch(points, triangles, this.form.job.domain);
  }

  /** Shows a domain, unless it is what is seen. */
  private async look(domain: string) {
    if (FILES.includes(domain) && !this.engine.holds(domain)) await this.engine.hold(domain, await this.shipped(domain));
    if (domain === this.looked) return;
    this.looked = "";
    const answer = await this.engine.ask({ do: "look", domain });
    this.looked = domain;
    this.ink.rings = [];
    this.ink.seeds = [];
    this.stage.look(answer, domain);
    this.form.offer(this.stage.isPlanar);
  }

  /** A file of the user's, as the domain. */
  async open(name: string, bytes: Uint8Array) {
    this.begin();
    try {
      await this.engine.hold(name, bytes);
    } catch (fault) {
      this.form.set({ domain: name });
      this.refuse(fault, bytes);
      this.end();
      return;
    }
    this.looked = "";
    this.form.set({ domain: name });
    await this.run();
  }

  /** A domain that is drawn: its outer ring, and holes. */
  async drawn(rings: Point[][]) {
    const ring = (points: Point[]) => [...points, points[0]].map(([x, y]) => [round(x, this.stage.scale), round(y, this.stage.scale)]);
    const text = JSON.stringify({ type: "Polygon", coordinates: rings.map(ring) });
    const kept = rings.map((points) => [...points]);
    await this.open("drawn.geojson", new TextEncoder().encode(text));
    // What is wrong is seen on what was drawn.
    if (!this.made && this.looked === "") { this.ink.rings = kept; this.stage.viewer.redraw(); }
  }

  /** Says what is refused, where it belongs. */
  private refuse(reason: unknown, bytes?: Uint8Array) {
    if (reason instanceof Cancelled) return;
    const known = reason instanceof Refused ? reason.fault : { kind: "work", what: String(reason), help: "", place: "" } as Fault;
    const fault = known.kind === "file" ? { ...known, what: `${known.place}: no such file here`, help: "drop it on the page, or open it" } : known;
    this.form.refuse(fieldOf(fault), fault, this.lineOf(fault, bytes));
    const at = fault.kind === "domain" && `${fault.what} ${fault.place}`.match(/\((-?[\d.e-]+), (-?[\d.e-]+)(?:, (-?[\d.e-]+))?\)/);
    if (at) this.ink.fault = [Number(at[1]), Number(at[2]), Number(at[3] ?? 0)];
    this.stage.viewer.redraw();
  }

  /** The line of a file that a fault names. */
  private lineOf(fault: Fault, bytes?: Uint8Array) {
    const found = fault.place.match(/^(.+?):(\d+)(?::\d+)?$/), file = bytes ?? (found && this.engine.file(found[1]));
    if (!found || !file) return null;
    return new TextDecoder().decode(file).split("\n")[Number(found[2]) - 1]?.trim().slice(0, 60) ?? null;
  }

  /** Seeds of the domain that is asked for: so many, anywhere. */
  async scatter(count: number) {
    const turn = this.begin();
    try {
      await this.look(this.form.job.domain);
      this.ink.seeds = scattered(count, this.stage);
      this.end();
      await this.follow();
    } catch (fault) {
      if (turn === this.turn) this.refuse(fault);
    } finally {
      if (turn === this.turn) this.end();
    }
  }

  /** Cells and dual of the seeds, again if they have moved meanwhile. */
  async follow() {
    this.isAgain = true;
    if (this.isFollowing) return;
    const turn = this.turn;
    this.isFollowing = true;
    this.tell("busy");
    while (this.isAgain && turn === this.turn) {
      this.isAgain = false;
      await this.dual();
    }
    this.isFollowing = false;
    if (turn === this.turn) this.tell("idle");
  }

  private async dual() {
    const { seeds, held } = this.ink, job = this.form.job, start = performance.now();
    const options = [option("domain", job.domain), option("metric", job.metric), option("seeds", "seeds"), option("out", "seeds.mesh"),
      option("view", "seeds.html"), option("cells"), option("canvas_size", held < 0 ? RESTING : MOVING), MEMORY];
    const given = seeds.map((p) => (this.stage.isPlanar ? p.slice(0, 2) : p));
    try {
      const answer = await this.engine.ask({ do: "perform", command: "dual", options, seeds: given });
      this.form.accept();
      await this.stage.made(answer.text("page")!, `${seeds.length} seeds`);
      showSeeds(seeds.length, answer.told["report"] as Report, (performance.now() - start) / 1000);
    } catch (fault) { this.refuse(fault); }
  }

  /** The geodesic between two points, and its length. */
  async between(from: Point, to: Point) {
    const { domain, metric } = this.form.job, isPlanar = this.stage.isPlanar;
    const words = (p: Point) => (isPlanar ? p.slice(0, 2) : p).join(",");
    const options = [option("domain", domain), option("metric", metric), option("from", words(from)), option("to", words(to)),
      option("out", "way.vtu"), option("canvas_size", WAY), MEMORY];
    document.getElementById("way")!.innerHTML = "<p>…</p>";
    try {
      const answer = await this.engine.ask({ do: "perform", command: "distance", options });
      const points = answer.reals("path"), at = (i: number) => [...points.subarray(3 * i, 3 * i + 3)] as Point;
      this.ink.path = Array.from({ length: points.length / 6 }, (_, i) => [at(2 * i), at(2 * i + 1)]);
      showDistance((answer.told["report"] as { distance: number }).distance, this.made?.report.metric_scale);
      this.form.accept();
    } catch (fault) {
      document.getElementById("way")!.innerHTML = "";
      this.refuse(fault);
    }
    this.stage.viewer.redraw();
  }

  /** The mesh in a format, as the program writes it. */
  async file(name: string) { return (await this.engine.ask({ do: "write", name })).bytes("file")!; }
}

/** To a tenth of a pixel. */
function round(x: number, scale: number) {
  const digits = Math.max(0, Math.ceil(Math.log10(10 * scale)));
  return Number(x.toFixed(Math.min(digits, 12)));
}

/** Points of a domain, the same each time. */
function scattered(count: number, stage: Stage): Point[] {
  const mesh = stage.domain, found: Point[] = [];
  let state = 12345;
  const random = () => (state = (Math.imul(state, 1103515245) + 12345) & 0x7fffffff) / 0x7fffffff;
  if (mesh) {
    while (found.length < Math.min(count, mesh.vertices)) {
      const p = mesh.at(Math.floor(random() * mesh.vertices));
      if (!found.some((q) => q.every((x, k) => x === p[k]))) found.push(p);
    }
    return found;
  }
  const ends = stage.outline.flat(), [low, high] = [0, 1].map((i) => [0, 1].map((k) => ends.reduce((best, p) => (i === 0 ? Math.min(best, p[k]) : Math.max(best, p[k])), i === 0 ? Infinity : -Infinity)));
  // Even numbers of crossings are outside.
  const isInside = ([x, y]: Point) => stage.outline.filter(([p, q]) => (p[1] > y) !== (q[1] > y) && x < p[0] + ((y - p[1]) / (q[1] - p[1])) * (q[0] - p[0])).length % 2 === 1;
  for (let tries = 0; found.length < count && tries < 1000 * count; tries++) {
    const p: Point = [low[0] + random() * (high[0] - low[0]), low[1] + random() * (high[1] - low[1]), 0];
    if (isInside(p)) found.push(p);
  }
  return found;
}
