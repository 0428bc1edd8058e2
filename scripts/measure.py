#!/usr/bin/env python3
"""Measures every figure that README.md and docs/ state, and compares.

    scripts/measure.py                  # all tables, compared with what the documents say
    scripts/measure.py jobs surfaces    # these tables
    scripts/measure.py --write jobs     # put what was measured into the documents
    scripts/measure.py --list           # the tables, and the documents that have them

In a document a table stands between <!-- measured: NAME --> and <!-- end -->. It agrees where its words are the same and its numbers
differ by no more than 2 % or one unit of their last digit; times (columns of seconds and the like) by no more than --times, a factor
of three or 0.2 s: machines are noisy; how often other programs fail, by no more than three: not every run of theirs is the same.
Meshes are the same to the bit whatever the number of threads and the machine.

docs/benchmark.md is compared, too, but written by scripts/benchmark.py alone.

Tables of peers need ffbamg (apt: freefem++), mmg2d_O3 and mmgs_O3 (pip: mmgpy, which brings the numpy that is needed) on the PATH;
that of pages chromium, node and npm; that of parts scipy, mpi4py and mpich (pip), and `maturin develop --release`; without these they are
skipped, and said to be. The exit code is 1 where anything differs.
"""

import argparse
import functools
import importlib.util
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VORONAUT = ROOT / "target/release/voronaut"
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BEGIN, END = "<!-- measured: {} -->", "<!-- end -->"
MARKED = re.compile(r"<!-- measured: (\S+) -->\n(.*?)<!-- end -->", re.DOTALL)
NUMBER = re.compile(r"\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?")
NOISE = 0.02
FAILS_OF_OTHERS = re.compile(r"^(?!voronaut)\S+ fails$")
MORE_FAILS = 3
# And what else is of the machine.
IS_TIME = re.compile(r"\b(s|ns|ms|second|seconds|microseconds|multiple|peak)\b")

AEGEAN = "data/aegean.geojson --metric boundary:h0=0.5,growth=1.2,aspect=4,h_max=30 -n 20000"
MILD, HARD, SHARP = (f"rect:-1,-1,1,1 --metric shock:phi={phi}" for phi in ("1,lambda=0.6", "10,lambda=0.06", "10,lambda=0.6"))
SWIRL, PRINTED = (f"rect:-2,-2,2,2 --metric swirl{which}" for which in ("", ":field=printed"))
LAYERS = "0.5*tanh(40*(y-0.5-0.25*sin(2*pi*x))) + exp(-x/0.02)"
SPOT = "data/spot.obj --metric curvature -n 1020"
SPHERE = "sphere:1 --metric shock -n 1020"
BRACKET = "data/parts/bracket_cad.mesh --metric {} -n 2000"
TABLES = {}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", help="all, unless told otherwise")
    parser.add_argument("--write", action="store_true", help="into the documents, in place of a comparison")
    parser.add_argument("--times", type=float, default=3.0, help="the factor by which times may differ")
    parser.add_argument("--list", action="store_true")
    typed = parser.parse_args()
    stated = {}
    for document in DOCUMENTS:
        for name, text in MARKED.findall(document.read_text()):
            stated.setdefault(name, []).append((document, text))
    if typed.list:
        return print("\n".join(f"{name}: {', '.join(str(d.relative_to(ROOT)) for d, _ in stated.get(name, []))}" for name in TABLES))
    if set(stated) != set(TABLES):
        sys.exit(f"documents and this script differ in tables: {sorted(set(stated) ^ set(TABLES))}")
    subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "voronaut-cli"], cwd=ROOT, check=True)
    # What pip puts on the PATH starts a Python first.
    if mmg := importlib.util.find_spec("mmgpy"):
        inside = [str(Path(folder, "bin")) for folder in mmg.submodule_search_locations]
        os.environ["PATH"] = os.pathsep.join([*inside, os.environ["PATH"]])
    figures = different = 0
    for name in typed.tables or TABLES:
        measure, programs = TABLES[name]
        missing = [program for program in programs if not shutil.which(program)]
        if missing:
            print(f"== {name}: skipped, for {', '.join(missing)} is not on the PATH", flush=True)
            continue
        rows = measure()
        print(f"== {name}\n{markdown(rows)}", flush=True)
        for document, text in stated[name]:
            if typed.write and not name.startswith("benchmark-"):
                whole = document.read_text()
                begin = BEGIN.format(name)
                document.write_text(whole.replace(f"{begin}\n{text}{END}", f"{begin}\n{markdown(rows)}{END}"))
                continue
            count, faults = compared(cells(text), rows, typed.times)
            figures, different = figures + count, different + len(faults)
            print("".join(f"{document.name}: {fault}\n" for fault in faults), end="", flush=True)
    if not typed.write:
        print(f"{figures} figures compared, {different} differ by more than noise")
    sys.exit(different > 0)


def table(*programs):
    """Registers a function that measures the rows of a table, its heading first, with the peers that it runs."""
    def register(measure):
        TABLES[measure.__name__.replace("_", "-")] = (measure, programs)
        return measure
    return register


# Tables as text

def markdown(rows):
    lines = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]]) + "\n"


def cells(text):
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[:1] + lines[2:]]


def compared(said, rows, times):
    """How many figures there are, and which differ by more than noise."""
    if [len(row) for row in said] != [len(row) for row in rows]:
        return 0, ["has other rows or columns"]
    count, faults = 0, []
    for old, new in zip(said[1:], rows[1:]):
        for heading, a, b in zip(rows[0], old, new):
            count += len(NUMBER.findall(b))
            if FAILS_OF_OTHERS.search(heading):
                differ = abs(int(a) - int(b)) > MORE_FAILS
            else:
                differ = not agree(a, b, times if IS_TIME.search(heading) or b.endswith(" s") else None)
            if differ:
                faults.append(f"{new[0]}, {heading}: {a} is stated, {b} measured")
    return count, faults


def agree(said, measured, times):
    if NUMBER.sub("#", said) != NUMBER.sub("#", measured):
        return False
    for a, b in zip(NUMBER.findall(said), NUMBER.findall(measured)):
        x, y = (float(number.replace(",", "")) for number in (a, b))
        digit = 10.0 ** -len(a.partition(".")[2]) if "e" not in a else 0.1 * x
        if times and abs(x - y) > 0.2 and not x / times <= y <= x * times:
            return False
        if not times and abs(x - y) > 1.01 * max(digit if "." in a else 0, NOISE * abs(x)):
            return False
    return True


def number(value, digits):
    return "-" if value is None else f"{value:,.{digits}f}"


def percent(share, digits=1):
    return f"{100 * share:.{digits}f} %"


def seconds(value):
    return f"{value:.1f} s" if value < 10 else f"{value:.0f} s"


def pair(quality, digits=3):
    return f"{quality['mean']:.{digits}f} / {quality['min']:.{digits}f}"


# Running things

def run(*words, check=True):
    done = subprocess.run([str(word) for word in words], cwd=ROOT, capture_output=True, text=True, check=False)
    if check and done.returncode:
        sys.exit(f"{' '.join(map(str, words))}: {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


@functools.cache
def report(words):
    """The report of a command of voronaut, and the seeds that its mesh has as vertices."""
    with tempfile.TemporaryDirectory() as folder:
        out = ["-o", f"{folder}/out.mesh"] if not words.startswith("check") else []
        run(VORONAUT, *split(words), *out, "--report", f"{folder}/run.json", "-q")
        return json.loads(Path(folder, "run.json").read_text())


@functools.cache
def kept(words):
    """A mesh that stays until the end, and its vertices as seeds."""
    place = Path(KEPT.name) / str(len(list(Path(KEPT.name).iterdir())))
    mesh, seeds = place.with_suffix(".mesh"), place.with_suffix(".txt")
    run(VORONAUT, *split(words), "-o", mesh, "-q")
    lines = mesh.read_text().splitlines()
    at = lines.index("Vertices") + 2
    seeds.write_text("".join(" ".join(line.split()[:2]) + "\n" for line in lines[at:at + int(lines[at - 1])]))
    return mesh, seeds


KEPT = tempfile.TemporaryDirectory()


def split(words):
    """Words as the shell has them, with quotes."""
    return [a or b for a, b in re.findall(r"'([^']*)'|(\S+)", words)]


def tests(name, *suite):
    return run("cargo", "test", "--quiet", "-p", "voronaut", *suite, name, "--", "--nocapture", "--test-threads", "1")


# Meshes

@table()
def jobs():
    """What README has."""
    rows = [["domain and metric", "vertices", "seconds", "unit edges", "off the boundary", "quality, mean / min"]]
    planar = [(f"`{words.replace(' --metric ', '`, `')}`", f"{words} -n 4000") for words in (MILD, HARD, PRINTED)]
    surfaces = [("`data/spot.obj`, `curvature`", SPOT), ("`data/parts/bracket_cad.mesh`, `curvature`", BRACKET.format("curvature")),
                ("`sphere:1`, `shock`", SPHERE)]
    for name, words in [("Aegean as above", AEGEAN), *planar, *surfaces]:
        found = report(f"mesh {words}")
        rows.append([name, *meshed(found), percent(found["interior_edge_length"]["unit_fraction"]), pair(found["quality"])])
    return rows


def meshed(found):
    if not found["valid"]:
        sys.exit("an invalid mesh")
    return [number(found["vertices"], 0), seconds(found["seconds"]["total"]), percent(found["metric_edge_length"]["unit_fraction"])]


@table()
def efforts():
    """What `--effort` costs and gives."""
    rows = [["", "effort", "steps", "seconds", "unit edges", "quality, mean / min", "L2 error N"]]
    layers = f"rect:0,0,1,1 --metric 'hessian:{LAYERS}' -n 10000"
    for name, words in [("mild shock, 4,000", f"{MILD} -n 4000"), ("swirl, 4,000", f"{SWIRL} -n 4000"),
                        ("front and layer, 10,000", layers), ("SPOT, 1,020", SPOT)]:
        for effort in ("fast", "normal", "best"):
            found = report(f"mesh {words} --effort {effort}")
            error = found.get("interpolation")
            rows.append([name, f"`{effort}`", str(len(found["relaxation"]["energy"]) - 1), *meshed(found)[1:], pair(found["quality"]),
                         number(10000 * error["norm"], 3) if error else ""])
    return rows


@table()
def unmet():
    causes = ["boundary", "count", "turning", "irregular"]
    rows = [["", "edges not met", *causes]]
    for name, words in [("mild shock", f"{MILD} -n 4000"), ("hard shock", f"{HARD} -n 4000"), ("printed swirl", f"{PRINTED} -n 4000"),
                        ("Aegean, `boundary:h0=2,growth=1.3`, 20,000", "data/aegean.geojson --metric boundary:h0=2,growth=1.3 -n 20000"),
                        ("`sphere:1`, `shock`, 1,020", SPHERE)]:
        found = report(f"mesh {words}")["unmet"]
        rows.append([name, percent(found["share"]), *(percent(found["by_cause"][cause]["share"]) for cause in causes)])
    return rows


@table()
def straight_and_geodesic():
    rows = [["", "straight: mean length, unit edges", "geodesic: mean length, unit edges", "deviation of angles, straight, geodesic",
             "edges, geodesics not found, on the border"]]
    for name, words in [("mild shock, 4,000", f"{MILD} -n 4000"), ("swirl, 320", f"{SWIRL} -n 320"),
                        ("Aegean, 2,000", AEGEAN.replace("20000", "2000 --hausd 2"))]:
        with tempfile.TemporaryDirectory() as folder:
            found = report(f"mesh {words} --histograms {folder}/h.svg")["histograms"]
        lengths, angles = found["edge_length"], found["angle"]
        means = (f"{lengths['mean'][kind]:.3f}, {percent(found['unit_fraction'][kind])}" for kind in ("straight", "geodesic"))
        rows.append([name, *means,
                     f"{angles['std']['straight']:.1f}, {angles['std']['geodesic']:.1f}",
                     f"{sum(lengths['straight']):,}, {found['geodesics_not_found']:,}, {found['geodesics_on_border']:,}"])
    return rows


@table()
def functions():
    rows = [["vertices", "L2 error N", "the metric's own mesh", "greatest error N", "seconds"]]
    for count in (500, 1000, 2000, 4000, 10000, 20000, 50000, 100000):
        words = f"mesh rect:0,0,1,1 --metric 'hessian:{LAYERS}' -n {count}"
        found, plain = report(words), report(f"{words} --polish 0")
        error, own = found["interpolation"], plain["interpolation"]
        rows.append([number(count, 0), number(count * error["norm"], 3), number(count * own["norm"], 3),
                     number(count * error["max"]["value"], 1), seconds(found["seconds"]["total"])])
    return rows


@table()
def star_set():
    rows = [["mesh", "vertices", "unit edges", "mean length"]]
    words = f"mesh {MILD} --complexity 3464"
    scale = report(f"{words} --mesher starset")["metric_scale"]
    others = [(f"`-n {n}`", f"mesh {MILD} -n {n}") for n in (2200, 4161, 6027, 8100)]
    for name, words in [("`--complexity 3464 --mesher starset`", f"{words} --mesher starset"), *others]:
        mesh, _ = kept(words)
        found = report(f"check {mesh} {MILD.replace('rect:-1,-1,1,1 ', '')} --metric-scale {scale}")
        lengths = found["metric_edge_length"]
        rows.append([name, number(found["vertices"], 0), percent(lengths["unit_fraction"]), number(lengths["mean"], 2)])
    return rows


@table()
def curved():
    """Order 1 at the same factor on the metric as the others: that which the number of vertices asks for in closed form."""
    rows = [["", "order", "vertices", "seconds", "unit edges", "quality, mean / min"]]
    for name, words in [("printed swirl", PRINTED), ("shock, lambda = 0.6", SHARP), ("shock, lambda = 0.06", HARD)]:
        straight = report(f"mesh {words} -n 4010")
        count, time, _ = meshed(straight)
        rows.append([name, "1", count, time, percent(straight["closed_form"]["unit_fraction"]), "-"])
        for order in (2, 3):
            found = report(f"mesh {words} -n 4010 --order {order}")
            rows.append([name, str(order), *meshed(found), pair(found["quality"])])
    return rows


@table()
def curved_surfaces():
    rows = [["", "order", "vertices", "seconds", "distance, root mean square", "greatest"]]
    for domain in ("sphere:1", "torus:1,0.4"):
        for order in (1, 2, 3):
            for count in (250, 1000, 4000):
                words = f"mesh {domain} --metric uniform -n {count} --order {order}"
                found, (mesh, _) = report(words), kept(words)
                away = report(f"check {mesh} --domain {domain}")["fidelity"]
                away = away.get("curved", away["mesh_to_surface"])
                rows.append([domain, str(order), *meshed(found)[:2], f"{away['rms']:.1e}", f"{away['hausdorff']:.1e}"])
    return rows


@table()
def centroids():
    steps = [0, 1, 5, 20, 100]
    rows = [["energy of 320 seeds after so many steps", *map(str, steps)]]
    for name, words in (("mild shock", MILD), ("phi = 10", SHARP)):
        for which in ("canvas", "weighted"):
            energy = report(f"mesh {words} -n 320 --lloyd 100 --effort best --centroid {which}")["relaxation"]["energy"]
            rows.append([f"{name}, `--centroid {which}`", *(f"{energy[min(step, len(energy) - 1)]:.4g}" for step in steps)])
    return rows


@table()
def protection():
    rows = [["`--seeding protected -n 2000`", "delta / epsilon", "unprotected before, after", "moves", "raw nerve: missing, extra", "s"]]
    for name, words in (("uniform", "rect:-1,-1,1,1 --metric uniform"), ("mild shock", MILD), ("swirl", SWIRL)):
        found = report(f"mesh {words} -n 2000 --seeding protected")
        said = found["protection"]
        rows.append([name, number(found["net"]["delta_over_epsilon"], 3), f"{said['unprotected_before']}, {said['unprotected']}",
                     number(said["moves"], 0), f"{said['raw_nerve']['missing']}, {said['raw_nerve']['extra']}",
                     seconds(found["seconds"]["total"])])
    return rows


@table()
def surfaces():
    rows = [["surface and metric", "vertices", "seconds", "unit edges", "quality, mean / min",
             "distance, root mean square and greatest, in diagonals"]]
    for words in (SPOT, f"{SPOT} --fit",
                  "data/bob_small.obj --metric curvature -n 1020", "chair --metric curvature -n 1020", SPHERE, BRACKET.format("uniform"),
                  BRACKET.format("curvature"), "data/parts/patch.mesh --metric curvature -n 2000"):
        found, (mesh, _) = report(f"mesh {words}"), kept(f"mesh {words}")
        distance = report(f"check {mesh} --domain {words.split()[0]}")["fidelity"]
        distances = f"{distance['rms_share']:.1e}, {distance['hausdorff_share']:.1e}"
        rows.append([f"`{words}`", *meshed(found), pair(found["quality"]), distances])
    return rows


@table()
def starts():
    rows = [["SPOT, curvature, 2,000", "seconds", "unit edges", "mean quality"]]
    for name, more in (("its own triangles", ""), ("a canvas (`--seeding farthest --dual canvas`)", " --seeding farthest --dual canvas")):
        found = report(f"mesh data/spot.obj --metric curvature -n 2000{more}")
        rows.append([name, *meshed(found)[1:], number(found["quality"]["mean"], 3)])
    return rows


# Diagrams, duals and distances

@table()
def canvases():
    rows = [["canvas", "vertices", "canvas, s", "diagram, s", "dual, s", "geodesics, s"]]
    _, seeds = kept(f"mesh {SWIRL} -n 4010")
    for canvas in ("isotropic --canvas-size 322", "starset --canvas-size 30", "intrinsic --canvas-size 30"):
        found = report(f"dual {SWIRL} --seeds {seeds} --canvas {canvas} --edges geodesic")
        rows.append([f"`--canvas {canvas}`", number(found["canvas"]["vertices"], 0),
                     *(seconds(found["seconds"][stage]) for stage in ("canvas", "diagram", "dual", "geodesics"))])
    return rows


@table()
def roads():
    rows = [["seeds", "triangles", "`geodesic` and `canvas` differ", "`both` and `canvas`", "`both` and `geodesic`"]]
    for name, words in (("mild shock", MILD), ("swirl", SWIRL), ("phi = 10", SHARP)):
        _, seeds = kept(f"mesh {words} -n 1000")
        geodesic, canvas, both = (triangles(kept(f"dual {words} --seeds {seeds} --dual {road}")[0])
                                  for road in ("geodesic", "canvas", "both"))
        pairs = ((geodesic, canvas), (both, canvas), (both, geodesic))
        rows.append([f"{name}, 1,000", number(len(both), 0), *(number(len(a - b), 0) for a, b in pairs)])
    return rows


def triangles(mesh):
    lines = mesh.read_text().splitlines()
    at = lines.index("Triangles") + 2
    return {tuple(sorted(line.split()[:3])) for line in lines[at:at + int(lines[at - 1])]}


@table()
def levels():
    names = ["tensor", "expansions", "4 modes", "8", "16", "circumcentre, 8", "16"]
    rows = [["", "tests", *names, "microseconds a test"]]
    for name, words in (("mild shock", MILD), ("swirl", SWIRL)):
        for count in (4000, 40000):
            _, seeds = kept(f"mesh {words} -n {count} --lloyd 0")
            found = report(f"dual {words} --seeds {seeds} --dual geodesic")
            each = found["dual"]["geodesic_tests"]
            rows.append([f"{name}, {count:,}", number(sum(each), 0), *(percent(n / sum(each)) for n in each),
                         number(1e6 * found["seconds"]["tests"] / sum(each), 1)])
    return rows


@table()
def closed_forms():
    rows = [["metric", "seeds", "interior triangles", "wrong", "margins off by more than their error", "wrong signs"]]
    form = (r"(\w[\w :-]*): (\d+) seeds, Outcome \{ interior: (\d+), wrong: (\d+), wrong_clear: \d+, edges: \d+, "
            r"dishonest: (\d+), wrong_sign: (\d+)")
    found = [match for match in re.findall(form, tests("tests::rdt::", "--lib")) if int(match[1]) > 3000]
    return rows + sorted([name, *(number(int(n), 0) for n in figures)] for name, *figures in found)


@table()
def methods():
    """As the bench prints it, the metric before the canvas."""
    rows, metric = [], ""
    for line in run("cargo", "bench", "--quiet", "-p", "voronaut", "--bench", "methods", "--", "--vertices", "10201").splitlines():
        metric = line.strip("*") if line.startswith("*") else metric
        if line.startswith("|") and not line.startswith("|-"):
            row = [cell.strip() for cell in line.strip("|").split("|")]
            rows += [["metric", *row]] if not rows else [] if row[0] == "canvas" else [[metric, *row]]
    return rows


@table()
def surface_methods():
    """Greatest and mean errors on 16,000 canvas vertices, a column for each method."""
    found = {}
    form = r"(\w[\w ]*), (\w+) \[\d+, \d+\], (\w+): \[\[.*\], \[(.*), (.*)\]\]"
    for surface, canvas, method, *errors in re.findall(form, tests("geodesics::surfaces", "--lib")):
        found.setdefault((surface, canvas), {})[method] = ", ".join(f"{100 * float(error):.2f} %" for error in errors)
    columns = list(next(iter(found.values())))
    return [["surface", "canvas", *columns], *([*place, *(errors[method] for method in columns)] for place, errors in found.items())]


@table()
def surface_duals():
    rows = [["sphere, against the convex hull of the seeds", "canvas vertices a seed", "wrong triangles"]]
    found = re.findall(r"^(\d+) seeds, (\d+) canvas vertices each: (\d+) wrong", tests("surfaces::sphere", "--lib"), re.MULTILINE)
    found = sorted(set(found), key=lambda row: [int(n) for n in row])
    return rows + [[f"{int(count):,} seeds", each, wrong] for count, each, wrong in found]


@table()
def orphans():
    rows = []
    for metric in ("swirl", "shock:phi=1,lambda=0.6", "shock:phi=10,lambda=0.6"):
        printed = run("cargo", "run", "--quiet", "--release", "-p", "voronaut", "--example", "orphans", "--", "table", metric, 1000, 4000)
        found = cells(printed)
        rows += found[:1] * (not rows) + found[1:]
    return rows


@table()
def certificates():
    rows = [["`--protection`", "delta / epsilon", "canvas vertices asked for"]]
    for asked in ("0.2", "0.6"):
        _, seeds = kept(f"mesh rect:0,0,1,1 --metric uniform -n 1500 --seeding protected --protection {asked}")
        found = report(f"dual rect:0,0,1,1 --metric uniform --seeds {seeds} --certify")["certificate"]
        rows.append([asked, number(found["delta"] / found["epsilon"], 2), f"{found['asked_canvas']['intrinsic']:.1e}"])
    found = report(f"dual rect:0,0,1,1 --metric uniform --seeds {seeds} --certify --canvas-size certified")
    holding = sum(verdict["outcome"] == "holds" for verdict in found["certificate"]["verdicts"])
    return rows + [[f"0.6, `--canvas-size certified`: {holding} verdicts hold", rows[-1][1], f"{found['canvas']['vertices']:.1e}"]]


# Files and solutions

@table()
def formats():
    rows = [["format", "MB", "write, s", "read, s"]]
    for line in run("cargo", "bench", "--quiet", "-p", "voronaut-io", "--bench", "formats").splitlines()[2:]:
        words = re.fullmatch(r"\s*(\..*?)\s+([\d.]+)\s+([\d.]+)\s+\d+\s+([\d.]+)\s+\d+", line)
        rows += [list(words.groups())] if words else []
    return rows


@table()
def transfer():
    rows = [["function, times", "method", "L2 error", "over", "drift"]]
    form = r"(\w+) +1600 x(\d+) +(\w+) +(\S+) +(\S+) +(\S+) +\S+"
    for function, times, method, error, *small in re.findall(form, run("cargo", "bench", "--quiet", "-p", "voronaut", "--bench", "transfer")):
        name = "`conservative --overshoot`" if method == "overshooting" else f"`{method}`"
        rows.append([f"{function}, {times}", name, error, *("0" if abs(float(it)) < 1e-12 else it for it in small)])
    return rows


# Peers

@table("ffbamg", "mmg2d_O3")
def outlines():
    words = ["outlines", "-n", 100, "--peers", "ffbamg", "mmg2d_O3"]
    return cells(run(sys.executable, ROOT / "scripts/campaign.py", *words, check=False))


@table("ffbamg", "mmg2d_O3")
def peers_on_functions():
    rows = [["function, vertices", "voronaut: L2, greatest error N", "bamg", "mmg2d"]]
    for case, name, counts in (("layers", "front and layer", [2000, 10000]), ("saddles", "sin 5x sin 7y", [2000]),
                               ("shock", "tanh 60(x + y - 1.1)", [2000])):
        for count in counts:
            printed = run(sys.executable, ROOT / "scripts/compare_hessian.py", "--cases", case, "--vertices", count)
            best = [line.split()[3:5] for line in printed.splitlines()[1:4]]
            rows.append([f"{name}, {count:,}", *(", ".join(errors) for errors in best)])
    return rows


@table("ffbamg", "mmg2d_O3")
def curved_functions():
    printed = run(sys.executable, ROOT / "scripts/compare_curved.py")
    return [line.split("  ") for line in printed.splitlines()]


@table("mmgs_O3")
def surface_functions():
    printed = run(sys.executable, ROOT / "scripts/compare_surface_hessian.py")
    return [line.split("  ") for line in printed.splitlines()]


@table("mmg2d_O3")
def mmg2d():
    return remeshed("compare_mmg2d.py", "mmg2d", lambda row: row["asked"], [])


@table("mmgs_O3")
def mmgs():
    parts = [ROOT / name for name in ("data/spot.obj", "data/bob_small.obj", "data/parts/bracket_cad.mesh", "data/parts/patch.mesh")]
    return remeshed("compare_mmgs.py", "mmgs", lambda row: row | {"unit_fraction": row["unit_own"]}, [*parts, "--", "-hausd", "0.01"])


def remeshed(script, peer, figures, words):
    rows = [["input", "program", "vertices", "unit edges", "quality, mean / min", "seconds"]]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "run.json")
        run(sys.executable, ROOT / "scripts" / script, "--json", out, *words)
        for row in json.loads(out.read_text()):
            for program in (peer, "voronaut"):
                found = figures(row[program])
                quality = {"mean": found["quality_mean"], "min": found["quality_min"]}
                rows.append([row["input"], program, number(found["vertices"], 0), percent(found["unit_fraction"]), pair(quality),
                             seconds(row[program]["seconds"])])
    return rows


def benchmark(name):
    """One group of the benchmark, as its page has it."""
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.md")
        run(sys.executable, ROOT / "scripts/benchmark.py", name, "--runs", 3, "--page", page)
        [(_, text)] = MARKED.findall(page.read_text())
    return cells(text)


@table("mmg2d_O3")
def benchmark_remesh():
    return benchmark("remesh")


@table("ffbamg")
def benchmark_shock():
    return benchmark("shock")


@table("mmgs_O3", "vorpalite")
def benchmark_surfaces():
    return benchmark("surfaces")


@table("ffbamg")
def benchmark_hessian():
    return benchmark("hessian")


@table("node", "npm", os.environ.get("CHROMIUM", "chromium"))
def pages():
    printed = run(ROOT / "scripts/test_page", "--measure")
    rows = [["mesh", "triangles", "page, MB", "written", "load", "frames a second", "processor, ms a frame"]]
    for line in printed.splitlines():
        kind, *figures = line.split()
        if kind in ("plane", "torus"):
            count, size, written, load, rate, _, busy, _ = map(float, figures)
            rows.append([kind, number(count, 0), number(size, 2), f"{written:.2f} s", f"{load / 1000:.2f} s", f"{rate:.1f}", number(busy, 0)])
    return rows


@table("mpiexec")
def costs():
    return in_parts("-n", 1000000, "--parts", 10, "--ranks", "--no-whole", "--costs")


@table("mpiexec")
def parts():
    return in_parts("--json")


def in_parts(*words):
    """The table that scripts/parts.py writes to the file which its last word is for."""
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder, "rows.json")
        run(sys.executable, ROOT / "scripts/parts.py", "plane", "--rotated", 0, *words, rows)
        return json.loads(rows.read_text())


if __name__ == "__main__":
    main()
