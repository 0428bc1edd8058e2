#!/usr/bin/env python3
"""Compares curved quadratic triangles for a function with straight ones: the error of interpolation of F by quadratic polynomials.

    mmg/bin/python scripts/compare_curved.py                                  # three functions, 500 and 2,000 vertices
    ... --cases 'tanh(30*(x+y-1.1))' --vertices 1000 --peers                  # this one, without peers

Set up as for compare_hessian.py, whose cases, passes and metric are used. The domain is the unit square. Rows:

    curved      voronaut mesh --metric hessian:F --order 2
    straight    the same with --polish 0: straight triangles in the metric of third derivatives
    linear      --order 1: the mesh that is best for linear interpolation, raised to order 2
    bamg, mmg2d raised to order 2; the better of the metric of second derivatives and that of third ones, which their users have to bring, of passes
                with as many vertices. (gmsh's mesher for metrics in the plane is bamg.)

Degrees of freedom are vertices and edges. Errors are L2 norms, by a rule of degree 5 on each of 64 parts of a triangle. The ratio is that of the error to the
curved mesh's, at equal degrees of freedom: errors of quadratic interpolation fall as their power -3/2.
"""

import argparse
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import compare_hessian
from compare_hessian import ROOT, adapted, bamg, compiled, metric, mmg2d, read_mesh, rule, run

CASES = {
    "circular front": "tanh(40*(sqrt((x+0.1)^2+(y+0.1)^2)-0.75))",
    "sine front and layer": "0.5*tanh(40*(y-0.5-0.25*sin(2*pi*x)))+exp(-x/0.02)",
    "ring and hyperbola": "tanh(25*(x*y-0.2))+tanh(25*((x-0.4)^2+(y-0.6)^2-0.08))",
}
COLUMNS = "{}  {}  {}  {}  {}  {}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", default=list(CASES), help="of " + ", ".join(CASES) + ", or functions")
    parser.add_argument("--vertices", nargs="+", type=int, default=[500, 2000])
    parser.add_argument("--peers", nargs="*", choices=["bamg", "mmg2d"], default=["bamg", "mmg2d"])
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--bamg", default=shutil.which("ffbamg") or "ffbamg")
    parser.add_argument("--mmg2d", default=shutil.which("mmg2d_O3") or "mmg2d_O3")
    parser.add_argument("--passes", type=int, default=5)
    parser.add_argument("--timeout", type=float, default=120, help="seconds a program may take at a time")
    typed = parser.parse_args()
    print(COLUMNS.format("function", "mesh", "unknowns", "L2 error", "times the curved mesh's", "seconds"))
    with tempfile.TemporaryDirectory() as directory:
        for case in typed.cases:
            for count in typed.vertices:
                compare(typed, case, count, Path(directory))


def compare(typed, case, count, place):
    expression = CASES.get(case, case)
    function = compiled(expression)
    rows = [("curved", *ours(typed, expression, function, count, place, ["--order", "2"])),
            ("straight", *ours(typed, expression, function, count, place, ["--order", "2", "--polish", "0"])),
            ("linear", *ours(typed, expression, function, count, place, []))]
    steps = {"bamg": (bamg, "-ratio 2.5", 100), "mmg2d": (mmg2d, "-hgrad 2", 1e6)}
    # Passes are judged by the error that counts here.
    compare_hessian.figures = lambda function, points, triangles: {
        "vertices": len(points), "l2": error(function, raised(points, triangles))}
    for peer in typed.peers:
        step, words, aspect = steps[peer]
        metrics = [lambda points, of=of: of(function, points, 1e-4, aspect) for of in (metric, metric_of_third_derivatives)]
        found = [adapted(typed, step, words, wanted, function, count, place) for wanted in metrics]
        best = min(found, key=lambda row: row.get("l2", np.inf))
        if "l2" in best:
            points, triangles = read_mesh(best["mesh"])
            rows.append((peer, unknowns(points, triangles), best["l2"], best["seconds"]))
        else:
            rows.append((peer, 0, np.inf, 0.0))
            print(f"{peer}: {best['failed']}", file=sys.stderr)
    _, curved_unknowns, curved_error, _ = rows[0]
    for mesh, number, found, seconds in rows:
        ratio = found / curved_error * (number / curved_unknowns) ** 1.5
        print(COLUMNS.format(f"{case}, {count:,}", mesh, f"{number:,}", f"{found:.2e}", f"{ratio:.1f}", f"{seconds:.1f} s"), flush=True)


def ours(typed, expression, function, count, place, words):
    out = place / "voronaut.mesh"
    begin = time.perf_counter()
    failed = run([typed.voronaut, "mesh", "rect:0,0,1,1", "--metric", f"hessian:{expression}", "-n", str(count), "-o", str(out), "-q", *words],
                 out, typed.timeout)
    seconds = time.perf_counter() - begin
    if failed:
        sys.exit(failed)
    points, triangles = read_mesh(out) if not words[:2] else (None, None)
    nodes = raised(points, triangles) if points is not None else quadratic(out)
    number = unknowns(points, triangles) if points is not None else len(np.unique(nodes.reshape(-1, 2), axis=0))
    return number, error(function, nodes), seconds


def quadratic(file):
    """The nodes of quadratic triangles in a Medit file: corners, then middles of the sides between the first two and so on."""
    words = file.read_text().split()
    dimension = int(words[words.index("Dimension") + 1])

    def section(name, width):
        at = words.index(name) + 2
        return np.array(words[at:at + width * int(words[at - 1])], dtype=float).reshape(-1, width)

    return section("Vertices", dimension + 1)[:, :2][section("TrianglesP2", 7)[:, :6].astype(int) - 1]


def raised(points, triangles):
    corners = points[triangles]
    return np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=1))], axis=1)


def unknowns(points, triangles):
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return len(points) + len(np.unique(np.sort(edges, axis=1), axis=0))


def error(function, nodes):
    """The L2 norm of the function less the polynomials through its values at the nodes, by their maps."""
    weights, where = rule()
    a, b, c = where.T
    values = np.stack([a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a], axis=1)
    # By b and by c, with a = 1 - b - c.
    by_b = np.stack([1 - 4 * a, 4 * b - 1, 0 * a, 4 * (a - b), 4 * c, -4 * c], axis=1)
    by_c = np.stack([1 - 4 * a, 0 * a, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c)], axis=1)
    squares, area = 0.0, 0.0
    for some in np.array_split(nodes, len(nodes) // 500 + 1):
        x, y = values @ some[..., 0].T, values @ some[..., 1].T
        u, v = [[slope @ some[..., i].T for i in (0, 1)] for slope in (by_b, by_c)]
        density = weights[:, None] * 0.5 * np.abs(u[0] * v[1] - u[1] * v[0])
        wrong = function(x, y) - values @ function(some[..., 0], some[..., 1]).T
        squares += (density * wrong**2).sum()
        area += density.sum()
    if abs(area - 1) > 1e-6:
        raise SystemExit(f"the area of the triangles is {area}, not 1")
    return np.sqrt(squares)


def metric_of_third_derivatives(function, points, floor, aspect, step=2e-3):
    """det(Q)^(-1/8) Q at points, Q the tensor of about the least area whose units bound third derivatives in all of 96 directions."""
    angles = np.arange(96) * np.pi / 96
    stencil = dict(zip((-3, -2, -1, 1, 2, 3), np.array([1, -8, 13, -13, 8, -1]) / 8))
    x, y = points.T
    along = lambda c, s: abs(sum(w * function(x + i * step * c, y + i * step * s) for i, w in stencil.items())) / step**3
    sizes = np.stack([along(np.cos(t), np.sin(t)) for t in angles], axis=1) ** (2 / 3)
    first = sizes.argmax(axis=1)
    most = np.maximum(sizes.max(axis=1), floor)
    turn = angles[None] - angles[first][:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = (sizes - most[:, None] * np.cos(turn) ** 2) / np.sin(turn) ** 2
    least = np.maximum(np.where(np.abs(np.sin(turn)) > 0.01, needed, 0).max(axis=1), np.maximum(floor, most / aspect**2))
    e = np.stack([np.cos(angles[first]), np.sin(angles[first])], axis=1)
    across = np.stack([-e[:, 1], e[:, 0]], axis=1)
    found = most[:, None, None] * e[:, :, None] * e[:, None] + least[:, None, None] * across[:, :, None] * across[:, None]
    return found * ((most * least) ** (-1 / 8))[:, None, None]


if __name__ == "__main__":
    sys.exit(main())
