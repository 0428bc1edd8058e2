// Colours that people with colour-blindness tell apart, too.

export type Rgb = [number, number, number];
export type Scale = "sequential" | "diverging";

const anchors: Record<Scale, string[]> = {
  // Viridis: lightness rises evenly.
  sequential: ["440154", "482878", "3e4989", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"],
  // From blue over a pale middle to orange.
  diverging: ["08407e", "2b74b3", "6ba7d3", "b5d4e9", "f1f0ec", "f8cf9e", "ec9a4c", "c66a12", "7f3b08"],
};

/** Okabe and Ito's hues, softened; then a grey. */
export const KINDS = ["e69f00", "56b4e9", "009e73", "f0e442", "0072b2", "d55e00", "cc79a7", "8a8f98", "c9ced6"].map(rgb);
/** Unit length, boundary, count, turning metric, irregular: as pictures have them. */
export const CAUSE_HUES = ["b9c0cb", "cc3a8e", "1f77d0", "e07b00", "0a8f5a"].map(rgb);
/** Fills of cells, light and dark in turns, and grey for none. */
export const CELL_HUES = ["8fb3e3", "f3dc8f", "7fc4b4", "e9a58b", "b7d98f", "c3a6d8", "9fd3ea", "e7b9c4", "cfd4db"].map(rgb);

export function rgb(hex: string): Rgb {
  return [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)) as Rgb;
}

export function css([r, g, b]: Rgb) { return `rgb(${Math.round(r)},${Math.round(g)},${Math.round(b)})`; }

/** The colour of a scale at a place from 0 to 1. */
export function colour(scale: Scale, t: number): Rgb {
  const list = anchors[scale];
  const at = Math.min(Math.max(t, 0), 1) * (list.length - 1);
  const i = Math.min(Math.floor(at), list.length - 2);
  const [p, q] = [rgb(list[i]), rgb(list[i + 1])];
  return [0, 1, 2].map((k) => p[k] + (at - i) * (q[k] - p[k])) as Rgb;
}

/** 256 texels of a scale. */
export function texels(scale: Scale) {
  return new Uint8Array(Array.from({ length: 256 }, (_, i) => [...colour(scale, i / 255), 255]).flat());
}

/** Texels of kinds. */
export function kindTexels(hues: Rgb[]) {
  return new Uint8Array(Array.from({ length: 256 }, (_, i) => [...hues[i % hues.length], 255]).flat());
}
