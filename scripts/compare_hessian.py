#!/usr/bin/env python3
"""Compares `voronaut mesh --metric hessian:F --norm 2` with bamg and mmg2d: the error of linear interpolation of F.

Set up: `apt-get install freefem++` brings bamg as `ffbamg`; `python3 -m venv mmg && mmg/bin/pip install mmgpy` puts
`mmg2d_O3` into mmg/bin. This script itself needs numpy, which mmgpy brings along.

    mmg/bin/python scripts/compare_hessian.py --mmg2d mmg/bin/mmg2d_O3     # the three cases, 2,000 and 10,000 vertices
    ... --cases layers 'exp(-50*(x-y)^2)' --vertices 5000                  # these cases: a name, or a function of x, y
    ... --mmg2d-options='-hgrad 2' --bamg-options='-ratio 2.5' --floor 0.001 # one set of options: much less time

The domain is the unit square. bamg and mmg2d get the metric that is optimal for the L2 norm, factor * det(H)^(-1/6) * H
with H the Hessian by absolute eigenvalues, at the vertices of their last mesh, and adapt from a grid of 100 x 100. That
is what their users take (--density plain); voronaut's own metric, which is sparser at saddles, is tried, too (saddles).
The factor follows voronaut's number of vertices from pass to pass. Of their passes from --passes on (five more) that
meet it within 1 % (if none does, the nearest) the least L2 error counts, and the time of the passes up to it. Each of
--bamg-options and --mmg2d-options (the defaults were best for them) is tried with every --floor, the least eigenvalue
that H may have, and every --density, and the best of all counts: the choice is in the peers' favour. Ratios of sizes are cut off for bamg,
which over some 100 misses whole vertices or never ends on straight fronts (--bamg-aspect).

Errors are of the nodal interpolant on straight triangles and are multiplied by the number of vertices: L2 x N, max x N.
Each triangle is cut into 64 similar ones with the 7-point rule of degree 5; the maximum is over these points and the
corners of the pieces. seconds are of the programs alone. The last lines say in which rows voronaut loses.
"""

import argparse
import itertools
import math
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
CASES = {
    "layers": "0.5*tanh(40*(y-0.5-0.25*sin(2*pi*x))) + exp(-x/0.02)",
    "saddles": "sin(5*x)*sin(7*y)",
    "shock": "tanh(60*(x+y-1.1))",
}
FUNCTIONS = {name: getattr(np, name) for name in "sin cos tan sinh cosh tanh exp log sqrt abs pi e".split()}
PIECES = 8
GRID = 100
COLUMNS = "{:<10} {:<9} {:>7} {:>10} {:>10} {:>8}  {}"


def main():
    typed = options().parse_args()
    print(COLUMNS.format("case", "program", "N", "L2 x N", "max x N", "seconds", "with"))
    lost = []
    with tempfile.TemporaryDirectory() as directory:
        for case in typed.cases:
            for count in typed.vertices:
                lost += compare(typed, case, count, Path(directory))
    print("\n".join(lost) if lost else "voronaut loses nothing")


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", default=list(CASES), help="of " + ", ".join(CASES) + ", or functions")
    parser.add_argument("--vertices", nargs="+", type=int, default=[2000, 10000])
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--bamg", default=shutil.which("ffbamg") or "ffbamg")
    parser.add_argument("--mmg2d", default=shutil.which("mmg2d_O3") or "mmg2d_O3")
    parser.add_argument("--voronaut-options", default="", help="one word: '--smooth-metric 2'")
    parser.add_argument("--bamg-options", nargs="+", default=["-ratio 2.5", "-ratio 3"], help="one word per try")
    parser.add_argument("--bamg-aspect", type=float, default=100, help="greatest ratio of sizes; over it bamg may fail")
    parser.add_argument("--mmg2d-options", nargs="+", default=["-hgrad 2", "-hgrad 3"], help="one word per try")
    parser.add_argument("--mmg2d-aspect", type=float, default=1e6)
    parser.add_argument("--floor", nargs="+", type=float, default=[0.01, 0.0001], help="least eigenvalue of a Hessian")
    parser.add_argument("--density", nargs="+", choices=["plain", "saddles"], default=["plain", "saddles"], help="as in the text above")
    parser.add_argument("--passes", type=int, default=5)
    parser.add_argument("--timeout", type=float, default=120, help="seconds a program may take at a time")
    parser.add_argument("--keep", type=Path, help="directory to copy the meshes to")
    return parser


def compare(typed, case, count, place):
    """One line per program, and what voronaut is worse at."""
    expression = CASES.get(case, case)
    function = compiled(expression)
    ours = voronaut(typed, expression, function, count, place)
    show(typed, case, count, "voronaut", ours)
    if "failed" not in ours:
        count = ours["vertices"]
    lost = []
    for program, step, tries, aspect in (("bamg", bamg, typed.bamg_options, typed.bamg_aspect),
                                         ("mmg2d", mmg2d, typed.mmg2d_options, typed.mmg2d_aspect)):
        runs = [adapted(typed, step, words, lambda points, how=how: metric(function, points, how[0], aspect, how[1]),
                        function, count, place) | {"floor": how[0], "density": how[1]}
                for words in tries for how in itertools.product(typed.floor, typed.density)]
        theirs = min(runs, key=rank)
        show(typed, case, count, program, theirs)
        worse = losses(ours, theirs)
        lost += [f"voronaut loses to {program}: {case}, N {count}: {', '.join(worse)}"] if worse else []
    return lost


def voronaut(typed, expression, function, count, place):
    out = place / "voronaut.mesh"
    command = [typed.voronaut, "mesh", "rect:0,0,1,1", "--metric", f"hessian:{expression}", "--norm", "2", "-n",
               str(count), "-o", str(out), "-q", *typed.voronaut_options.split()]
    begin = time.perf_counter()
    failed = run(command, out, typed.timeout)
    seconds = time.perf_counter() - begin
    if failed:
        return {"failed": failed}
    return figures(function, *read_mesh(out)) | {"seconds": seconds, "mesh": out, "with": typed.voronaut_options}


def adapted(typed, step, words, wanted, function, count, place):
    """The best of a peer's passes whose number of vertices is within 1 % of what is asked for."""
    points, triangles = grid(GRID)
    factor = first_factor(wanted, count)
    best, seconds = {"failed": "no pass"}, 0.0
    for number in range(1, typed.passes + 6):
        write_mesh(place / "in.mesh", points, triangles)
        begin = time.perf_counter()
        out, failed = step(typed, place, factor * wanted(points), words.split())
        seconds += time.perf_counter() - begin
        if failed:
            return best if "l2" in best else {"failed": failed}
        points, triangles = read_mesh(out)
        if number >= typed.passes:
            row = figures(function, points, triangles) | {"wanted": count}
            if rank(row) < rank(best):
                kept = out.replace(place / f"{out.stem}-{len(list(place.iterdir()))}.mesh")
                best = row | {"seconds": seconds, "mesh": kept, "with": f"{words} pass {number}"}
        factor *= (count / len(points)) ** (1 if number < 3 else 1.4)
    return best


def rank(row):
    """Least is best: within 1 % of the vertices wanted, or as near as can be, and then the L2 error."""
    if "failed" in row:
        return math.inf, math.inf
    off = abs(row["vertices"] / row["wanted"] - 1)
    return off if off > 0.01 else 0, row["l2"]


def bamg(typed, place, metrics, words):
    source, sizes, out = place / "in.mesh", place / "in.mtr", place / "bamg.mesh"
    sizes.write_text(f"{len(metrics)} 3\n" + rows(metrics))
    command = [typed.bamg, "-b", str(source), "-M", str(sizes), "-nbv", "1000000", "-o", str(out), *words]
    return out, run(command, out, typed.timeout)


def mmg2d(typed, place, metrics, words):
    source, sizes, out = place / "in.mesh", place / "in.sol", place / "mmg2d.mesh"
    sizes.write_text(f"MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n{len(metrics)}\n1 3\n{rows(metrics)}End\n")
    command = [typed.mmg2d, "-v", "0", "-in", str(source), "-sol", str(sizes), "-out", str(out), *words]
    return out, run(command, out, typed.timeout)


def run(command, out, limit):
    """What went wrong, if anything did. bamg's exit code says nothing: what counts is whether there is a mesh."""
    out.unlink(missing_ok=True)
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=limit)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    return None if out.exists() else (done.stderr.strip() or done.stdout.strip() or "no mesh").splitlines()[-1]


def losses(ours, theirs):
    if "failed" in ours or "failed" in theirs:
        return ["failed"] if "failed" not in theirs else []
    return [f"{name} x N by {100 * (ours[key] / theirs[key] - 1):.1f} %"
            for name, key in (("L2", "l2"), ("max", "max")) if ours[key] > theirs[key]]


def show(typed, case, count, program, row):
    cells = ["-"] * 4 + [row.get("failed", "")]
    if "failed" not in row:
        cells = [row["vertices"], f"{row['l2']:.4f}", f"{row['max']:.3f}", f"{row['seconds']:.1f}", row["with"]]
        cells[-1] += f" floor {row['floor']:g}, {row['density']}" if "floor" in row else ""
        if typed.keep:
            typed.keep.mkdir(parents=True, exist_ok=True)
            shutil.copy(row["mesh"], typed.keep / f"{case}-{count}-{program}.mesh".replace("/", "_"))
    print(COLUMNS.format(case, program, *cells), flush=True)


def compiled(expression):
    """The function of x and y; `^` is a power, as in voronaut's formulas."""
    code = compile(expression.replace("^", "**"), expression, "eval")
    return lambda x, y: eval(code, FUNCTIONS, {"x": x, "y": y}) + 0.0 * (x + y)


def hessians(function, points, step=5e-4):
    """By differences of order 4, some seven digits of them right."""
    first = dict(zip((-2, -1, 1, 2), np.array([1, -8, 8, -1]) / 12))
    second = dict(zip((-2, -1, 0, 1, 2), np.array([-1, 16, -30, 16, -1]) / 12))
    x, y = points.T
    xx = sum(w * function(x + i * step, y) for i, w in second.items())
    yy = sum(w * function(x, y + i * step) for i, w in second.items())
    xy = sum(u * v * function(x + i * step, y + j * step) for i, u in first.items() for j, v in first.items())
    return np.array([[xx, xy], [xy, yy]]).transpose(2, 0, 1) / step**2


def metric(function, points, floor, aspect, density="plain"):
    """det(H)^(-1/6) H at points, H the Hessian by absolute eigenvalues, small ones raised; with the density "saddles" times what
    voronaut multiplies it by, half where the Hessian is that of a saddle."""
    signed, vectors = np.linalg.eigh(hessians(function, points))
    values = np.maximum(np.abs(signed), floor)
    values = np.maximum(values, values.max(axis=1, keepdims=True) / aspect**2)
    bowl = np.prod(signed / values, axis=1, keepdims=True)
    values *= np.prod(values, axis=1, keepdims=True) ** (-1 / 6)
    if density == "saddles":
        values *= np.cbrt((9 * (1 + bowl**2) + 14 * bowl) / 32)
    return np.einsum("nij,nj,nkj->nik", vectors, values, vectors)


def first_factor(wanted, count):
    """A metric of complexity C gives about 2 / sqrt(3) C vertices."""
    points, _ = grid(500)
    complexity = np.sqrt(np.linalg.det(wanted(points))).mean()
    return count * math.sqrt(3) / 2 / complexity


def figures(function, points, triangles):
    count = len(points)
    if len(np.unique(triangles)) != count:
        raise SystemExit("there are vertices without triangles")
    l2, worst = interpolation_error(function, points, triangles)
    return {"vertices": count, "l2": l2 * count, "max": worst * count}


def interpolation_error(function, points, triangles):
    """L2 norm and maximum of the function less its linear interpolant."""
    weights, where = rule()
    where = np.concatenate([where, np.unique(pieces().reshape(-1, 3), axis=0)])
    squares, worst, area = 0.0, 0.0, 0.0
    for some in np.array_split(triangles, len(triangles) // 2000 + 1):
        x, y = points[some].transpose(2, 0, 1)
        areas = 0.5 * np.abs((x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0]))
        wrong = function(x @ where.T, y @ where.T) - function(x, y) @ where.T
        squares += areas @ (wrong[:, :len(weights)] ** 2 @ weights)
        worst = max(worst, np.abs(wrong).max())
        area += areas.sum()
    if abs(area - 1) > 1e-6:
        raise SystemExit(f"the area of the triangles is {area}, not 1")
    return math.sqrt(squares), worst


def rule():
    """Weights (their sum is one) and barycentric points of the 7-point rule of degree 5 on all pieces."""
    weights, where = [9 / 40], [(1 / 3, 1 / 3, 1 / 3)]
    for root in (-math.sqrt(15), math.sqrt(15)):
        a = (6 + root) / 21
        weights += [(155 + root) / 1200] * 3
        where += [(1 - 2 * a, a, a), (a, 1 - 2 * a, a), (a, a, 1 - 2 * a)]
    found = pieces()
    return np.tile(weights, len(found)) / len(found), (np.array(where) @ found).reshape(-1, 3)


def pieces():
    """Corners of the similar triangles that a triangle is cut into, in barycentric coordinates."""
    at = lambda i, j: ((PIECES - i - j) / PIECES, i / PIECES, j / PIECES)
    places = [(i, j) for i in range(PIECES) for j in range(PIECES - i)]
    upright = [(at(i, j), at(i + 1, j), at(i, j + 1)) for i, j in places]
    turned = [(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i, j in places if i + j < PIECES - 1]
    return np.array(upright + turned)


def grid(steps):
    """The unit square in steps x steps cells of two triangles, with diagonals in turns."""
    ticks = np.linspace(0, 1, steps + 1)
    points = np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = np.divmod(np.arange(steps * steps), steps)
    a, b, c, d = (k * (steps + 1) + l for k, l in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
    odd = (i + j) % 2 == 1
    one, two = [np.stack([a, b, np.where(odd, c, d)], axis=1), np.stack([np.where(odd, a, b), c, d], axis=1)]
    return points, np.concatenate([one, two])


def border(points, triangles):
    """Edges of one triangle, each with the number of its side of the square."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, uses = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    edges = edges[first[uses == 1]]
    x, y = points[edges].mean(axis=1).T
    sides = np.argmin(np.abs([y, 1 - x, 1 - y, x]), axis=0) + 1
    return np.column_stack([edges + 1, sides])


def read_mesh(file):
    """Points (x, y) and triangles of a Medit ASCII file of dimension 2 or 3."""
    words = file.read_text().split()
    dimension = int(words[words.index("Dimension") + 1])

    def section(name, width):
        at = words.index(name) + 2
        return np.array(words[at:at + width * int(words[at - 1])], dtype=float).reshape(-1, width)

    return section("Vertices", dimension + 1)[:, :2], section("Triangles", 4)[:, :3].astype(int) - 1


def write_mesh(file, points, triangles):
    edges = border(points, triangles)
    lines = ["MeshVersionFormatted 2", "Dimension 2", "Vertices", str(len(points))]
    lines += [f"{x!r} {y!r} 0" for x, y in points.tolist()] + ["Edges", str(len(edges))]
    lines += [f"{a} {b} {side}" for a, b, side in edges.tolist()] + ["Triangles", str(len(triangles))]
    lines += [f"{a} {b} {c} 1" for a, b, c in (triangles + 1).tolist()] + ["End", ""]
    file.write_text("\n".join(lines))


def rows(metrics):
    return "".join(f"{m[0][0]!r} {m[0][1]!r} {m[1][1]!r}\n" for m in metrics.tolist())


if __name__ == "__main__":
    sys.exit(main())
