// What came of the work: figures, files to take away, the words that make the same elsewhere.

import { count, short } from "../../../voronaut-draw/viewer/src/text";
import { escaped } from "../../../voronaut-draw/viewer/src/panel";
import { commandLine, pythonCall, stem, type Job } from "./words";

const element = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** What reports have. */
export interface Report {
  vertices: number; triangles: number; valid: boolean; metric_scale?: number; notes?: string[];
  metric_edge_length?: { mean: number; unit_fraction: number }; quality?: { min: number; mean: number }; angle?: { min: number };
  seconds: { total: number };
}

/** Formats, as their files end. */
export const ENDINGS = ["mesh", "meshb", "msh", "su2", "vtu", "vtp", "obj", "off", "ply", "stl"];

const row = ([name, value]: [string, string]) => `<dt>${escaped(name)}</dt><dd>${escaped(value)}</dd>`;

export function showFigures({ vertices, triangles, valid, metric_edge_length: length, quality, angle, seconds, notes = [] }: Report, warnings: string[]) {
  const rows: [string, string][] = [["vertices", count(vertices)], ["triangles", count(triangles)], ["valid", valid ? "yes" : "no"]];
  if (length) rows.push(["unit edges", `${(100 * length.unit_fraction).toFixed(1)} %`], ["mean length", length.mean.toFixed(3)]);
  if (quality) rows.push(["quality, mean / min", `${quality.mean.toFixed(3)} / ${quality.min.toFixed(3)}`]);
  if (angle) rows.push(["smallest angle", `${angle.min.toFixed(1)}°`]);
  rows.push(["time", `${seconds.total.toFixed(2)} s`]);
  const said = [...notes, ...warnings].map((note) => `<p>note: ${escaped(note)}</p>`).join("");
  element("figures").innerHTML = `<dl>${rows.map(row).join("")}</dl>${said}`;
}

/** What is known of seeds that are given. */
export function showSeeds(seeds: number, report: Report & { validity?: unknown }, seconds: number) {
  element("figures").innerHTML = `<dl>${([["seeds", count(seeds)], ["triangles of the dual", count(report.triangles)], ["time", `${seconds.toFixed(2)} s`]] as [string, string][]).map(row).join("")}</dl>`;
}

export function showDistance(distance: number, scale: number | undefined) {
  const more: [string, string][] = scale ? [["edges of this mesh", short(distance * Math.sqrt(scale))]] : [];
  element("way").innerHTML = `<dl>${([["distance in the metric", short(distance)], ...more] as [string, string][]).map(row).join("")}</dl>`;
}

/** The command line and the Python call of what is asked for. */
export function showWords(job: Job) {
  element("shell").textContent = commandLine(job);
  element("python").textContent = pythonCall(job);
}

export function save(name: string, bytes: Uint8Array<ArrayBuffer> | string, type = "application/octet-stream") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type }));
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Copies a text, where browsers let pages from files do so, and says that it did. */
export async function copy(id: string, button: HTMLButtonElement) {
  const text = element(id).textContent ?? "";
  await navigator.clipboard.writeText(text).catch(() => {
    const range = document.createRange();
    range.selectNodeContents(element(id));
    window.getSelection()?.removeAllRanges();
    window.getSelection()?.addRange(range);
    document.execCommand("copy");
  });
  button.textContent = "copied";
  window.setTimeout(() => { button.textContent = "copy"; }, 1500);
}

export const fileName = (job: Job, ending: string) => `${stem(job.domain)}-${job.vertices}.${ending}`;
