#!/usr/bin/env python3
"""Makes one mesh in parts, by processes and by ranks of MPI, compares the bytes, and judges it beside meshes in one piece.

    scripts/parts.py plane                  # `shock:phi=10,lambda=0.6` on a square, 200,000 vertices in 4 parts
    scripts/parts.py plane -n 1000000 --parts 10 --ranks 1 2 4
    scripts/parts.py surface -n 200000 --parts 4 --rotated 5
    scripts/parts.py plane -n 5000000 --parts 50 --ranks --rotated 0 --no-whole
    scripts/parts.py plane --json table.json                   # its lines as a table, too
    scripts/parts.py plane -n 1000000 --parts 10 --ranks --rotated 0 --no-whole --costs costs.json      # what costs how much

Set up: `cargo build --release`, and into the Python that runs this `pip install scipy mpi4py mpich maturin`, then `maturin develop
--release`. Python's ranks keep to one core each, as do the program's processes.

Strips are what was made anew around cuts. The same places of a mesh in one piece are its triangles whose nearest triangle of the other
mesh, by centroids, is of a strip. Meshes in one piece are also made of the domain turned around the origin, with the metric turned
along; from one to the next their worst triangles differ. Memory of ranks is counted over a process that only imports; that of a part
alone is of a process that makes nothing else, and the part is the one that takes most.
"""

import argparse
import json
import math
import pickle
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
VORONAUT = ROOT / "target/release/voronaut"
SPOT = ROOT / "data/spot.obj"
PHI, LAMBDA = 10, 0.6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=CASES)
    parser.add_argument("-n", type=int, default=200_000)
    parser.add_argument("--parts", type=int, default=4)
    parser.add_argument("--processes", type=int, nargs="*", default=[2])
    parser.add_argument("--ranks", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--rotated", type=int, default=5, help="meshes in one piece of the domain turned")
    parser.add_argument("--no-whole", action="store_true", help="no mesh in one piece of the domain as it is")
    parser.add_argument("--folder", type=Path, help="what is kept of an earlier run, and of this one")
    parser.add_argument("--json", type=Path, help="a file for the rows of a table")
    parser.add_argument("--costs", type=Path, help="a file for the rows of a table of what is done by the first number of processes")
    parser.add_argument("--rank", choices=["import", "mesh", "jobs", "part"], help=argparse.SUPPRESS)
    parser.add_argument("--part", type=int, help=argparse.SUPPRESS)
    typed = parser.parse_args()
    if typed.rank:
        return be_a_rank(typed)
    with tempfile.TemporaryDirectory() as scratch:
        compare(typed, typed.folder or Path(scratch))


def compare(typed, folder):
    folder.mkdir(parents=True, exist_ok=True)
    rows = Rows()
    made = {f"{count} processes": by_processes(typed, folder, count, rows) for count in typed.processes}
    if typed.ranks:
        nothing = memory_of(typed, folder, "import", 1)[0]
        memory_of(typed, folder, "jobs", 1)
        with ThreadPoolExecutor(2) as pool:
            alone = list(pool.map(lambda part: memory_of(typed, folder, "part", 1, "--part", part)[0], range(typed.parts)))
        rows.add("a part alone", peaks=[max(alone) - nothing])
    for count in typed.ranks:
        peaks = [peak - nothing for peak in memory_of(typed, folder, "mesh", count)]
        name = f"{count} rank{'s' * (count > 1)}"
        rows.add(name, json.loads((folder / "rank.json").read_text()), peaks)
        made[name] = (folder / "rank.meshb").read_bytes()
    others = [how for how, mesh in made.items() if mesh != next(iter(made.values()))]
    if others:
        sys.exit(f"other bytes than by {next(iter(made))}: {', '.join(others)}")
    print(f"the same bytes: {', '.join(made)}", flush=True)
    if not typed.no_whole:
        strips(typed, folder, rows)
    for turn in range(1, typed.rotated + 1):
        told, peak = in_one_piece(typed, folder, 2 * math.pi * turn / (typed.rotated + 1), f"turned-{turn}")
        rows.add(f"in one piece, turned {turn}", told, [peak])
    if typed.json:
        typed.json.write_text(json.dumps(rows.rows))
    if typed.costs:
        typed.costs.write_text(json.dumps(costs(typed, folder)))


def costs(typed, folder):
    """Rows of what is done, by whom, how that grows, and what it was: N vertices in parts of n each on R cores."""
    count = typed.processes[0]
    stages = json.loads((folder / f"processes-{count}.json").read_text())["seconds"]
    made = {name: [path for path in (folder / f"kept-{count}").glob(f"{name}-*.meshb") if not path.stem.endswith("-job")]
            for name in ("parts", "strips", "junctions")}
    vertices = {name: sum(vertices_of(path) for path in paths) for name, paths in made.items()}
    jobs = list((folder / f"kept-{count}").glob("*-job.meshb"))
    back = [path for paths in made.values() for path in paths]
    judged = stages["total"] - sum(seconds for stage, seconds in stages.items() if stage != "total")
    by_all = f"on {count} cores"

    def size(paths):
        return sum(path.stat().st_size for path in paths) / 1e6

    return [
        ["what", "who", "grows as", "measured"],
        ["the factor on the metric, and a coarse mesh along whose edges is cut", "rank 0", "64 N / n vertices", f"{stages['partition']:.1f} s"],
        ["parts", "all", "N / R", f"{vertices['parts']:,} vertices, {stages['parts']:.0f} s {by_all}"],
        ["strips: eight layers on both sides of cuts", "all", "N / sqrt(n) vertices, over R",
         f"{vertices['strips']:,} vertices, {stages['strips']:.0f} s {by_all}"],
        ["junctions: twenty layers around the ends of cuts", "all", "N / n vertices, over R",
         f"{vertices['junctions']:,} vertices, {stages['junctions']:.1f} s {by_all}"],
        ["stitching, and the check of the whole", "rank 0", "N", f"{stages['stitch'] + stages['check']:.1f} s"],
        ["what the whole is in the metric, for the report, and writing it", "rank 0", "N", f"{judged:.1f} s {by_all}"],
        ["meshes that were made, as files", "R - 1 to one", "N", f"{size(back):.0f} MB in {len(back)}"],
        ["corners and cuts of what is to be meshed, as files", "one to R - 1", "N / sqrt(n)", f"{size(jobs):.1f} MB in {len(jobs)}"],
    ]


def vertices_of(path):
    import voronaut

    return len(voronaut.Mesh.read(path).points)


class Rows:
    """A table that is printed as it comes to be."""

    def __init__(self):
        self.rows = [["", "triangles", "unit edges", "quality, mean / min", "seconds", "peak, MB"]]

    def add(self, name, told=None, peaks=()):
        """What a report says of a mesh, if there is one; the greatest peak of memory is told, all are printed."""
        figures = ["-"] * 4
        if told:
            quality = told["quality"]
            figures = [f"{told['triangles']:,}", f"{100 * told['metric_edge_length']['unit_fraction']:.2f} %",
                       f"{quality['mean']:.4f} / {quality['min']:.2g}", f"{told['seconds']:.0f} s" if told["seconds"] else "-"]
        row = [name, *figures, f"{max(peaks):.0f}" if peaks else "-"]
        print(" | ".join(row), *(f"{peak:.0f}" for peak in peaks[1:]), flush=True)
        self.rows.append(row)


def by_processes(typed, folder, count, rows):
    """Makes the mesh by so many processes, and returns its bytes."""
    out, kept = folder / f"processes-{count}.meshb", folder / f"kept-{count}"
    words = ["--parts", typed.parts, "--parts-dir", kept, "--threads", count, "-n", typed.n]
    told, peak = run(["mesh", *CASES[typed.case](folder, 0), *words], out)
    assert told["valid"] and told["vertices"] == typed.n
    print(", ".join(f"{stage} {seconds:.1f} s" for stage, seconds in told["stages"].items()), flush=True)
    rows.add(f"{count} processes", told, [peak])
    return out.read_bytes()


def run(words, out):
    """What the program reports, and the greatest peak of its processes' memory in MB."""
    report = out.with_suffix(".json")
    command = [VORONAUT, *map(str, words), "-o", out, "--report", report, "-q"]
    told = subprocess.run([sys.executable, "-c", PEAK, *command], check=True, capture_output=True, text=True)
    found = json.loads(report.read_text())
    return {**found, "stages": found["seconds"], "seconds": found["seconds"]["total"]}, float(told.stdout) / 1024


# Runs a program, and says what it and its own processes took at most.
PEAK = """import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"""


def memory_of(typed, folder, what, ranks, *more):
    """The peaks of the ranks' memory, in MB."""
    words = [sys.executable, __file__, typed.case, "-n", typed.n, "--parts", typed.parts, "--folder", folder, "--rank", what, *more]
    mpiexec = Path(sys.executable).with_name("mpiexec")
    subprocess.run([mpiexec, "-n", str(ranks), *map(str, words)], check=True)
    name = "-".join([what, *map(str, more[1:])])
    return [float((folder / f"{name}-{rank}.peak").read_text()) for rank in range(ranks)]


def be_a_rank(typed):
    from mpi4py import MPI

    from voronaut import distributed

    domain, _, metric = CASES[typed.case](typed.folder, 0)
    comm, jobs, name = MPI.COMM_WORLD, typed.folder / "jobs.pickle", typed.rank
    begun, mesh = time.perf_counter(), None
    if typed.rank == "jobs":
        write_jobs(typed, distributed, (domain, metric), jobs)
    if typed.rank == "part":
        name = f"part-{typed.part}"
        distributed._Maker(domain, metric, typed.n, {}, None).make(pickle.loads(jobs.read_bytes())[typed.part], None)
    if typed.rank == "mesh":
        mesh = distributed.mesh(domain, metric, typed.n, typed.parts, comm)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    (typed.folder / f"{name}-{comm.Get_rank()}.peak").write_text(str(peak))
    if mesh is not None:
        (typed.folder / "rank.json").write_text(json.dumps({**mesh.report, "seconds": time.perf_counter() - begun}))
        mesh.save(typed.folder / "rank.meshb")


def write_jobs(typed, distributed, given, jobs):
    """Keeps the jobs of all parts, for processes that make one each."""
    class Enough(Exception):
        pass

    class Team(distributed._Team):
        def make(self, name, parts):
            jobs.write_bytes(pickle.dumps([distributed.Job(name, number, *part) for number, part in enumerate(parts)]))
            raise Enough

    try:
        Team(None, distributed._Maker(*given, typed.n, {}, None)).lead(typed.parts, {}, False)
    except Enough:
        pass


def in_one_piece(typed, folder, angle, name):
    return run(["mesh", *CASES[typed.case](folder, angle), "-n", typed.n], folder / f"{name}.meshb")


def strips(typed, folder, rows):
    """Judges strips beside the same places in one piece."""
    import voronaut
    from scipy.spatial import cKDTree

    told, peak = in_one_piece(typed, folder, 0, "whole")
    rows.add("in one piece", told, [peak])
    count = typed.processes[0]
    parts, whole = (voronaut.Mesh.read(folder / f"{name}.meshb") for name in (f"processes-{count}", "whole"))
    anew = [voronaut.Mesh.read(path).points for path in sorted((folder / f"kept-{count}").glob("[sj]*[0-9].meshb"))]
    known = set(map(bytes, np.concatenate(anew)))
    at = np.fromiter((bytes(p) in known for p in parts.points), bool, len(parts.points))
    in_strip = at[parts.triangles].all(axis=1)
    middles = [mesh.points[mesh.triangles].mean(axis=1) for mesh in (parts, whole)]
    nearest = cKDTree(middles[0]).query(middles[1])[1]
    for name, mesh, taken in (("strips", parts, in_strip), ("the same places in one piece", whole, in_strip[nearest])):
        triangles = fans(mesh.triangles[taken])
        used, numbers = np.unique(triangles, return_inverse=True)
        place = folder / "strips.meshb"
        voronaut.Mesh(mesh.points[used], numbers.reshape(-1, 3)).save(place)
        scale = json.loads((folder / f"processes-{count}.json").read_text())["metric_scale"]
        domain, *metric = CASES[typed.case](folder, 0)
        words = ["check", place, *metric, "--metric-scale", scale, *(["--domain", domain] if typed.case == "surface" else [])]
        subprocess.run([VORONAUT, *map(str, words), "--report", folder / "strips.json", "-q"], check=False)
        rows.add(name, {**json.loads((folder / "strips.json").read_text()), "seconds": None})


def fans(triangles):
    """The triangles without those at vertices around which they are not one fan: such a vertex has more than two edges at the border."""
    while True:
        ends = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, count = np.unique(ends, axis=0, return_counts=True)
        at_border = np.bincount(edges[count == 1].ravel(), minlength=triangles.max() + 1)
        stays = (at_border[triangles] <= 2).all(axis=1)
        if stays.all():
            return triangles
        triangles = triangles[stays]


def plane(folder, angle):
    """The shock on its square, turned."""
    c, s = math.cos(angle), math.sin(angle)
    if angle == 0:
        return "rect:-1,-1,1,1", "--metric", f"shock:phi={PHI},lambda={LAMBDA}"
    corners = [[c * x - s * y, s * x + c * y] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]
    domain = folder / f"square-{angle:.4f}.geojson"
    domain.write_text(json.dumps({"type": "Polygon", "coordinates": [corners]}))
    x, y = f"({c!r}*x+{s!r}*y)", f"({c!r}*y-{s!r}*x)"
    slope = f"((1-tanh((2*{x}-sin(5*{y}))/{LAMBDA})^2)/{LAMBDA})"
    gx, gy = f"(2*{slope}+3*{x}^2+{y}^2)", f"(2*{x}*{y}-5*cos(5*{y})*{slope})"
    gu, gv = f"({c!r}*{gx}-{s!r}*{gy})", f"({s!r}*{gx}+{c!r}*{gy})"
    # I + (2 phi / |g| + phi^2) g g'.
    factor = f"({2 * PHI}/sqrt({gx}^2+{gy}^2)+{PHI**2})"
    return domain, "--metric", f"formula:1+{factor}*{gu}^2; {factor}*{gu}*{gv}; 1+{factor}*{gv}^2"


def surface(folder, angle):
    """spot, turned around an axis that is none of its own."""
    if angle == 0:
        return SPOT, "--metric", "curvature"
    axis = np.array([1.0, 2.0, 3.0]) / math.sqrt(14)
    cross = np.cross(np.eye(3), axis)
    turned = np.eye(3) * math.cos(angle) - cross * math.sin(angle) + (1 - math.cos(angle)) * np.outer(axis, axis)
    lines = SPOT.read_text().splitlines()
    at = [turned @ [float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")]
    faces = [line for line in lines if line.startswith("f ")]
    domain = folder / f"spot-{angle:.4f}.obj"
    domain.write_text("\n".join([*("v {!r} {!r} {!r}".format(*map(float, p)) for p in at),
                                 *("f " + " ".join(word.split("/")[0] for word in face.split()[1:]) for face in faces)]) + "\n")
    return domain, "--metric", "curvature"


CASES = {"plane": plane, "surface": surface}

if __name__ == "__main__":
    main()
