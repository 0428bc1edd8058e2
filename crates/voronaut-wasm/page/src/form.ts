// What is asked for: the fields, and what the program says of them.

import { type Fault } from "./engine";
import { EXAMPLES, METRICS, type Example } from "./examples";
import type { Job } from "./words";
import { escaped } from "../../../voronaut-draw/viewer/src/panel";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const LEAST = 100, MOST = 50_000;

/** A number of vertices by where the slider is, and back. */
const countAt = (share: number) => {
  const exact = LEAST * (MOST / LEAST) ** share, step = 10 ** Math.max(Math.floor(Math.log10(exact)) - 1, 0);
  return Math.round(exact / step) * step;
};
const shareOf = (count: number) => Math.log(count / LEAST) / Math.log(MOST / LEAST);

export type Field = "domain" | "metric" | "vertices" | "work";

export class Form {
  readonly domain = element<HTMLInputElement>("domain");
  readonly metric = element<HTMLTextAreaElement>("metric");
  private readonly vertices = element<HTMLInputElement>("vertices");
  private readonly slider = element<HTMLInputElement>("count");
  private readonly cells = element<HTMLInputElement>("cells");

  /** `ask` is told when something else is asked for, and whether soon enough: sliders move on. */
  constructor(private readonly ask: (isMoving: boolean) => void, chosen: (example: Example) => void) {
    const examples = element<HTMLSelectElement>("examples");
    examples.innerHTML = `<option value="">choose …</option>${EXAMPLES.map(({ name }, i) => `<option value="${i}">${escaped(name)}</option>`).join("")}`;
    examples.addEventListener("change", () => {
      const example = EXAMPLES[Number(examples.value)];
      if (examples.value !== "" && example) chosen(example);
    });
    const metrics = element<HTMLSelectElement>("metrics");
    metrics.addEventListener("change", () => {
      if (metrics.value) { this.metric.value = metrics.value; this.ask(false); }
      metrics.value = "";
    });
    this.slider.addEventListener("input", () => { this.vertices.value = `${countAt(Number(this.slider.value))}`; this.ask(true); });
    this.vertices.addEventListener("change", () => { this.slider.value = `${shareOf(Number(this.vertices.value))}`; this.ask(false); });
    for (const field of [this.domain, this.metric, this.cells]) field.addEventListener("change", () => this.ask(false));
    // Formulas are of one line: the key begins the work.
    this.metric.addEventListener("keydown", (event) => { if (event.key === "Enter") { event.preventDefault(); this.metric.blur(); } });
  }

  get job(): Job {
    return { domain: this.domain.value.trim(), metric: this.metric.value.trim(), vertices: Number(this.vertices.value), cells: this.cells.checked };
  }

  set(job: Partial<Job>) {
    if (job.domain !== undefined) this.domain.value = job.domain;
    if (job.metric !== undefined) this.metric.value = job.metric;
    if (job.vertices !== undefined) { this.vertices.value = `${job.vertices}`; this.slider.value = `${shareOf(job.vertices)}`; }
    if (job.cells !== undefined) this.cells.checked = job.cells;
  }

  /** Which metrics there are to pick from. */
  offer(isPlanar: boolean) {
    const list = METRICS[isPlanar ? "plane" : "surface"];
    element("metrics").innerHTML = `<option value="">pick …</option>${list.map((text) => `<option>${escaped(text)}</option>`).join("")}`;
  }

  /** Says what is refused, at the field that it is about; `line` is that of a file. */
  refuse(field: Field, fault: Fault, line: string | null) {
    this.accept();
    const place = element(`${field}-fault`), help = fault.help ? `\nhelp: ${fault.help}` : "";
    place.textContent = `error: ${fault.what}${line === null ? "" : `\n  ${line}`}${help}`;
    place.hidden = false;
    const input = field === "work" ? null : element<HTMLInputElement>(field);
    input?.setAttribute("aria-invalid", "true");
    if (field === "metric") this.mark(fault);
  }

  /** Nothing is refused. */
  accept() {
    for (const field of ["domain", "metric", "vertices", "work"]) {
      element(`${field}-fault`).hidden = true;
      if (field !== "work") element(field).removeAttribute("aria-invalid");
    }
  }

  /** Selects the column of the formula that a fault names. */
  private mark(fault: Fault) {
    const column = fault.what.match(/^formula(?: m(\d\d))?, column (\d+)/);
    if (!column) return;
    const text = this.metric.value, start = text.indexOf(":") + 1, at = start + Number(column[2]) - 1;
    this.metric.focus({ preventScroll: true });
    this.metric.setSelectionRange(Math.min(at, text.length), Math.min(at + 1, text.length));
  }
}

/** The field that a fault is about. */
export function fieldOf(fault: Fault): Field {
  switch (fault.kind) {
    case "metric": return "metric";
    case "domain": case "file": return "domain";
    case "text": return /^(formula|metric|hessian)/.test(fault.place) ? "metric" : "domain";
    case "usage": return fault.what.startsWith("vertices") ? "vertices" : "work";
    default: return /metric/.test(fault.what) && !/memory/.test(fault.what) ? "metric" : "work";
  }
}
