// The controls, and what they say.

import { CAUSE_HUES, CELL_HUES, KINDS, Rgb, colour, css } from "./colours";
import { toPng, toSvg } from "./export";
import { Histogram, spreadOf } from "./histogram";
import { CAUSES, type Field, type Mesh } from "./model";
import { hueOf, type Tone } from "./scene";
import { count, figures, nameOf, short, type Hit } from "./text";
import { CELLS, DISTANCES, Layer, NOTHING, Viewer } from "./viewer";

const LAYERS: [Layer, string, string][] = [
  ["edges", "Edges", "e"], ["borders", "Borders", "b"], ["ellipses", "Unit ellipses", "u"], ["geodesics", "Geodesic edges", "g"], ["lines", "Level lines", "l"]];

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

export class Panel {
  private readonly root = element("panel");
  private readonly histograms: Record<"length" | "quality" | "smallest angle", Histogram>;
  private timer = 0;

  constructor(readonly viewer: Viewer, public title: string, private readonly by: string) {
    this.root.innerHTML = `
      <section><h2>Colour</h2><select id="colour" aria-label="Colour by"></select><div id="legend"></div></section>
      <section><h2>Show</h2><div class="layers">${LAYERS.map(([name, text, key]) =>
        `<label title="Key ${key}"><input type="checkbox" data-layer="${name}">${text}</label>`).join("")}</div></section>
      <section id="steps"><h2>Meshes</h2>
        <div class="row"><button id="play" aria-label="Play">▶</button><input type="range" id="step" min="0" max="0" value="0" aria-label="Mesh"><output id="which"></output></div>
        <div class="row"><label for="compare">Beside</label><select id="compare"></select></div></section>
      <section id="cut"><h2>Cut</h2><div class="row"><select id="axis" aria-label="Cut across" style="width:auto"><option value="-1">nothing</option><option value="0">x</option><option value="1">y</option><option value="2">z</option><option value="3">depth</option></select>
        <input type="range" id="clip" min="0" max="1" step="0.002" value="0.5" aria-label="Where to cut"><button id="flip" aria-label="The other side">⇄</button></div></section>
      <section id="spreads"><h2>Distribution <span style="text-transform:none;letter-spacing:0;font-weight:400">· drag to select</span></h2></section>
      <section><h2>Find</h2><input type="search" id="find" placeholder="vertex 12, triangle 7, edge 3 8" aria-label="Find by number"><div id="missing" role="status"></div></section>
      <section class="row"><button id="png">PNG</button><button id="svg">SVG</button><button id="fit" title="Key 0">Fit</button><button id="theme" aria-label="Light or dark" title="Light or dark">◐</button><button id="hide" aria-label="Hide the controls" title="Hide the controls (key h)" style="margin-left:auto">✕</button></section>
      <div id="foot"></div>`;
    this.histograms = Object.fromEntries((["length", "quality", "smallest angle"] as const).map((name) =>
      [name, new Histogram(name, () => this.select())])) as typeof this.histograms;
    element("spreads").append(...Object.values(this.histograms).map((it) => it.element));
    this.listen();
    this.setDark(window.matchMedia("(prefers-color-scheme: dark)").matches);
    this.renew(title);
  }

  /** The controls of other meshes, which the viewer shows by now. */
  renew(title: string) {
    const { meshes } = this.viewer;
    this.title = title;
    element("foot").innerHTML = this.foot(this.by);
    element("steps").hidden = meshes.length < 2;
    element("cut").hidden = meshes.every((mesh) => mesh.isPlanar);
    element<HTMLInputElement>("step").max = `${meshes.length - 1}`;
    element("compare").innerHTML = `<option value="">nothing</option>${meshes.map((mesh, i) => `<option value="${i}">${escaped(mesh.name)}</option>`).join("")}`;
    for (const histogram of Object.values(this.histograms)) histogram.reset();
    this.setMesh(0);
  }

  private foot(by: string) {
    const { meshes } = this.viewer;
    const numbers = meshes.every((mesh) => mesh.vertexNumbers) ? "numbers are the file's" : "numbers are this page's, not the file's";
    const [{ geometryBytes, triangles }] = meshes, isPacked = geometryBytes > 0;
    const kept = isPacked ? `Coordinates to 26 bits (${((8 * geometryBytes) / triangles).toFixed(1)} bits a triangle), values in single precision; ${numbers}.` : "";
    return `<p>${kept}</p>
      <p><kbd>drag</kbd> ${this.viewer.camera.isPlanar ? "move" : "turn, with shift move"} · <kbd>wheel</kbd> zoom · <kbd>click</kbd> pick · <kbd>/</kbd> find</p><p>${escaped(by)}</p>`;
  }

  private listen() {
    const { viewer } = this, on = (id: string, type: string, act: (target: HTMLInputElement) => void) =>
      element(id).addEventListener(type, (event) => act(event.target as HTMLInputElement));
    on("colour", "change", (it) => this.setColour(it.value));
    for (const box of this.root.querySelectorAll<HTMLInputElement>("[data-layer]")) {
      box.addEventListener("change", () => { viewer.layers[box.dataset["layer"] as Layer] = box.checked; viewer.redraw(); });
    }
    on("step", "input", (it) => this.setMesh(Number(it.value)));
    on("play", "click", () => this.play());
    on("compare", "change", (it) => this.compare(it.value === "" ? null : Number(it.value)));
    on("axis", "change", (it) => { viewer.clip.axis = Number(it.value); viewer.redraw(); });
    on("clip", "input", (it) => {
      viewer.clip.share = Number(it.value);
      if (viewer.clip.axis < 0) { viewer.clip.axis = 0; element<HTMLSelectElement>("axis").value = "0"; }
      viewer.redraw();
    });
    on("flip", "click", () => { viewer.clip.isFlipped = !viewer.clip.isFlipped; viewer.redraw(); });
    on("find", "change", (it) => this.find(it.value));
    on("png", "click", () => void toPng(viewer, this.title, this.legendParts()));
    on("svg", "click", () => toSvg(viewer, this.title, this.legendParts()));
    on("fit", "click", () => this.fit());
    on("theme", "click", () => this.setDark(!viewer.isDark));
    on("hide", "click", () => this.toggle());
    element("open").addEventListener("click", () => this.toggle());
    this.divide();
  }

  fit() { this.viewer.camera.fit(this.viewer.margin); this.viewer.redraw(); }

  toggle() {
    this.root.hidden = !this.root.hidden;
    this.viewer.margin.right = this.root.hidden || window.innerWidth <= 720 ? 0 : 316;
  }

  setDark(isDark: boolean) {
    document.documentElement.dataset["theme"] = isDark ? "dark" : "light";
    document.documentElement.style.colorScheme = isDark ? "dark" : "light";
    this.viewer.isDark = isDark;
    this.viewer.redraw();
  }

  /** Keys of layers. */
  key(key: string): boolean {
    const layer = LAYERS.find(([, , it]) => it === key);
    const box = layer && this.root.querySelector<HTMLInputElement>(`[data-layer="${layer[0]}"]`);
    if (!box || box.closest("label")!.hidden) return false;
    box.click();
    return true;
  }

  setMesh(i: number) {
    const { viewer } = this, { meshes } = viewer;
    viewer.current = i;
    viewer.pick(null);
    this.tell(null);
    const { mesh } = viewer;
    element<HTMLInputElement>("step").value = `${i}`;
    element("which").textContent = `${i + 1}/${meshes.length}`;
    document.querySelector("h1")!.textContent = this.title;
    const facts = mesh.triangles === 0 ? "" : `${count(mesh.vertices)} vertices · ${count(mesh.triangles)} triangles`;
    element("facts").textContent = meshes.length > 1 ? `${mesh.name} · ${facts}` : facts;
    this.choices(mesh);
    this.spreads();
    this.select();
    this.legend();
    this.nameSides();
  }

  /** What a mesh may be coloured by, and what of it may be shown. */
  private choices(mesh: Mesh) {
    const names = [...new Set(mesh.fields.map((field) => field.name))];
    const all = [NOTHING, ...names, ...(mesh.cells ? [CELLS, DISTANCES] : [])];
    const { viewer } = this, shown = (name: string) => (name === "cause" ? "why edges are not of unit length" : nameOf(mesh, name));
    if (!all.includes(viewer.colourBy)) viewer.colourBy = names.includes("quality") ? "quality" : NOTHING;
    element("colour").innerHTML = all.map((name) => `<option value="${escaped(name)}">${escaped(shown(name))}</option>`).join("");
    element<HTMLSelectElement>("colour").value = viewer.colourBy;
    const has: Record<Layer, boolean> = {
      edges: true, borders: true, ellipses: mesh.tensors.length > 0, geodesics: mesh.curves.length > 0, lines: mesh.fields.some((it) => it.on === "vertex" && !it.kinds) };
    for (const box of this.root.querySelectorAll<HTMLInputElement>("[data-layer]")) {
      const layer = box.dataset["layer"] as Layer;
      box.closest("label")!.hidden = !has[layer];
      box.checked = viewer.layers[layer];
    }
  }

  setColour(name: string) {
    this.viewer.colourBy = name;
    element<HTMLSelectElement>("colour").value = name;
    this.viewer.scene.choose();
    this.legend();
    this.viewer.redraw();
  }

  private spreads() {
    const { viewer } = this, { mesh } = viewer;
    element("spreads").hidden = mesh.fields.length === 0;
    for (const [name, histogram] of Object.entries(this.histograms)) {
      const field = mesh.fields.find((it) => it.name === name && it.isOurs && (it.on === "edge") === (name === "length")) ?? mesh.field(name);
      histogram.element.hidden = !field;
      if (!field) continue;
      const tone = viewer.tone(field);
      const fixed = name === "quality" ? { low: 0, high: 1, isLog: false } : name === "smallest angle" ? { low: 0, high: 60, isLog: false } : null;
      const lengths = mesh.hasMetric ? { low: 0.25, high: 4, isLog: true } : spreadOf(field.values, true);
      histogram.element.querySelector("figcaption span")!.textContent = nameOf(mesh, name);
      histogram.show(field.values, fixed ?? lengths, (value) => hueOf(field, tone, value));
    }
  }

  /** Selects what is within all ranges. */
  select() {
    const { viewer } = this;
    viewer.meshes.forEach((mesh, i) => {
      if (i !== viewer.current && i !== viewer.other) return;
      const scene = viewer.sceneOf(i), { length } = this.histograms;
      const of = (name: string) => mesh.field(name)?.values;
      const [quality, angle, lengths] = ["quality", "smallest angle", "length"].map(of);
      const ranges = this.histograms;
      for (let t = 0; t < mesh.triangles; t++) {
        scene.chosenTriangles[t] = Number((!quality || ranges.quality.contains(quality[t])) && (!angle || ranges["smallest angle"].contains(angle[t])));
      }
      for (let e = 0; e < scene.chosenEdges.length; e++) scene.chosenEdges[e] = Number(!lengths || length.contains(lengths[e]));
      scene.choose();
    });
    this.say();
    viewer.redraw();
  }

  private say() {
    const { chosenTriangles, chosenEdges } = this.viewer.scene;
    const sum = (list: Uint8Array) => list.reduce((all, it) => all + it, 0);
    const told = (list: Uint8Array, what: string) => `${count(sum(list))} of ${count(list.length)} ${what}`;
    for (const [name, histogram] of Object.entries(this.histograms)) {
      histogram.say(!histogram.range ? "" : name === "length" ? told(chosenEdges, "edges") : told(chosenTriangles, "triangles"));
    }
  }

  private legend() {
    const legend = element("legend"), parts = this.legendParts();
    if (parts.kinds) {
      legend.innerHTML = `<ul class="kinds">${parts.kinds.map(([text, hue, many]) =>
        `<li>${parts.tone === null && many === "" ? "" : `<i style="background:${css(hue)}"></i>`}<span>${escaped(text)}</span><b>${many}</b></li>`).join("")}</ul>`;
    } else if (parts.tone) {
      const stops = Array.from({ length: 11 }, (_, i) => css(colour(parts.tone!.scale, i / 10)));
      legend.innerHTML = `<div id="ramp" style="background:linear-gradient(90deg,${stops})"></div><div class="ends">${parts.ends.map((x) => `<span>${x}</span>`).join("")}</div>`;
    } else legend.innerHTML = "";
  }

  /** The scale, or the kinds with their colours and how many there are. */
  legendParts(): { name: string; tone: Tone | null; ends: string[]; kinds: [string, Rgb, string][] | null } {
    const { viewer } = this, { mesh } = viewer, field = viewer.fieldOf(mesh), name = field ? nameOf(mesh, field.name) : viewer.colourBy;
    if (viewer.colourBy === CELLS && mesh.cells) {
      return { name, tone: null, ends: [], kinds: [["one cell for each vertex; neighbours differ", CELL_HUES[0], ""]] };
    }
    if (field?.kinds) return { name, tone: null, ends: [], kinds: kinds(field) };
    const tone = viewer.colourBy === DISTANCES && mesh.cells ? viewer.distanceTone() : field ? viewer.tone(field) : null;
    const back = (x: number) => short(tone!.isLog ? Math.exp(x) : x);
    return { name, tone, kinds: null, ends: tone ? [tone.low, (tone.low + tone.high) / 2, tone.high].map(back) : [] };
  }

  /** What is picked, in a card that stays. */
  tell(hit: Hit | null) {
    const card = element("picked");
    card.hidden = !hit;
    if (!hit) return;
    card.innerHTML = `<button aria-label="Let go">✕</button>${told(this.viewer.mesh, hit)}`;
    card.querySelector("button")!.addEventListener("click", () => { this.viewer.pick(null); this.tell(null); });
  }

  pick(hit: Hit | null) { this.viewer.pick(hit); this.tell(hit); }

  find(text: string) {
    const hit = search(this.viewer.mesh, text);
    element("missing").textContent = text.trim() === "" || hit ? "" : "There is none of that number.";
    if (!hit) return;
    this.viewer.show(hit);
    this.tell(hit);
  }

  play() {
    const { meshes } = this.viewer, button = element("play");
    if (this.timer) { window.clearInterval(this.timer); this.timer = 0; button.textContent = "▶"; return; }
    button.textContent = "❚❚";
    this.timer = window.setInterval(() => this.setMesh((this.viewer.current + 1) % meshes.length), 900);
  }

  compare(other: number | null) {
    this.viewer.other = other;
    element("divider").hidden = element("names").hidden = other === null;
    this.nameSides();
    this.select();
  }

  private nameSides() {
    const { viewer } = this, x = `${100 * viewer.split}%`;
    element("divider").style.left = element("names").style.left = x;
    const names = element("names").children;
    [viewer.current, viewer.other].forEach((i, k) => { names[k].textContent = i === null ? "" : viewer.meshes[i].name; });
  }

  private divide() {
    const { viewer } = this, divider = element("divider");
    const move = (share: number) => { viewer.split = Math.min(Math.max(share, 0.02), 0.98); this.nameSides(); viewer.redraw(); };
    divider.addEventListener("pointerdown", (event) => divider.setPointerCapture(event.pointerId));
    divider.addEventListener("pointermove", (event) => {
      if (divider.hasPointerCapture(event.pointerId)) move(event.clientX / window.innerWidth);
    });
    divider.addEventListener("keydown", (event) => {
      const by = event.key === "ArrowLeft" ? -0.02 : event.key === "ArrowRight" ? 0.02 : 0;
      if (by !== 0) { move(viewer.split + by); event.preventDefault(); event.stopPropagation(); }
    });
  }
}

function kinds(field: Field): [string, Rgb, string][] {
  const counts = new Map<number, number>();
  for (const value of field.values) counts.set(value, (counts.get(value) ?? 0) + 1);
  const all = field.name === "cause" ? CAUSES.map((_, i) => i) : [...counts.keys()].sort((a, b) => a - b);
  const hue = (value: number) => (field.name === "cause" ? CAUSE_HUES[value] : KINDS[((value % 8) + 8) % 8]);
  return all.map((value) => [field.kinds!(value), hue(value), count(counts.get(value) ?? 0)]);
}

export function told(mesh: Mesh, hit: Hit) {
  const { title, rows } = figures(mesh, hit);
  return `<strong>${title}</strong><dl>${rows.map(([name, value]) => `<dt>${escaped(name)}</dt><dd>${escaped(value)}</dd>`).join("")}</dl>`;
}

/** What words name: `vertex 12` or `12`, `triangle 7` or `t 7`, `edge 3 8`. */
function search(mesh: Mesh, text: string): Hit | null {
  const numbers = (text.match(/\d+/g) ?? []).map(Number), word = text.trim().toLowerCase();
  if (numbers.length === 0) return null;
  const found = (kind: Hit["kind"], index: number) => (index >= 0 ? { kind, index } : null);
  if (word.startsWith("t")) return found("triangle", mesh.triangleOf(numbers[0]));
  if (word.startsWith("e") || numbers.length === 2) return found("edge", mesh.edgeOf(mesh.vertexOf(numbers[0]), mesh.vertexOf(numbers[1])));
  return found("vertex", mesh.vertexOf(numbers[0]));
}

export function escaped(text: string) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
}
