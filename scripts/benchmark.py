#!/usr/bin/env python3
"""Times voronaut beside mmg2d, mmgs, bamg and geogram, and judges all meshes alike.

    scripts/benchmark.py                                      # remesh, shock, hessian and surfaces
    scripts/benchmark.py remesh surfaces --runs 9             # these groups, nine turns
    scripts/benchmark.py shock --sizes 4000 --threads 1 2 4   # these numbers of vertices, and of voronaut's threads
    scripts/benchmark.py million --runs 1                     # a million vertices: only when asked for by name
    scripts/benchmark.py remesh shock hessian surfaces million --page docs/benchmark.md     # write the page

Set up: `cargo build --release`; mmg2d and mmgs come with `pip install mmgpy` (into the Python that runs this, for which it brings
numpy), bamg with `apt install freefem++`; vorpalite, geogram's, is used if it is on the PATH. What is not there is skipped, and said to
be. pip's `mmg2d_O3` on the PATH is a script that takes 0.15 s to start; what is timed is the program inside the package.

Programs run in turns, A B A B ..., from files to files. s: medians of wall time; after it, voronaut's time as a multiple of the peer's:
of the medians, and the median of the ratios in each turn. CPU: time in user mode, of all threads. MB: the peak of memory. Every mesh is
judged by `voronaut check`: the share of edges of length in [1/sqrt 2, sqrt 2] in a metric, the mean and the least quality of triangles.
"""

import argparse
import datetime
import functools
import importlib.metadata
import importlib.util
import itertools
import json
import math
import os
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from campaign import written
from compare_hessian import CASES, compiled, grid, metric, rows as tensor_rows, write_mesh
from compare_mmg2d import write_values
from compare_mmgs import as_mesh
from measure import markdown, number, percent

ROOT = Path(__file__).resolve().parent.parent
PEERS = ["mmg2d", "mmgs", "bamg", "geogram"]
# A small process in between: what is started from this one would have this one's memory counted as its own.
RUNNER = """
import json, os, sys, time
log = os.open(sys.argv[1], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
begin = time.perf_counter()
child = os.posix_spawnp(sys.argv[2], sys.argv[2:], os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, log, n) for n in (1, 2)])
used = os.wait4(child, 0)[2]
seconds = time.perf_counter() - begin
print(json.dumps([seconds, used.ru_utime, used.ru_maxrss / (1 << 20 if sys.platform == "darwin" else 1 << 10)]))
"""
COSTS = ["s", "CPU, s", "MB"]
MORE_IS_BETTER = {"unit edges", "mean quality", "least quality"}
GROUPS = {}
VERTICES = re.compile(r"\bVertices\s+(\d+)")
MATCHED = 0.03  # by how much a peer's number of vertices may differ where it is sought
PASSES = 5
ALONE = 50000  # vertices of surfaces from which on peers are left out
LONG, TOLD = 1, 0.02  # seconds on one thread of jobs whose gain by threads is told, and the least share of a stage


class Failed(Exception):
    """What a program said that made no mesh."""


def main():
    typed = options().parse_args()
    typed.programs = {peer: getattr(typed, peer) or program(peer) for peer in PEERS}
    sections, better = [], []
    with tempfile.TemporaryDirectory() as folder:
        typed.folder = Path(folder)
        for name in typed.groups:
            cases, peers = GROUPS[name]
            skipped = [f"{peer} was not found, and is left out." for peer in peers if not typed.programs[peer]]
            print(f"== {name}", *skipped, flush=True)
            done = [(case, timed(typed, case, *what)) for case, *what in cases(typed) if typed.only in case]
            rows = table(done, [peer for peer in peers if typed.programs[peer]])
            print(markdown(rows), flush=True)
            sections.append((name, " ".join([*cases.__doc__.split(), *skipped]), rows, [row for case in done for row in stages(*case)]))
            better += [line for case, results in done for line in where_better(f"{name}, {case}", results)]
    print("\n".join(better))
    if typed.page:
        typed.page.write_text(page(typed, sections, better))


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", default=[name for name in GROUPS if name != "million"], help=", ".join(GROUPS))
    parser.add_argument("--sizes", nargs="+", type=int, help="numbers of vertices, of every group [default: each has its own]")
    parser.add_argument("--runs", type=int, default=5, help="turns")
    parser.add_argument("--threads", nargs="+", type=int, default=sorted({1, os.cpu_count() or 1}), help="of voronaut: each is a row")
    parser.add_argument("--only", default="", help="cases whose name has this in it")
    parser.add_argument("--page", type=Path, help="a file to write everything to, as Markdown")
    parser.add_argument("--timeout", type=float, default=3600, help="seconds a program may take at a time")
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    for peer in PEERS:
        parser.add_argument(f"--{peer}", help="the program, if it is not to be looked for")
    return parser


def program(peer):
    if not peer.startswith("mmg"):
        return shutil.which({"bamg": "ffbamg", "geogram": "vorpalite"}[peer])
    package = importlib.util.find_spec("mmgpy")
    inside = [Path(folder, "bin", f"{peer}_O3") for folder in (package.submodule_search_locations if package else [])]
    return next((str(file) for file in inside if file.exists()), None)


def group(*peers):
    """Registers what yields cases: a name, subjects (by program and threads: a mesh, and what makes it once) and a judge of a mesh."""
    def register(cases):
        GROUPS[cases.__name__] = (cases, peers)
        return cases
    return register


# Running and judging

def run(typed, out, *words):
    """What a program cost that wrote the mesh `out`."""
    log = typed.folder / "log"
    for file in (log, out, out.with_suffix(".sol")):
        file.unlink(missing_ok=True)
    command = map(str, [sys.executable, "-I", "-S", "-c", RUNNER, log, *words])
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True) as process:
        try:
            printed, _ = process.communicate(timeout=typed.timeout)
        except subprocess.TimeoutExpired:
            raise Failed(f"took over {typed.timeout:g} s") from None
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    # bamg's exit code says nothing: what counts is whether there is a mesh.
    if not out.exists():
        said = log.read_text(errors="replace").strip() if log.exists() else ""
        raise Failed((said or "no mesh").splitlines()[-1].strip().replace(f"{typed.folder}/", "").replace("|", "/")[:100])
    return dict(zip(COSTS, json.loads(printed)))


def quick(typed, name, *words):
    """A mesh that is needed first, not timed; of an outline's points not all are corners."""
    run(typed, typed.folder / name, typed.voronaut, "mesh", *words, "-o", typed.folder / name, "-q")
    return plain(typed.folder / name)


def ours(typed, variant, out, *words):
    """Subjects: voronaut with every number of threads. They write the same mesh."""
    report = out.with_suffix(".json")

    def staged(threads):
        cost = run(typed, out, typed.voronaut, *words, "--report", report, "-q", "--threads", threads)
        return cost | {"stages": json.loads(report.read_text())["seconds"]}
    return {(variant, threads): (out, functools.partial(staged, threads)) for threads in typed.threads}


def theirs(typed, peer, out, *words):
    """A subject, if the peer is there."""
    return {(peer, 1): (out, functools.partial(run, typed, out, typed.programs[peer], *words))} if typed.programs[peer] else {}


def check(typed, mesh, *words):
    report = typed.folder / "check.json"
    report.unlink(missing_ok=True)
    command = [typed.voronaut, "check", mesh, *words, "--report", report, "-q"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if not report.exists():
        raise Failed(f"not judged: {done.stderr.strip()}".replace(f"{typed.folder}/", "").splitlines()[0])
    return json.loads(report.read_text())


def scaled(typed, mesh, first, *words):
    """The report in the metric that our mesh was made for, by one factor that of this one's number of vertices."""
    made = json.loads(first.with_suffix(".json").read_text())
    return check(typed, mesh, *words, "--metric-scale", made["metric_scale"] * vertices(mesh) / made["vertices"])


def fit(found):
    if not found["valid"]:
        raise Failed("its mesh is not valid")
    return {"unit edges": found["metric_edge_length"]["unit_fraction"], "mean quality": found["quality"]["mean"],
            "least quality": found["quality"]["min"]}


def strayed(found):
    return max(found["fidelity"][way]["distance"] for way in ("mesh_to_domain", "domain_to_mesh"))


def timed(typed, case, subjects, judge):
    """Runs all subjects of a case in turns, then judges what they made."""
    results, judged = {label: {"costs": []} for label in subjects}, {}
    for _ in range(typed.runs):
        for label, (_, once) in subjects.items():
            if "failed" not in results[label]:
                attempt(results[label], lambda result: result["costs"].append(once()))
    for label, (mesh, _) in subjects.items():
        if mesh not in judged and "failed" not in results[label]:
            attempt(results[label], lambda result: judged.update({mesh: {
                "vertices": vertices(mesh), "valid": check(typed, mesh)["valid"], "figures": judge(mesh)}}))
        results[label].update(judged.get(mesh, {}))
    print(f"{case}:", ", ".join(f"{name} ({threads}) {it.get('failed') or told('s', medians(it)['s'])}"
                                for (name, threads), it in results.items()), flush=True)
    return results


def attempt(result, action):
    try:
        action(result)
    except Failed as why:
        result["failed"] = str(why)


def medians(result):
    return {key: statistics.median(cost[key] for cost in result["costs"]) for key in COSTS}


# What is run

@group("mmg2d")
def remesh(typed):
    """`voronaut remesh` and `mmg2d_O3` with the same files and options. Of inputs with a `.sol` lengths are those in it (the metric asked
    for), between the vertices of the input; where sizes are the program's to choose or to grade, all is judged in the metric that either
    wrote beside its mesh. Distances are between mesh and outline, both ways, in units of the file."""
    for size in typed.sizes or [1000, 4000, 10000, 50000]:
        files = circle(typed, size, math.isqrt(size))
        yield remeshed(typed, f"`.sol`, {size:,}", files, ["-hgrad", "-1"])
        yield remeshed(typed, f"`.sol`, {size:,}", files, [])
    yield remeshed(typed, "`.sol`, 4 vertices", circle(typed, 12, 1), [])
    yield remeshed(typed, "square", [grid_mesh(typed, "square", 10)], ["-hsiz", "0.02"])
    thin = quick(typed, "thin.mesh", "rect:-1,-1,1,1", "--metric", "shock:phi=1,lambda=0.6", "-n", 4000)
    yield remeshed(typed, "mesh of mild shock, 4,000", [thin], ["-optim"])
    for name, domain, count, hausd, hmax in (("disc with holes", typed.folder / written(typed.folder, holes()), 3000, 0.001, 0.1),
                                             ("Aegean", ROOT / "data/aegean.geojson", 6000, 0.3, 30)):
        even = quick(typed, "even.mesh", domain, "--metric", "uniform", "-n", count)
        yield remeshed(typed, f"{name}, {count:,}", [even], ["-hausd", hausd, "-hmax", hmax], domain)


def remeshed(typed, name, files, words, domain=None):
    mesh, *sol = files
    out, other = typed.folder / "ours.mesh", typed.folder / "mmg2d.mesh"
    words = [*words, *(["-sol", *sol] if sol else [])]
    subjects = ours(typed, "voronaut", out, "remesh", mesh, out, *words) | theirs(typed, "mmg2d", other, "-v", "0", mesh, other, *words)
    fields = {"metric asked for": (sol[0], mesh)} if sol else {}
    if "-1" not in words:
        fields |= {"voronaut's metric": (out.with_suffix(".sol"), out), "mmg2d's metric": (other.with_suffix(".sol"), other)}

    def judge(made):
        away = {"distance": {"greatest": strayed(check(typed, made, "--domain", domain))}} if domain else {}
        return {which: fit(check(typed, made, "--metric", field, "--background", at)) for which, (field, at) in fields.items()
                if field.exists()} | away
    told_words = " ".join(map(str, words[:len(words) - 2 * len(sol)]))
    return f"{name}, {f'`{told_words}`' if told_words else 'default gradation'}", subjects, judge


def circle(typed, size, steps):
    """An even grid on the unit square, and a metric that is thin across an arc, for about so many vertices."""
    def tensors(points):
        r = np.hypot(*points.T)[:, None, None] + 1e-12
        across = np.minimum(0.1, np.hypot(0.01, 0.2 * (r - 0.7)))
        along = np.minimum(0.2, 8 * across)
        outward = points[:, :, None] * points[:, None, :] / r**2
        return outward / across**2 + (np.eye(2) - outward) / along**2

    factor = size * math.sqrt(3) / 2 / np.sqrt(np.linalg.det(tensors(grid(400)[0]))).mean()
    sol = typed.folder / "asked.sol"
    write_values(sol, [(m[0][0], m[0][1], m[1][1]) for m in (factor * tensors(grid(steps)[0])).tolist()])
    return [grid_mesh(typed, "circle", steps), sol]


def grid_mesh(typed, name, steps):
    file = typed.folder / f"{name}.mesh"
    write_mesh(file, *grid(steps))
    return file


def holes():
    """A disc with three round holes."""
    rings = [(0, 0, 1, 600), (0.4, 0.1, 0.2, 200), (-0.3, 0.4, 0.1, 200), (-0.2, -0.5, 0.05, 200)]
    return [[[x + r * math.cos(2 * math.pi * i / n), y + r * math.sin(2 * math.pi * i / n)] for i in range(n)] for x, y, r, n in rings]


@group("bamg")
def shock(typed):
    """`mesh rect:-1,-1,1,1 --metric shock:phi=1,lambda=0.6 -n N`, beside five passes of bamg from an even mesh of as many vertices, each
    on the last one's mesh with the exact tensors at its vertices: their times summed. Each mesh is judged in the formula's metric,
    scaled to its own number of vertices."""
    yield from (shocked(typed, 1, 0.6, size, PASSES) for size in typed.sizes or [4000, 10000, 100000])


@group("bamg")
def million(typed):
    """`mesh rect:-1,-1,1,1 --metric shock:phi=10,lambda=0.6 -n N` beside a single pass of bamg from an even mesh of as many vertices."""
    yield from (shocked(typed, 10, 0.6, size, 1) for size in typed.sizes or [1000000])


def shocked(typed, phi, slope, size, passes):
    domain, field, out = "rect:-1,-1,1,1", f"shock:phi={phi},lambda={slope}", typed.folder / "ours.mesh"
    subjects = ours(typed, "voronaut", out, "mesh", domain, "--metric", field, "-n", size, "-o", out)
    if typed.programs["bamg"]:
        even = quick(typed, "even.mesh", domain, "--metric", "uniform", "-n", size)
        subjects |= bamg(typed, even, out, lambda points: shock_tensors(points, phi, slope), passes)
    return f"{'mild' if passes > 1 else 'hard'} shock, {size:,}", subjects, lambda made: {
        "formula's metric": fit(scaled(typed, made, out, "--metric", field))}


def shock_tensors(points, phi, slope):
    """As voronaut's metric `shock` has them: thin along the gradient of tanh((2 x - sin 5 y) / lambda) + x^3 + x y^2."""
    x, y = points.T
    steep = np.cosh(np.clip((2 * x - np.sin(5 * y)) / slope, -300, 300)) ** -2.0 / slope
    gradient = np.stack([2 * steep + 3 * x * x + y * y, -5 * np.cos(5 * y) * steep + 2 * x * y], axis=1)
    norm = np.maximum(np.linalg.norm(gradient, axis=1), 1e-300)
    along = gradient / norm[:, None]
    return np.eye(2) + ((1 + phi * norm) ** 2 - 1)[:, None, None] * along[:, :, None] * along[:, None, :]


def bamg(typed, even, first, tensors, passes, *words, name="bamg"):
    """A subject: passes of bamg, the last with as many vertices as our mesh. Runs that miss it do not count: they start again better."""
    out, better = typed.folder / f"{name.replace(' ', '-')}{passes}.mesh", []

    def once():
        made = json.loads(first.with_suffix(".json").read_text())
        for _ in range(4):
            start = better[-1] if better else made["metric_scale"]
            costs, factor = adapt(typed, even, start, made["vertices"], tensors, out, passes, words)
            if abs(vertices(out) / made["vertices"] - 1) <= MATCHED:
                break
            better.append(factor)
        return {key: (max if key == "MB" else sum)(cost[key] for cost in costs) for key in COSTS}
    return {(name, 1): (out, once)}


def adapt(typed, mesh, factor, count, tensors, last, passes, words):
    """What each pass cost, and the factor that the next would have."""
    costs, sizes = [], typed.folder / "bamg.mtr"
    for which in range(1, passes + 1):
        points, out = read_points(mesh), last if which == passes else typed.folder / f"bamg{which}.mesh"
        sizes.write_text(f"{len(points)} 3\n" + tensor_rows(factor * tensors(points)))
        costs.append(run(typed, out, typed.programs["bamg"], "-b", mesh, "-M", sizes, "-nbv", 2 * count + 10000, "-o", out, *words))
        # Without its references to its own geometry, over which the next pass may fail.
        mesh = plain(out)
        factor *= count / vertices(mesh)
    return costs, factor


@group("bamg")
def hessian(typed):
    """The least L2 error of a front and a layer on the unit square (`layers` of `scripts/compare_hessian.py`): `mesh --metric hessian:`
    with the formula, and with a `.sol` of its values at the vertices of an even mesh of as many vertices, as in an adaptation's first
    step, and then of the mesh that this gave, as in its next; `--polish 0` is the metric's unit mesh, with `--effort fast` in less time.
    Five passes of bamg as for the shock, with `-ratio 2.5` and the optimal tensors of the literature; the other bamg has the tensors
    of voronaut's metric, which is sparser at saddles. Errors are multiplied by the number of vertices."""
    formula, values, later = CASES["layers"], typed.folder / "values.sol", typed.folder / "later.sol"
    function, field, domain = compiled(formula), f"hessian:{formula}", "rect:0,0,1,1"
    for size in typed.sizes or [10000, 100000]:
        even, subjects = quick(typed, "even.mesh", domain, "--metric", "uniform", "-n", size), {}
        write_values(values, function(*read_points(even).T).tolist())
        step = [f"hessian:{values}", "--background", even]
        adapted = quick(typed, "adapted.mesh", domain, "--metric", *step, "-n", size)
        write_values(later, function(*read_points(adapted).T).tolist())
        sources = {"": [field], " from first `.sol`": step, " from second `.sol`": [f"hessian:{later}", "--background", adapted]}
        for source, words in sources.items():
            for more in ([], ["--polish", "0"], ["--effort", "fast", "--polish", "0"]):
                out = typed.folder / f"ours{len(subjects)}.mesh"
                command = ["mesh", domain, "--metric", *words, "-n", size, "-o", out, *more]
                told = " ".join(more)
                subjects |= ours(typed, f"voronaut{source}" + (f" `{told}`" if more else ""), out, *command)
        first = typed.folder / "ours0.mesh"
        if typed.programs["bamg"]:
            for name, density in {"bamg": "plain", "bamg, voronaut's metric": "saddles"}.items():
                tensors = functools.partial(metric, function, floor=0.01, aspect=100, density=density)
                subjects |= bamg(typed, even, first, tensors, PASSES, "-ratio", "2.5", name=name)

        def judge(made):
            found = scaled(typed, made, first, "--metric", field, "--function", formula)
            l2, worst = found["interpolation"]["norm"], found["interpolation"]["max"]["value"]
            error = {"L2 error N": found["vertices"] * l2, "greatest error N": found["vertices"] * worst}
            return {"function": error, "formula's metric": fit(found)}
        yield f"front and layer, {size:,}", subjects, judge


@group("mmgs", "geogram")
def surfaces(typed):
    """`mesh MODEL --metric curvature -n N`, with and without `--fit`, beside the run of `mmgs_O3 -A` whose `-hausd` (where that changes
    little, `-hmax`) gives as many vertices, found by bisection that does not count, and geogram's `remesh:anisotropy=0.02`; voronaut
    alone at 100,000, where that bisection takes over ten minutes. Judged in the metric of curvature, scaled to each mesh's number of
    vertices, and in the one that mmgs wrote beside its mesh; distances are between mesh and model, both ways, in diagonals."""
    smooth = [ROOT / "data/spot.obj", ROOT / "data/bob_small.obj"]
    for size in typed.sizes or [2000, 6000, 100000]:
        has_peers = size < ALONE
        models = [*smooth, *(sorted((ROOT / "data/parts").glob("*.mesh")) if has_peers else [])]
        yield from (surface(typed, model, size, has_peers) for model in models)


def surface(typed, model, size, has_peers):
    first, fitted, other, lifted = (typed.folder / f"{name}.mesh" for name in ("ours", "fitted", "mmgs", "geogram"))
    command, source = ["mesh", model, "--metric", "curvature", "-n", size, "-o"], as_mesh(model, typed.folder)
    subjects = ours(typed, "voronaut", first, *command, first) | ours(typed, "voronaut `--fit`", fitted, *command, fitted, "--fit")
    if has_peers and typed.programs["mmgs"]:
        plainly = [typed.programs["mmgs"], "-v", "0", "-A", source, other]
        chosen = functools.cache(lambda: matched(typed, other, plainly, size, np.linalg.norm(np.ptp(read_points(source), axis=0))))
        subjects["mmgs", 1] = (other, lambda: run(typed, other, *plainly, *chosen()))
    if has_peers:
        subjects |= theirs(typed, "geogram", lifted, source, lifted, f"remesh:nb_pts={size}", "remesh:anisotropy=0.02")

    def judge(made):
        found, own = scaled(typed, made, first, "--domain", model, "--metric", "curvature"), other.with_suffix(".sol")
        figures = {"metric of curvature": fit(found)}
        if has_peers and own.exists():
            figures["mmgs's metric"] = fit(check(typed, made, "--domain", other, "--metric", own))
        away = found["fidelity"]
        return figures | {"distance": {"RMS": away["rms_share"], "greatest": away["hausdorff_share"]}}
    return f"`{model.relative_to(ROOT)}`, {size:,}", subjects, judge


def matched(typed, out, command, size, extent):
    """The options with which mmgs comes nearest to so many vertices."""
    best = math.inf, []
    for option, low, high in (("-hausd", 1e-6, 0.1), ("-hmax", 1e-3, 1.0)):
        for _ in range(12 if best[0] > MATCHED else 0):
            middle = math.sqrt(low * high)
            words = [option, repr(float(middle * extent))]
            run(typed, out, *command, *words)
            count = vertices(out)
            best = min(best, (abs(count / size - 1), words))
            if best[0] <= MATCHED / 3:
                break
            low, high = (middle, high) if count > size else (low, middle)
    return best[1]


# Files

def vertices(mesh):
    return int(VERTICES.search(mesh.read_text())[1])


def read_points(mesh):
    text = mesh.read_text()
    at, dimension = VERTICES.search(text), int(re.search(r"Dimension\s+(\d)", text)[1])
    return np.fromstring(text[at.end():], sep=" ", count=(dimension + 1) * int(at[1])).reshape(-1, dimension + 1)[:, :dimension]


def plain(mesh):
    """The planar file with vertices, edges and triangles only."""
    text = mesh.read_text()
    kept = [re.search(rf"\b{name}\s+\d[-+.\d\se]*", text)[0].rstrip() for name in ("Vertices", "Edges", "Triangles")]
    mesh.write_text("\n".join(["MeshVersionFormatted 2", "Dimension 2", *kept, "End", ""]))
    return mesh


# The page

def told(key, value):
    if key in COSTS:
        return number(value, 0) if key == "MB" or value >= 100 else f"{value:.3f}" if value < 1 and key == "s" else f"{value:.2f}"
    return percent(value) if key == "unit edges" else f"{value:.1e}" if key in ("RMS", "greatest") else f"{value:.3f}"


def table(cases, peers):
    """The rows of a group, its heading first: one for each program and number of threads."""
    columns = {}
    for it in (it for _, results in cases for it in results.values()):
        columns |= {column: list(figures) for column, figures in it.get("figures", {}).items()}
    rows = [["input", "program", "threads", "s", *(f"multiple of {peer}'s" for peer in peers), "CPU, s", "peak, MB", "vertices",
             *(f"{column}: {', '.join(names)}" for column, names in columns.items())]]
    for case, results in cases:
        before = None
        for (name, threads), it in results.items():
            if "failed" in it:
                rows.append([case, name, str(threads), f"fails: {it['failed']}", *["-"] * (len(rows[0]) - 4)])
                continue
            cost = {key: told(key, value) for key, value in medians(it).items()}
            count = number(it["vertices"], 0) + ("" if it["valid"] else ", not valid")
            judged = [", ".join(told(*pair) for pair in it["figures"].get(column, {}).items()) or "-" for column in columns]
            judged = ["same"] * len(judged) if before == name else judged
            rows.append([case, name, str(threads), cost["s"], *(multiple(name, it, results.get((peer, 1))) for peer in peers),
                         cost["CPU, s"], cost["MB"], count, *judged])
            before = name
    return rows


def multiple(name, mine, theirs):
    if not name.startswith("voronaut") or theirs is None or "failed" in theirs:
        return "-"
    pairs = statistics.median(a["s"] / b["s"] for a, b in zip(mine["costs"], theirs["costs"]))
    return f"{medians(mine)['s'] / medians(theirs)['s']:.2f}, {pairs:.2f}"


def gains(rows):
    """Of long jobs in the rows of a group: what threads gain, what share of the time on one no others help with, and what
    16 cores would then gain (Amdahl's law)."""
    found = []
    for (case, name), them in itertools.groupby(rows[1:], key=lambda row: row[:2]):
        seconds = {int(threads): float(s.replace(",", "")) for _, _, threads, s, *_ in them if not s.startswith("fails")}
        most = max(seconds, default=1)
        if not name.startswith("voronaut") or most == 1 or seconds.get(1, 0) < LONG:
            continue
        gain = seconds[1] / seconds[most]
        alone = min(max((most / gain - 1) / (most - 1), 0), 1)
        found.append([case, name, str(most), f"{gain:.2f}", f"{alone:.2f}", f"{1 / (alone + (1 - alone) / 16):.1f}"])
    return found


def stages(case, results):
    """Of a long job: its stages on one thread that take a share of that worth telling, and what threads gain in each."""
    most = max((threads for name, threads in results if name == "voronaut"), default=1)
    found = [results.get(("voronaut", threads), {}) for threads in (1, most)]
    if most == 1 or any("failed" in it or not it for it in found) or medians(found[0])["s"] < LONG:
        return []
    one, all_threads = (of_stages(it["costs"]) for it in found)
    gain = {stage: seconds / all_threads[stage] for stage, seconds in one.items() if seconds > TOLD * sum(one.values())}
    return [[case, stage, percent(one[stage] / sum(one.values())), str(most), f"{by:.2f}"] for stage, by in gain.items()]


def of_stages(costs):
    """Medians of the seconds that stages took; what is left is reading, judging and writing."""
    found = {stage: statistics.median(cost["stages"][stage] for cost in costs) for stage in costs[0]["stages"] if stage != "total"}
    return found | {"all else": max(statistics.median(cost["s"] for cost in costs) - sum(found.values()), 1e-9)}


def threads(sections):
    said = "Jobs of a second or more on one thread. By Amdahl's law: what part of that time only one thread works, and what 16 cores would gain."
    heading = ["input", "program", "threads", "times as fast as one", "share on one alone", "16 cores: times as fast"]
    rows = [heading, *(row for _, _, rows, _ in sections for row in gains(rows))]
    of_which = f"Where that is: stages that take over {TOLD:.0%} of the time on one thread. All else is reading, judging and writing."
    parts = [["input", "stage", "share of the time on one", "threads", "times as fast as one"], *(row for *_, rows in sections for row in rows)]
    return f"## Threads\n\n{said}\n\n{markdown(rows)}\n{of_which}\n\n{markdown(parts)}"


def where_better(case, results):
    """A line for every peer and way of ours in which the peer has a better figure."""
    lines = []
    for peer, there in ((name, it) for (name, _), it in results.items() if not name.startswith("voronaut") and "failed" not in it):
        for way in dict.fromkeys(name for name, _ in results if name.startswith("voronaut")):
            lost = losses({threads: it for (name, threads), it in results.items() if name == way}, there)
            lines += [f"- {case}: {peer} beside {way}: {'; '.join(lost)}"] if lost else []
    return lines


def losses(mine, there):
    """What of theirs is better: costs with the numbers of threads of ours, figures of the mesh with the metric."""
    if any("failed" in it for it in mine.values()):
        return ["voronaut fails"]
    lost, costs = [], medians(there)
    for key in COSTS:
        slower = [str(threads) for threads, it in mine.items() if is_better(key, costs[key], medians(it)[key])]
        lost += [f"{key} ({', '.join(slower)})"] if slower else []
    made = next(iter(mine.values()))["figures"]
    for column, figures in there["figures"].items():
        lost += [f"{key} ({column})" for key, value in figures.items() if is_better(key, value, made[column][key])]
    return lost


def is_better(key, value, other):
    return (value > other if key in MORE_IS_BETTER else value < other) and told(key, value) != told(key, other)


def page(typed, sections, better):
    cores, memory = os.cpu_count(), os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**30
    version = subprocess.run([typed.voronaut, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    version += f", mmgpy {importlib.metadata.version('mmgpy')}" if typed.programs["mmg2d"] or typed.programs["mmgs"] else ""
    given = " ".join(name for name, *_ in sections) + (f" --sizes {' '.join(map(str, typed.sizes))}" if typed.sizes else "")
    parts = [f"# Benchmark\n\nMeasured on {datetime.date.today()} on a machine with {cores} cores and {memory:.0f} GiB of memory "
             f"({version}). `scripts/benchmark.py {given} --runs {typed.runs} --page docs/benchmark.md` wrote this page; no figure in it "
             f"is typed by hand.\n\n{' '.join(__doc__.split(chr(10) * 2)[-1].split())}\n"]
    parts += [f"## {name}\n\n{text}\n\n<!-- measured: benchmark-{name} -->\n{markdown(rows)}<!-- end -->\n" for name, text, rows, _ in sections]
    parts.append(threads(sections))
    said = "In what a peer is faster, takes less, or has a better figure: of costs in brackets beside how many threads of ours."
    lines = "\n".join(better) or "None, of the peers that ran."
    return "\n".join([*parts, f"## Where peers are better\n\n{said}\n\n{lines}\n"])


if __name__ == "__main__":
    try:
        main()
    except Failed as why:
        sys.exit(f"an input was not made: {why}")
