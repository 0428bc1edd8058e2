// Pictures of what is seen: pixels, or triangles as paths.

import { colour, css, Rgb } from "./colours";
import { Scene, Tone, hueOf } from "./scene";
import { CELLS, DISTANCES, Viewer } from "./viewer";

interface Legend { name: string; tone: Tone | null; ends: string[]; kinds: [string, Rgb, string][] | null }

/** More triangles than this are pixels within an SVG. */
const MOST_PATHS = 60000;

function save(href: string, name: string) {
  const link = document.createElement("a");
  link.href = href;
  link.download = name;
  link.click();
}

const fileName = (title: string, ending: string) => `${title.replace(/[^\p{L}\p{N}._-]+/gu, "-") || "mesh"}.${ending}`;

/** The picture with its legend, as large as it is seen. */
export async function toPng(viewer: Viewer, title: string, legend: Legend) {
  const picture = document.createElement("canvas");
  viewer.draw();
  [picture.width, picture.height] = [viewer.canvas.width, viewer.canvas.height];
  const context = picture.getContext("2d")!;
  context.drawImage(viewer.canvas, 0, 0);
  const ratio = picture.width / viewer.camera.width;
  const image = new Image();
  // The text of an SVG is what both pictures share.
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(wrapped(viewer, key(viewer, legend)))}`;
  await image.decode();
  context.scale(ratio, ratio);
  context.drawImage(image, 0, 0);
  save(picture.toDataURL("image/png"), fileName(title, "png"));
}

/** Triangles as paths where they are not too many; cells and distances as pixels. */
export function toSvg(viewer: Viewer, title: string, legend: Legend) {
  const isOfPixels = viewer.mesh.triangles > MOST_PATHS || viewer.other !== null || [CELLS, DISTANCES].includes(viewer.colourBy) || viewer.clip.axis >= 0;
  let body: string;
  if (isOfPixels) {
    viewer.draw();
    body = `<image width="${viewer.camera.width}" height="${viewer.camera.height}" href="${viewer.canvas.toDataURL("image/png")}"/>`;
  } else body = paths(viewer, viewer.scene);
  const text = wrapped(viewer, `<rect width="100%" height="100%" fill="${css(viewer.inks.paper)}"/>${body}${key(viewer, legend)}`);
  const href = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  save(href, fileName(title, "svg"));
  window.setTimeout(() => URL.revokeObjectURL(href), 10000);
}

function wrapped({ camera: { width, height } }: Viewer, body: string) {
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" font-size="13">${body}</svg>`;
}

function paths(viewer: Viewer, scene: Scene): string {
  const { camera, inks } = viewer, { mesh } = scene, field = viewer.fieldOf(mesh), tone = field && viewer.tone(field);
  const places = Array.from({ length: mesh.vertices }, (_, v) => camera.project(scene.place(mesh.positions, v)));
  const pair = (v: number) => `${places[v][0].toFixed(2)} ${places[v][1].toFixed(2)}`;
  const order: { depth: number; path: string }[] = [];
  const stroke = viewer.layers.edges ? css(inks.ink) : null;
  for (let t = 0; t < mesh.triangles; t++) {
    const corners = [0, 1, 2].map((k) => mesh.corners[3 * t + k]), ps = corners.map((v) => places[v]);
    if ([0, 1].some((k) => ps.every((p) => p[k] < 0) || ps.every((p) => p[k] > (k ? camera.height : camera.width)))) continue;
    let fill: Rgb = inks.plain;
    if (field && tone && field.on !== "edge") {
      const value = field.on === "triangle" ? field.values[t] : field.kinds ? field.values[corners[2]] : corners.reduce((sum, v) => sum + field.values[v], 0) / 3;
      fill = hueOf(field, tone, value);
    }
    if (!scene.chosenTriangles[t]) fill = inks.faint;
    if (!mesh.isPlanar) fill = fill.map((x) => x * lit(ps)) as Rgb;
    const path = `<path d="M${pair(corners[0])}L${pair(corners[1])}L${pair(corners[2])}Z" fill="${css(fill)}" stroke="${stroke ?? css(fill)}"/>`;
    order.push({ depth: ps[0][2] + ps[1][2] + ps[2][2], path });
  }
  // What is nearer comes later.
  if (!mesh.isPlanar) order.sort((a, b) => a.depth - b.depth);
  let lines = "";
  const line = (a: number, b: number, hue: Rgb, width: number) => { lines += `<path d="M${pair(a)}L${pair(b)}" stroke="${css(hue)}" stroke-width="${width}"/>`; };
  if (field && tone && field.on === "edge" && mesh.isPlanar) {
    for (let e = 0; e < mesh.sides.length; e++) if (scene.chosenEdges[e]) line(mesh.edges[2 * e], mesh.edges[2 * e + 1], hueOf(field, tone, field.values[e]), 1.6);
  }
  if (viewer.layers.borders && mesh.isPlanar) {
    for (let i = 0; i < mesh.listed.length; i += 3) line(mesh.listed[i], mesh.listed[i + 1], inks.border, 1.4);
  }
  return `<g stroke-width="${stroke ? 0.4 : 0.3}" stroke-linejoin="round" stroke-linecap="round">${order.map((it) => it.path).join("")}</g><g fill="none" stroke-linecap="round">${lines}</g>`;
}

/** How bright a triangle is that is seen from here. */
function lit(ps: number[][]) {
  const scale = Math.max(Math.hypot(ps[1][0] - ps[0][0], ps[1][1] - ps[0][1]), 1e-9);
  const [u, w] = [1, 2].map((k) => ps[k].map((x, i) => x - ps[0][i]));
  const flat = Math.abs(u[0] * w[1] - u[1] * w[0]), deep = scale * Math.hypot(u[2], w[2]);
  return 0.55 + 0.45 * (flat / Math.max(Math.hypot(flat, deep), 1e-12));
}

function key(viewer: Viewer, { name, tone, ends, kinds }: Legend): string {
  const ink = viewer.isDark ? "#e6ebf3" : "#1b2436", x = 24, y = viewer.camera.height - 64;
  const word = (text: string, at: [number, number], more = "") =>
    `<text x="${at[0]}" y="${at[1]}" fill="${ink}" ${more}>${text.replaceAll("&", "&amp;").replaceAll("<", "&lt;")}</text>`;
  if (kinds) {
    const top = viewer.camera.height - 30 - 20 * Math.min(kinds.length, 12);
    return word(name, [x, top - 12], 'font-weight="600"') + kinds.slice(0, 12).map(([text, hue, many], i) =>
      `<rect x="${x}" y="${top + 20 * i}" width="12" height="12" rx="3" fill="${css(hue)}"/>${word(`${text} ${many}`, [x + 20, top + 20 * i + 11])}`).join("");
  }
  if (!tone) return "";
  const stops = Array.from({ length: 11 }, (_, i) => `<stop offset="${i / 10}" stop-color="${css(colour(tone.scale, i / 10))}"/>`).join("");
  return `<linearGradient id="ramp">${stops}</linearGradient>${word(name, [x, y], 'font-weight="600"')}
    <rect x="${x}" y="${y + 10}" width="220" height="12" rx="6" fill="url(#ramp)"/>${ends.map((text, i) =>
      word(text, [x + 110 * i, y + 39], `text-anchor="${["start", "middle", "end"][i]}"`)).join("")}`;
}
