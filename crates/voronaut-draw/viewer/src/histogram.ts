// How values are distributed, with a range to select elements by: dragged, or by the keyboard.

import { css, Rgb } from "./colours";
import { short } from "./text";

const BINS = 48;
const [WIDTH, HEIGHT] = [264, 58];

export interface Spread { low: number; high: number; isLog: boolean }

export class Histogram {
  readonly element: HTMLElement;
  /** Between which values, or everything. */
  range: [number, number] | null = null;
  private readonly plot: SVGSVGElement;
  private readonly bars: SVGRectElement[] = [];
  private readonly band: SVGRectElement;
  private readonly told: HTMLElement;
  private readonly axis: HTMLElement;
  private spread: Spread = { low: 0, high: 1, isLog: false };

  constructor(readonly title: string, private readonly changed: () => void) {
    this.element = document.createElement("figure");
    this.element.className = "histogram";
    this.element.dataset["of"] = title;
    this.element.innerHTML = `<figcaption><span>${title}</span><output></output></figcaption>`;
    this.told = this.element.querySelector("output")!;
    this.plot = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", tabindex: "0", role: "slider",
      "aria-label": `${title}: drag, or move with arrow keys, to select`, "aria-valuetext": "all" });
    for (let i = 0; i < BINS; i++) {
      this.bars.push(svg("rect", { x: `${(i * WIDTH) / BINS + 0.4}`, width: `${WIDTH / BINS - 0.8}` }));
    }
    this.band = svg("rect", { class: "band", y: "0", height: `${HEIGHT}` });
    this.plot.append(...this.bars, this.band);
    this.axis = document.createElement("div");
    this.axis.className = "axis";
    this.element.append(this.plot, this.axis);
    this.listen();
  }

  /** Shows values; colours say which part of the scale a bar is. */
  show(values: Float32Array, spread: Spread, hue: (value: number) => Rgb) {
    this.spread = spread;
    const counts = new Uint32Array(BINS);
    let all = 0;
    for (const value of values) {
      const place = Math.floor(this.placeOf(value) * BINS);
      if (!Number.isFinite(place)) continue;
      counts[Math.min(Math.max(place, 0), BINS - 1)]++;
      all++;
    }
    const most = Math.max(...counts, 1);
    this.bars.forEach((bar, i) => {
      // Roots, so that a few are seen beside many.
      const height = HEIGHT * Math.sqrt(counts[i] / most);
      bar.setAttribute("y", `${HEIGHT - height}`);
      bar.setAttribute("height", `${height}`);
      bar.setAttribute("fill", css(hue(this.valueAt((i + 0.5) / BINS))));
    });
    this.element.dataset["count"] = `${all}`;
    const middle = this.valueAt(0.5);
    this.axis.innerHTML = [spread.low, middle, spread.high].map((x) => `<span>${short(x)}</span>`).join("");
    this.say("");
  }

  say(text: string) { this.told.textContent = text; }

  contains(value: number) { return !this.range || (value >= this.range[0] && value <= this.range[1]); }

  clear() { this.select(null); }

  /** Nothing is selected, and nobody told. */
  reset() {
    this.range = this.places = null;
    this.band.style.display = "none";
  }

  private placeOf(value: number) {
    const { low, high, isLog } = this.spread;
    return isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  }

  private valueAt(place: number) {
    const { low, high, isLog } = this.spread;
    return isLog ? low * (high / low) ** place : low + place * (high - low);
  }

  /** Selects what is between two places from 0 to 1; at the ends everything beyond belongs to it. */
  private select(places: [number, number] | null) {
    if (!places) this.range = null;
    else {
      const [from, to] = [Math.max(Math.min(...places), 0), Math.min(Math.max(...places), 1)];
      this.range = [from <= 0 ? -Infinity : this.valueAt(from), to >= 1 ? Infinity : this.valueAt(to)];
      this.band.setAttribute("x", `${from * WIDTH}`);
      this.band.setAttribute("width", `${Math.max((to - from) * WIDTH, 1)}`);
    }
    this.places = places;
    this.band.style.display = places ? "" : "none";
    this.plot.setAttribute("aria-valuetext", this.range ? this.range.map(short).join(" to ") : "all");
    this.changed();
  }
  private places: [number, number] | null = null;

  private listen() {
    this.band.style.display = "none";
    let start = 0, isDragged = false;
    const place = (event: PointerEvent) => {
      const box = this.plot.getBoundingClientRect();
      return (event.clientX - box.left) / box.width;
    };
    this.plot.addEventListener("pointerdown", (event) => {
      this.plot.setPointerCapture(event.pointerId);
      [start, isDragged] = [place(event), true];
    });
    this.plot.addEventListener("pointermove", (event) => {
      if (isDragged && Math.abs(place(event) - start) > 0.01) this.select([start, place(event)]);
    });
    this.plot.addEventListener("pointerup", (event) => {
      if (isDragged && Math.abs(place(event) - start) <= 0.01) this.clear();
      isDragged = false;
    });
    this.plot.addEventListener("keydown", (event) => {
      const [from, to] = this.places ?? [0, 1], step = 1 / BINS;
      const by = event.key === "ArrowRight" ? step : event.key === "ArrowLeft" ? -step : 0;
      if (event.key === "Escape") this.clear();
      else if (by === 0) return;
      else this.select(event.shiftKey ? [from, to + by] : this.places ? [from + by, to + by] : by > 0 ? [step, 1] : [0, 1 - step]);
      event.preventDefault();
      event.stopPropagation();
    });
  }
}

function svg<K extends keyof SVGElementTagNameMap>(name: K, attributes: Record<string, string>): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

/** From where to where values go, but for the outermost of them. */
export function spreadOf(values: Float32Array, isLog: boolean): Spread {
  const step = Math.max(1, Math.floor(values.length / 20000)), some: number[] = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i]) && (!isLog || values[i] > 0)) some.push(values[i]);
  some.sort((a, b) => a - b);
  let [low, high] = [some[Math.floor(0.002 * some.length)] ?? 0, some[Math.ceil(0.998 * some.length) - 1] ?? 1];
  if (!(high > low)) [low, high] = isLog ? [low / 2 || 0.5, high * 2 || 2] : [low - 0.5, high + 0.5];
  return { low, high, isLog };
}
