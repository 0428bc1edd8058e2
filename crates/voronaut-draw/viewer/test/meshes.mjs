// Meshes to measure with: the unit square or most of a torus, their vertices shaken.

/** The text of a Medit file of about so many triangles. */
export function grid(kind, triangles) {
  const n = Math.round(Math.sqrt(triangles / 2)), points = [], corners = [];
  let state = 1;
  const random = () => { state = (Math.imul(state, 1664525) + 1013904223) >>> 0; return state / 2 ** 32 - 0.5; };
  for (let j = 0; j <= n; j++) {
    for (let i = 0; i <= n; i++) {
      const isInside = i > 0 && i < n && j > 0 && j < n;
      const [x, y] = [i, j].map((k) => (k + (isInside ? 0.6 * random() : 0)) / n);
      points.push(kind === "plane" ? `${x} ${y} 0 0` : onTorus(2 * Math.PI * 0.97 * x, 2 * Math.PI * 0.97 * y));
    }
  }
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      const a = j * (n + 1) + i + 1, d = a + n + 1;
      corners.push(...((i + j) % 2 ? [[a, a + 1, d + 1], [a, d + 1, d]] : [[a, a + 1, d], [a + 1, d + 1, d]]));
    }
  }
  const lines = corners.map((t) => `${t.join(" ")} 0`);
  return `MeshVersionFormatted 2\nDimension 3\nVertices\n${points.length}\n${points.join("\n")}\nTriangles\n${lines.length}\n${lines.join("\n")}\nEnd\n`;
}

function onTorus(a, b) {
  const r = 1 + 0.4 * Math.cos(b);
  return `${r * Math.cos(a)} ${r * Math.sin(a)} ${0.4 * Math.sin(b)} 0`;
}
