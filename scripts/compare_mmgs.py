#!/usr/bin/env python3
"""Compares `voronaut remesh` with mmgs on the same files and options.

Set up: mmgs comes with the package mmgpy, `python3 -m venv mmg && mmg/bin/pip install mmgpy` puts `mmgs_O3` into
mmg/bin. This script itself needs nothing but Python.

    scripts/compare_mmgs.py --mmgs mmg/bin/mmgs_O3                     # data/*.obj and data/parts/*.mesh, and shapes
    scripts/compare_mmgs.py --mmgs ... part.mesh -- -hausd 0.001 -hgrad 1.2 # these files with these options

Files that are not .mesh are written as such first, for mmgs reads no others. Distances are both ways against the file that
both were given (`voronaut check OUT --domain IN`), in its unit. unit_fraction (lengths in [1/sqrt 2, sqrt 2]) is of each
program's edges in one and the same metric: with the options' sizes as a .sol of the input that both get ("given"), and,
of sizes that each makes for itself, in the .sol it wrote next to its mesh ("own"). Corners are counted, ridge length is summed over
Ridges of the output. A row ends with `loses` and what voronaut is worse at. The last line counts.
"""

import argparse
import json
import math
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Options of both programs: what is asked for by the distance, by limits, by one size.
RUNS = [[], ["-hausd", "0.003"], ["-hausd", "0.01", "-hmax", "0.1"], ["-hsiz", "0.06", "-hausd", "0.1"]]
COLUMNS = ["vertices", "valid", "hausdorff", "to_surface", "from_surface", "rms", "unit_given", "unit_own",
           "quality_mean", "quality_min", "corners", "ridge_length", "seconds"]


def main():
    arguments = sys.argv[1:]
    options = []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--mmgs", default=shutil.which("mmgs_O3") or "mmgs_O3")
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--json", type=Path, help="write all figures")
    typed = parser.parse_args(arguments)
    runs = [options] if options else RUNS
    with tempfile.TemporaryDirectory() as directory:
        place = Path(directory)
        inputs = [as_mesh(file, place) for file in typed.files or default_files(place)]
        print("  ".join(["input", "options", "program"] + COLUMNS))
        rows = [compare(typed, file, options, place) for file in inputs for options in runs]
    if typed.json:
        typed.json.write_text(json.dumps(rows, indent=1))
    lost = [row for row in rows if row["loses"]]
    print(f"{len(rows)} comparisons, voronaut loses something in {len(lost)}")


def default_files(place):
    """The project's models and parts, and shapes with exact curvatures."""
    files = sorted((ROOT / "data").glob("*.obj")) + sorted((ROOT / "data/parts").glob("*.mesh"))
    for name, (points, triangles) in {"torus": torus(2.0, 0.7, 96, 40), "cube": cube(6)}.items():
        files.append(place / f"{name}.mesh")
        write_mesh(files[-1], points, triangles)
    return files


def compare(typed, file, options, place):
    """One line per program, and what voronaut is worse at."""
    given = place / "given.sol"
    extent = constant_size(options)
    write_sizes(given, len(sections(file)["Vertices"]), extent)
    rows = {}
    for program, command in {
        "mmgs": [typed.mmgs, "-v", "0", str(file)],
        "voronaut": [typed.voronaut, "remesh", str(file)],
    }.items():
        out = place / f"{program}.mesh"
        for old in (out, out.with_suffix(".sol")):
            old.unlink(missing_ok=True)
        begin = time.perf_counter()
        done = subprocess.run([*command, str(out), *options], capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - begin
        if done.returncode != 0 or not out.exists():
            rows[program] = {"failed": (done.stderr or done.stdout).strip().splitlines()[-1:], "seconds": seconds}
        else:
            rows[program] = figures(typed, file, out, given if extent else None, place) | {"seconds": seconds}
        show(file, options, program, rows[program])
    loses = worse(rows["voronaut"], rows["mmgs"])
    print(f"    loses: {', '.join(loses) or 'nothing'}", flush=True)
    return {"input": file.stem, "options": options, "loses": loses} | rows


def figures(typed, file, out, given, place):
    """What `voronaut check` says of a mesh, and its features."""
    report = check(typed, out, place, ["--domain", str(file)])
    own = check(typed, out, place, ["--metric", str(out.with_suffix(".sol"))])
    strayed = report.get("fidelity") or {}
    found = sections(out)
    to, back = (strayed.get(side, {}) for side in ("mesh_to_surface", "surface_to_mesh"))
    row = {
        "vertices": report["vertices"], "valid": report["valid"],
        "to_surface": to.get("hausdorff"), "from_surface": back.get("hausdorff"),
        "hausdorff": largest([to.get("hausdorff"), back.get("hausdorff")]),
        "rms": root_mean_square([to.get("rms"), back.get("rms")]),
        "unit_own": (own.get("metric_edge_length") or {}).get("unit_fraction"),
        "quality_mean": (own.get("quality") or {}).get("mean"), "quality_min": (own.get("quality") or {}).get("min"),
        "corners": len(found.get("Corners", [])), "ridge_length": ridge_length(found), "unit_given": None,
    }
    if given:
        asked = check(typed, out, place, ["--domain", str(file), "--metric", str(given)])
        row["unit_given"] = (asked.get("metric_edge_length") or {}).get("unit_fraction")
    return row


def check(typed, mesh, place, options):
    report = place / "report.json"
    report.unlink(missing_ok=True)
    command = [typed.voronaut, "check", str(mesh), "-q", "--report", str(report), *options]
    subprocess.run(command, capture_output=True, check=False)
    return json.loads(report.read_text()) if report.exists() else {"vertices": None, "valid": None}


def worse(ours, theirs):
    """Where voronaut's figure is worse than mmgs's; a figure that one of them lacks is not compared."""
    if "failed" in ours:
        return ["failed"] if "failed" not in theirs else []
    smaller = ["hausdorff", "rms"]
    larger = ["valid", "unit_given", "unit_own", "quality_mean", "quality_min", "corners"]
    both = lambda name: ours.get(name) is not None and theirs.get(name) is not None
    margin = 1e-9
    lost = [name for name in smaller if both(name) and ours[name] > theirs[name] * (1 + margin) + 1e-12]
    lost += [name for name in larger if both(name) and ours[name] < theirs[name] * (1 - margin)]
    if both("ridge_length") and ours["ridge_length"] < 0.999 * theirs["ridge_length"]:
        lost.append("ridge_length")
    return lost


def show(file, options, program, row):
    told = lambda value: "-" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)
    cells = [row["failed"]] if "failed" in row else [told(row.get(name)) for name in COLUMNS]
    print("  ".join([file.stem, " ".join(options) or "(defaults)", program, *map(str, cells)]))


def constant_size(options):
    return float(options[options.index("-hsiz") + 1]) if "-hsiz" in options else None


def largest(values):
    found = [value for value in values if value is not None]
    return max(found) if found else None


def root_mean_square(values):
    found = [value for value in values if value is not None]
    return math.sqrt(sum(value * value for value in found) / len(found)) if found else None


def ridge_length(found):
    edges, points = found.get("Edges", []), found.get("Vertices", [])
    at = lambda v: [float(x) for x in points[int(v) - 1][:3]]
    return sum(math.dist(*(at(v) for v in edges[int(number[0]) - 1][:2])) for number in found.get("Ridges", []))


def sections(file):
    """The sections of a .mesh file that have a row per line, as lists of rows of words."""
    width = {"Vertices": 4, "Edges": 3, "Triangles": 4, "Corners": 1, "Ridges": 1, "RequiredVertices": 1,
             "RequiredEdges": 1, "RequiredTriangles": 1, "Normals": 3, "NormalAtVertices": 2, "Tangents": 3,
             "TangentAtVertices": 2}
    words = file.read_text().split()
    found, i = {}, 0
    while i < len(words):
        size = width.get(words[i])
        if size is None:
            i += 1
            continue
        name, count = words[i], int(words[i + 1])
        rows = words[i + 2:i + 2 + size * count]
        found[name] = [rows[k:k + size] for k in range(0, len(rows), size)]
        i += 2 + size * count
    return found


def as_mesh(file, place):
    """The file, or a .mesh of the same triangles if it is an .obj."""
    if file.suffix == ".mesh":
        return file
    rows = [line.split() for line in file.read_text().splitlines() if line.strip()]
    points = [[float(x) for x in row[1:4]] for row in rows if row[0] == "v"]
    faces = [[int(word.split("/")[0]) - 1 for word in row[1:]] for row in rows if row[0] == "f"]
    out = place / f"{file.stem}.mesh"
    write_mesh(out, points, [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)])
    return out


def write_mesh(file, points, triangles):
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
    lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in points] + ["Triangles", str(len(triangles))]
    lines += [f"{a + 1} {b + 1} {c + 1} 1" for a, b, c in triangles] + ["End", ""]
    file.write_text("\n".join(lines))


def write_sizes(file, count, size):
    if size is not None:
        head = ["MeshVersionFormatted 2", "Dimension 3", "SolAtVertices", str(count), "1 1"]
        file.write_text("\n".join(head + [repr(size)] * count + ["End", ""]))


def torus(ring, tube, long, short):
    def at(i, j):
        u, v = 2 * math.pi * i / long, 2 * math.pi * j / short
        r = ring + tube * math.cos(v)
        return r * math.cos(u), r * math.sin(u), tube * math.sin(v)
    number = lambda i, j: i % long * short + j % short
    cells = [(i, j) for i in range(long) for j in range(short)]
    halves = lambda i, j: [(number(i, j), number(i + 1, j), number(i + 1, j + 1)),
                           (number(i, j), number(i + 1, j + 1), number(i, j + 1))]
    return [at(i, j) for i, j in cells], [half for cell in cells for half in halves(*cell)]


def cube(steps):
    """The unit cube, each face a grid."""
    numbers, points, triangles = {}, [], []

    def number(p):
        if p not in numbers:
            numbers[p] = len(points)
            points.append(tuple(x / steps for x in p))
        return numbers[p]

    for axis in range(3):
        for side in (0, steps):
            for i in range(steps):
                for j in range(steps):
                    def corner(a, b):
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, i + a, j + b
                        return number(tuple(p))
                    a, b, c, d = corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)
                    triangles += [(a, b, c), (a, c, d)] if side else [(a, c, b), (a, d, c)]
    return points, triangles


if __name__ == "__main__":
    main()
