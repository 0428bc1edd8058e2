#!/usr/bin/env python3
"""Compares `voronaut remesh` with mmg2d: one shell script, written for mmg2d, run with both.

Set up: mmg2d comes with the package mmgpy, `python3 -m venv mmg && mmg/bin/pip install mmgpy` puts `mmg2d_O3` into mmg/bin. This
script itself needs nothing but Python.

    scripts/compare_mmg2d.py --mmg2d mmg/bin/mmg2d_O3                     # the inputs that it makes
    scripts/compare_mmg2d.py --mmg2d ... --seed 7                         # other ones, at random
    scripts/compare_mmg2d.py --mmg2d ... in.mesh in.sol -- -hgrad 1.2     # a file with its metric

For every input in.mesh and in.sol are written, and a script `mmg2d_O3 in.mesh -sol in.sol OPTIONS out.mesh`. It is run with mmg2d,
with a directory on PATH in which `mmg2d_O3` calls `voronaut remesh "$@"`, and with `voronaut remesh` written in place of the command;
the two latter must give the same files. Figures are those of `voronaut check OUT --metric in.sol --background in.mesh --h-min --h-max`:
the user's metric within the limits asked for, log-Euclidean between the vertices of in.mesh ("asked"). mmg2d and voronaut both
change it where it jumps (-hgrad), each by its own law; so figures are also taken in the metric graded by voronaut ("graded") and in the
one that mmg2d wrote next to its mesh, its own ("mmg2d's own"). unit_fraction is the share of edges of length in [1/sqrt 2, sqrt 2].
Labels: those of triangles with their areas, those of edges with their lengths, required vertices and edges to the last bit.
A row ends with `loses` and what voronaut is worse at in the metric asked for. The last line counts.
"""

import argparse
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = "#!/bin/sh\nset -e\nmmg2d_O3 in.mesh -sol in.sol {} out.mesh\n"
METRICS = ["asked", "graded", "mmg2d's own"]
FIGURES = ["unit_fraction", "quality_mean", "quality_min"]


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, help="in.mesh and in.sol")
    parser.add_argument("--mmg2d", default=shutil.which("mmg2d_O3") or "mmg2d_O3")
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--seed", type=int, help="inputs with other numbers in them")
    parser.add_argument("--only", help="inputs whose name has this in it")
    parser.add_argument("--json", type=Path, help="write all figures")
    typed = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as directory:
        place = Path(directory)
        typed.path = shim(typed, place)
        rows = []
        for name, mesh, values, words in inputs(typed, options, place):
            if not typed.only or typed.only in name:
                rows.append(compare(typed, name, mesh, values, words, place / name))
    if typed.json:
        typed.json.write_text(json.dumps(rows, indent=1))
    lost = [row for row in rows if row["loses"]]
    print(f"{len(rows)} comparisons, voronaut loses something in {len(lost)}")


def shim(typed, place):
    """A directory in which mmg2d_O3 is voronaut."""
    directory = place / "path"
    directory.mkdir()
    program = directory / "mmg2d_O3"
    program.write_text(f'#!/bin/sh\nexec "{Path(typed.voronaut).resolve()}" remesh "$@"\n')
    program.chmod(0o755)
    return directory


def inputs(typed, options, place):
    """Name, mesh, values and options of every input."""
    if typed.files:
        mesh, values = typed.files
        return [(mesh.stem, read_mesh(mesh), read_values(values), options)]
    chance = random.Random(typed.seed)
    vary = (lambda low, high: chance.uniform(low, high)) if typed.seed is not None else (lambda low, high: (low + high) / 2)
    made = [make(vary) for make in (shock, corner, regions, layers, swirl, jumps, slit)]
    made += [aegean(typed, place, vary, hausd) for hausd in ("0.01", "0.3")]
    return [(name, mesh, values, options or words) for name, mesh, values, words in made]


# What is meshed.

def shock(vary):
    """A square with a curved shock: tensors, thin across it."""
    mesh = grid(40, 40)
    radius, thin = vary(0.6, 0.8), vary(0.003, 0.005)

    def tensor(x, y):
        r = math.hypot(x, y)
        across = min(0.1, math.hypot(thin, 0.2 * (r - radius)))
        return along((x / r, y / r) if r else (1, 0), across, min(0.1, 10 * across))
    return "shock", mesh, [tensor(*p) for p in mesh["points"]], ["-hmin", "0.002", "-hmax", "0.1", "-hgrad", "1.5"]


def corner(vary):
    """An L with sizes that are small at the inner corner."""
    mesh = grid(24, 24, lambda x, y: None if x > 0.5 and y > 0.5 else 1)
    least, slope = vary(0.003, 0.006), vary(0.08, 0.12)
    sizes = [max(least, slope * math.hypot(x - 0.5, y - 0.5)) for x, y in mesh["points"]]
    return "corner", mesh, sizes, ["-hmin", "0.001", "-hmax", "0.05", "-hgrad", "1.3"]


def regions(vary):
    """Two regions with an interface, and labels of all sides and the interface; fine along the interface."""
    mesh = grid(32, 32, lambda x, y: 3 if x < 0.5 else 8)
    on = {"left": (lambda x, y: x == 0, 11), "right": (lambda x, y: x == 1, 12), "foot": (lambda x, y: y == 0, 13),
          "head": (lambda x, y: y == 1, 14), "interface": (lambda x, y: x == 0.5, 15)}
    mesh["edges"] = [(a, b, label) for a, b in edges(mesh) for test, label in on.values()
                     if test(*mesh["points"][a]) and test(*mesh["points"][b])]
    least, wave = vary(0.006, 0.01), vary(2.0, 4.0)

    def tensor(x, y):
        across = min(0.08, least + 0.25 * abs(x - 0.5))
        return along((1, 0), across, min(0.08, (2 + math.sin(wave * y)) * across))
    return "regions", mesh, [tensor(*p) for p in mesh["points"]], ["-hmin", "0.004", "-hmax", "0.07", "-hgrad", "1.4"]


def layers(vary):
    """A disc with a hole, boundary layers along both circles; labels 1 and 2."""
    hole, first = vary(0.25, 0.35), vary(0.002, 0.004)
    radii = [hole + (1 - hole) * t / 24 for t in range(25)]
    mesh = rings(radii, 96)

    def tensor(x, y):
        r = math.hypot(x, y)
        across = min(0.12, first + 0.25 * min(r - hole, 1 - r))
        return along((x / r, y / r), max(across, first), min(0.12, 12 * max(across, first)))
    words = ["-hmin", "0.001", "-hmax", "0.1", "-hausd", "0.001", "-hgrad", "1.5"]
    return "layers", mesh, [tensor(*p) for p in mesh["points"]], words


def aegean(typed, place, vary, hausd):
    """The Aegean sea with some required edges and vertices; sizes that grow with the distance from a point. With 0.01, what -hausd is
    unless told otherwise, every bend of the coast stays; with 0.3 (km) only those that matter at these sizes."""
    file = place / f"aegean{hausd}.mesh"
    choices = ["--metric", "uniform", "-n", "6000", "--hausd", "0.005", "-q", "-o", file]
    run([typed.voronaut, "mesh", ROOT / "data/aegean.geojson", *choices])
    mesh = read_mesh(file)
    mesh["required_points"] = [v for v in range(len(mesh["points"])) if v % 997 == 5]
    mesh["required_edges"] = [e for e in range(len(mesh["edges"])) if e % 50 == 0]
    xs, ys = zip(*mesh["points"])
    centre = (vary(0.3, 0.7), vary(0.3, 0.7))
    at = [min(v) + (max(v) - min(v)) * t for v, t in zip((xs, ys), centre)]
    extent = max(max(xs) - min(xs), max(ys) - min(ys))
    sizes = [extent * (0.004 + 0.04 * math.hypot(x - at[0], y - at[1]) / extent) for x, y in mesh["points"]]
    words = ["-hmin", repr(0.003 * extent), "-hmax", repr(0.03 * extent), "-hausd", hausd, "-hgrad", "1.3"]
    return f"aegean{hausd}", mesh, sizes, words


def swirl(vary):
    """A square around the origin with an anisotropy that turns."""
    mesh = grid(48, 48)
    mesh["points"] = [(2 * x - 1, 2 * y - 1) for x, y in mesh["points"]]
    turns, ratio = vary(2.0, 3.0), vary(6.0, 9.0)

    def tensor(x, y):
        r, angle = math.hypot(x, y), turns * math.hypot(x, y) + math.atan2(y, x)
        stretch = 1 + ratio * r * math.exp(-2 * r)
        return along((math.cos(angle), math.sin(angle)), 0.06 / stretch, 0.06)
    return "swirl", mesh, [tensor(*p) for p in mesh["points"]], ["-hmin", "0.005", "-hmax", "0.1", "-hgrad", "1.4"]


def jumps(vary):
    """Sizes that jump, so that it is the gradation that counts."""
    mesh = grid(40, 40)
    least = vary(0.006, 0.01)
    sizes = [least if math.hypot(x - 0.5, y - 0.5) < 0.1 else 0.2 for x, y in mesh["points"]]
    return "jumps", mesh, sizes, ["-hmin", "0.001", "-hmax", "0.15", "-hgrad", "1.2"]


def slit(vary):
    """A plate with a narrow hole, stretched along it."""
    narrow = vary(0.04, 0.08)
    mesh = grid(40, 40, lambda x, y: None if abs(y - 0.5) < narrow and abs(x - 0.5) < 0.25 else 1)

    def tensor(x, y):
        away = max(abs(x - 0.5) - 0.25, abs(y - 0.5) - narrow, 0.0)
        across = min(0.07, 0.005 + 0.2 * away)
        return along((0, 1), across, min(0.07, 4 * across))
    return "slit", mesh, [tensor(*p) for p in mesh["points"]], ["-hmin", "0.002", "-hmax", "0.06", "-hgrad", "1.4"]


def along(axis, across, other):
    """The tensor m11 m12 m22 with one size along an axis of length one, and the other across it."""
    (x, y), a, b = axis, 1 / across**2, 1 / other**2
    return (b + (a - b) * x * x, (a - b) * x * y, b + (a - b) * y * y)


def grid(columns, rows, label=lambda x, y: 1):
    """The unit square as triangles, where it has a label."""
    points = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * (columns + 1) + i, (j + 1) * (columns + 1) + i
            found = label((i + 0.5) / columns, (j + 0.5) / rows)
            if found is not None:
                halves = [(a, a + 1, b + 1), (a, b + 1, b)] if (i + j) % 2 else [(a, a + 1, b), (a + 1, b + 1, b)]
                triangles += [(*half, found) for half in halves]
    return used({"points": points, "triangles": triangles, "edges": []})


def rings(radii, around):
    """Circles around the origin, joined; the innermost has label 1, the outermost 2."""
    points = [(r * math.cos(t), r * math.sin(t)) for r in radii for t in (2 * math.pi * k / around for k in range(around))]
    number = lambda i, k: i * around + k % around
    triangles, edges = [], []
    for k in range(around):
        edges += [(number(0, k), number(0, k + 1), 1), (number(len(radii) - 1, k), number(len(radii) - 1, k + 1), 2)]
        for i in range(len(radii) - 1):
            a, b, c, d = number(i, k), number(i + 1, k), number(i + 1, k + 1), number(i, k + 1)
            triangles += [(a, b, c, 1), (a, c, d, 1)]
    return {"points": points, "triangles": triangles, "edges": edges}


def used(mesh):
    """Without the vertices that no triangle has."""
    kept = sorted({v for t in mesh["triangles"] for v in t[:3]})
    number = {v: i for i, v in enumerate(kept)}
    triangles = [(*(number[v] for v in t[:3]), t[3]) for t in mesh["triangles"]]
    return {"points": [mesh["points"][v] for v in kept], "triangles": triangles, "edges": []}


def edges(mesh):
    return sorted({tuple(sorted((t[i], t[(i + 1) % 3]))) for t in mesh["triangles"] for i in range(3)})


# How it is compared.

def compare(typed, name, mesh, values, words, place):
    """One line per program and metric, and what voronaut is worse at."""
    place.mkdir()
    write_mesh(place / "in.mesh", mesh)
    write_values(place / "in.sol", values)
    script = place / "adapt.sh"
    script.write_text(SCRIPT.format(" ".join(words)))
    real = str(Path(typed.mmg2d).resolve().parent)
    substituted = place / "substituted.sh"
    substituted.write_text(script.read_text().replace("mmg2d_O3 ", f"{Path(typed.voronaut).resolve()} remesh "))
    seconds = {"mmg2d": shell(script, real, place, "mmg2d"), "voronaut": shell(script, str(typed.path), place, "voronaut")}
    shell(substituted, "", place, "substituted")
    same = (place / "voronaut.mesh").read_bytes() == (place / "substituted.mesh").read_bytes()
    print(f"{name}: mmg2d_O3 in.mesh -sol in.sol {' '.join(words)} out.mesh")
    row = {"input": name, "options": words, "same_by_substitution": same, "input_vertices": len(mesh["points"])}
    for program in ["mmg2d", "voronaut"]:
        out = place / f"{program}.mesh"
        found = {metric: figures(typed, out, metric, words, place) for metric in METRICS}
        row[program] = {"seconds": seconds[program], "faults": faults(mesh, read_mesh(out)), **found}
        for metric, numbers in found.items():
            told = "  ".join(f"{key} {numbers[key]:.4g}" for key in ["vertices", *FIGURES])
            print(f"  {program:9} {metric:12} {told}{'' if numbers['valid'] else '  (not valid: no figures)'}")
        print(f"  {program:9} {seconds[program]:.2f} s, {'; '.join(row[program]['faults']) or 'labels and what is required kept'}")
    better = lambda metric: [key for key in FIGURES if not row["voronaut"][metric][key] > row["mmg2d"][metric][key]]
    row["loses"] = better("asked") + row["voronaut"]["faults"] + ([] if same else ["substituted command: another file"])
    row["loses_graded"], row["loses_in_mmg2d_s_own"] = better("graded"), better("mmg2d's own")
    print(f"    loses: {', '.join(row['loses']) or 'nothing'}; graded: {', '.join(row['loses_graded']) or 'nothing'}; "
          f"in mmg2d's own metric: {', '.join(row['loses_in_mmg2d_s_own']) or 'nothing'}", flush=True)
    return row


def shell(script, path, place, program):
    """Runs a shell script with a directory before the others on PATH, and keeps its files under the program's name. Seconds."""
    begin = time.perf_counter()
    run(["sh", script.name], cwd=place, env=os.environ | {"PATH": f"{path}:{os.environ['PATH']}"})
    seconds = time.perf_counter() - begin
    for ending in ["mesh", "sol"]:
        (place / f"out.{ending}").rename(place / f"{program}.{ending}")
    return seconds


def run(command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")


def figures(typed, out, metric, words, place):
    """What `voronaut check` says of a mesh in a metric."""
    report = place / "report.json"
    option = lambda name: words[words.index(name) + 1] if name in words else None
    own = ["--metric", place / "mmg2d.sol", "--background", place / "mmg2d.mesh"]
    asked = ["--metric", place / "in.sol", "--background", place / "in.mesh"]
    for ours, theirs in [("--h-min", "-hmin"), ("--h-max", "-hmax")]:
        asked += [ours, option(theirs)] if option(theirs) else []
    graded = asked + (["--gradation", option("-hgrad")] if option("-hgrad") else [])
    chosen = {"asked": asked, "graded": graded, "mmg2d's own": own}[metric]
    command = [typed.voronaut, "check", out, *chosen, "-q", "--report", report]
    report.unlink(missing_ok=True)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if not report.exists():
        sys.exit(done.stderr)
    # Of a mesh that is not valid there are no figures.
    read = {"quality": {"mean": 0.0, "min": 0.0}, "metric_edge_length": {"unit_fraction": 0.0}}
    read |= {key: value for key, value in json.loads(report.read_text()).items() if value is not None}
    return {"vertices": read["vertices"], "unit_fraction": read["metric_edge_length"]["unit_fraction"],
            "quality_mean": read["quality"]["mean"], "quality_min": read["quality"]["min"], "valid": read["valid"]}


def faults(given, made):
    """What of labels and of what is required is not there any more."""
    found = []
    for what, measure in {"triangles": areas, "edges": lengths}.items():
        before, after = measure(given), measure(made)
        # Label 0 of edges is that of edges that the input does not list.
        gone = [label for label in before if abs(after.get(label, 0) / before[label] - 1) > 0.02 and label]
        found += [f"label {label} of {what} is not kept" for label in gone]
    points = set(made["points"])
    lost = [v for v in given.get("required_points", []) if given["points"][v] not in points]
    ends = lambda mesh, e: frozenset(mesh["points"][v] for v in mesh["edges"][e][:2])
    there = {ends(made, e) for e in range(len(made["edges"]))}
    gone = [e for e in given.get("required_edges", []) if ends(given, e) not in there]
    found += [f"{len(lost)} required vertices moved"] if lost else []
    return found + ([f"{len(gone)} required edges changed"] if gone else [])


def areas(mesh):
    total = {}
    for a, b, c, label in mesh["triangles"]:
        (ax, ay), (bx, by), (cx, cy) = (mesh["points"][v] for v in (a, b, c))
        total[label] = total.get(label, 0) + abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
    return total


def lengths(mesh):
    total = {}
    for a, b, label in mesh["edges"]:
        total[label] = total.get(label, 0) + math.dist(mesh["points"][a], mesh["points"][b])
    return total


# Files.

def write_mesh(file, mesh):
    lines = ["MeshVersionFormatted 2", "Dimension 2", "Vertices", str(len(mesh["points"]))]
    lines += [f"{x!r} {y!r} 0" for x, y in mesh["points"]]
    for name, rows in {"Edges": mesh["edges"], "Triangles": mesh["triangles"]}.items():
        if rows:
            lines += [name, str(len(rows))]
            lines += [" ".join(str(v + 1) for v in row[:-1]) + f" {row[-1]}" for row in rows]
    for name, key in {"RequiredVertices": "required_points", "RequiredEdges": "required_edges"}.items():
        if mesh.get(key):
            lines += [name, str(len(mesh[key]))] + [str(v + 1) for v in mesh[key]]
    file.write_text("\n".join(lines + ["End", ""]))


def write_values(file, values):
    is_tensor = isinstance(values[0], tuple)
    head = ["MeshVersionFormatted 2", "Dimension 2", "SolAtVertices", str(len(values)), f"1 {3 if is_tensor else 1}"]
    rows = [" ".join(map(repr, value)) for value in values] if is_tensor else [repr(value) for value in values]
    file.write_text("\n".join(head + rows + ["End", ""]))


def read_mesh(file):
    words, mesh = file.read_text().split(), {"points": [], "triangles": [], "edges": []}
    width = {"Vertices": 3, "Edges": 3, "Triangles": 4}
    numbers = {"RequiredVertices": "required_points", "RequiredEdges": "required_edges"}
    i = 0
    while i < len(words):
        name = words[i]
        if name in width:
            size, count = width[name], int(words[i + 1])
            rows = [words[i + 2 + size * k:i + 2 + size * (k + 1)] for k in range(count)]
            if name == "Vertices":
                mesh["points"] = [(float(x), float(y)) for x, y, _ in rows]
            else:
                mesh[name.lower()] = [(*(int(v) - 1 for v in row[:-1]), int(row[-1])) for row in rows]
            i += 2 + size * count
        elif name in numbers:
            count = int(words[i + 1])
            mesh[numbers[name]] = [int(v) - 1 for v in words[i + 2:i + 2 + count]]
            i += 2 + count
        else:
            i += 1
    return mesh


def read_values(file):
    words = file.read_text().split()
    i = words.index("SolAtVertices")
    count, kind = int(words[i + 1]), int(words[i + 3])
    numbers = [float(word) for word in words[i + 4:i + 4 + kind * count]]
    return numbers if kind == 1 else [tuple(numbers[k:k + 3]) for k in range(0, len(numbers), 3)]


if __name__ == "__main__":
    main()
