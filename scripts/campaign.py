#!/usr/bin/env python3
"""Runs the program on many random inputs, replayable by their seeds, and counts what comes of it.

    scripts/campaign.py planar -n 1000            # random domains, metrics, options and numbers of vertices
    scripts/campaign.py outlines -n 200           # hard outlines: displaced by 1e-14, gaps of 1e-12, spikes, islands, collinear runs
    scripts/campaign.py outlines -n 200 --peers ffbamg mmg2d_O3     # beside bamg (apt: freefem++) and mmg2d (pip: mmgpy): a table
    scripts/campaign.py surfaces -n 200           # random surfaces, damaged or not, metrics and options
    scripts/campaign.py curved -n 200             # triangles of order 2 and 3, planar and on surfaces (needs numpy)
    scripts/campaign.py signals -n 200            # SIGINT and SIGTERM at random moments
    scripts/campaign.py threads -n 100            # every command with 1, 2, 3 and 8 threads: the same bytes
    scripts/campaign.py laws -n 200               # domains moved, turned, scaled by 1e-9 to 1e9, written in another order: meshes alike
    scripts/campaign.py planar --seed 17 -n 1 -v  # case 17 again, with its command; its files stay in --keep FOLDER

outcome: meshed (valid by `voronaut check`), refused (exit 1 with a message: counted by its first words), invalid, crashed (any other
exit), hung (over 60 s), over (more memory than 4 GiB). Of signals: ended (by itself), stopped (exit 1, said so, nothing left behind),
stray (files left, or over a second), crashed. Of threads and laws: same, differs, refused. The last line counts; the exit code is 1 if
there is anything but meshed, refused, ended, stopped and same. Meshes are alike if both are valid, with as many vertices (1 %, of few 3), and
shares of unit edges and mean qualities that differ by 0.05 at most: in other units roundings differ, and then vertices do.

Of curved: invalid, too, where the Jacobian is not positive at any of 496 places of a triangle, by Lagrange's polynomials and not by the
bounds of the program, or where two sides on the boundary cross, as polygons of eight parts each.

A peer fails where it does not end within 60 s, writes no mesh, or one that `voronaut check` calls invalid or whose area is neither that
of the domain nor that with its holes filled (within 2 %, for mmg2d may leave out corners).
"""

import argparse
import json
import math
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
METRICS = ["uniform", "uniform:100,0,1", "swirl", "shock:phi=10,lambda=0.1", "shock:phi=1000,lambda=0.02",
           "formula:1+100*x^2; 0; 1+y^2", "hessian:tanh(20*(x+0.3*y))", "boundary:h0=0.05,growth=1.5"]
FUNCTIONS = ["tanh(40*(sqrt((x+3)^2+(y+3)^2)-4))", "sin(5*x)*y", "x^4 + abs(y)*x^3", "exp(-100*(x^2+y^2))", "tanh(50*x*y) + x^5",
             "if(x < 0.3, 0, 1)*x^4", "sqrt(x^2 + y^2)", "log(x + 9)*cosh(y)", "max(x, y)^3", "tanh(1e3*(y - x^2))", "1/(x*x + y*y + 1e-3)"]
GOOD = {"meshed", "refused", "ended", "stopped", "same"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["planar", "outlines", "surfaces", "curved", "signals", "threads", "laws"])
    parser.add_argument("-n", type=int, default=100, help="cases")
    parser.add_argument("--seed", type=int, default=0, help="of the first case")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=Path, help="a folder for the files of cases that are not good")
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--peers", nargs="+", default=[], help="programs to run on the same outlines: bamg, mmg2d")
    parser.add_argument("-v", action="store_true", help="say each case")
    typed = parser.parse_args()
    counts, reasons, typed.fails, typed.cases = Counter(), Counter(), Counter(), Counter()
    with ThreadPoolExecutor(typed.jobs) as pool:
        for seed, outcome, said in pool.map(lambda seed: one(typed, seed), range(typed.seed, typed.seed + typed.n)):
            counts[outcome] += 1
            if outcome == "refused":
                reasons[re.sub(r"[0-9.e+-]{2,}|\d", "#", said)[:90]] += 1
            if typed.v or outcome not in GOOD:
                print(f"{seed}\t{outcome}\t{said}", flush=True)
    for reason, count in reasons.most_common():
        print(f"refused {count}: {reason}")
    print(", ".join(f"{counts[outcome]} {outcome}" for outcome in sorted(counts)))
    if typed.peers:
        print_table(typed)
    sys.exit(any(outcome not in GOOD for outcome in counts))


def one(typed, seed):
    chance = random.Random(f"{typed.kind} {seed}")
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        if others := {"signals": signalled, "threads": threads, "laws": laws}.get(typed.kind):
            return seed, *others(typed.voronaut, place, chance)
        words = {"planar": planar, "outlines": outlines, "surfaces": surfaces, "curved": curved}[typed.kind](chance, place)
        outcome, said = meshed(typed.voronaut, place, words)
        if typed.kind == "curved" and outcome == "meshed":
            outcome, said = sampled(place / "out.mesh")
        if typed.kind == "outlines" and typed.peers:
            compare(typed, place, int(words[-1]), outcome)
        if typed.v:
            said = f"{' '.join(words)}: {said}"
        if typed.keep and outcome not in GOOD:
            kept = typed.keep / f"{typed.kind}-{seed}"
            kept.mkdir(parents=True, exist_ok=True)
            for file in place.iterdir():
                (kept / file.name).write_bytes(file.read_bytes())
            (kept / "command").write_text(" ".join(words))
        return seed, outcome, said


def meshed(program, place, words):
    limits = ["--time-limit", "60", "--memory-limit", "4", "-q"]
    run = subprocess.run([program, *words, *limits, "-o", "out.mesh"], cwd=place, capture_output=True, text=True)
    said = run.stderr.strip().split("\n")[0]
    if "not done within" in said:
        return "hung", said
    if "were held" in said:
        return "over", said
    if run.returncode not in (0, 1):
        return "crashed", f"{run.returncode}: {run.stderr.strip()[-300:]}"
    if run.returncode == 1:
        left = [file.name for file in place.iterdir() if file.name.startswith(("out", ".voronaut"))]
        return ("stray", str(left)) if left else ("refused" if said.startswith("error: ") else "crashed", said)
    # A mesh of a surface may meet itself where the surface does.
    domain = ["--domain", words[1]] if words[1].endswith(".obj") else []
    repair = ["--repair"] if "--repair" in words else []
    check = subprocess.run([program, "check", "out.mesh", *domain, *repair, "-q"], cwd=place, capture_output=True, text=True)
    return ("meshed", "") if check.returncode == 0 else ("invalid", check.stderr.strip().split("\n")[0])


def options(chance):
    words = ["--metric", chance.choice(METRICS), "-n", str(int(10 ** chance.uniform(1, 3)))]
    extra = [[], [], ["--lloyd", "0"], ["--hausd", "0.01"], ["--gradation", "1.3"], ["--h-min", "0.01"], ["--a-max", "5"],
             ["--seeding", "farthest"], ["--dual", "canvas"], ["--dual", "geodesic"], ["--threads", "3"]]
    return words + chance.choice(extra)


def star(chance, centre, radius, corners):
    angles = sorted(chance.uniform(0, 2 * math.pi) for _ in range(corners))
    away = [radius * chance.uniform(0.3, 1) for _ in angles]
    return [[centre[0] + r * math.cos(a), centre[1] + r * math.sin(a)] for a, r in zip(angles, away)]


def planar(chance, place):
    if chance.random() < 0.2:
        x, y, w, h = (chance.uniform(-2, 2) for _ in range(4))
        return ["mesh", f"rect:{x},{y},{x + abs(w) + 1e-3},{y + abs(h) + 1e-3}", *options(chance)]
    scale = 10 ** chance.choice([-9, -3, 0, 0, 0, 3, 9])
    rings = [star(chance, (0, 0), 1, chance.randint(4, 60))]
    rings += [star(chance, (chance.uniform(-0.2, 0.2), chance.uniform(-0.2, 0.2)), 0.05, chance.randint(3, 8))
              for _ in range(chance.randint(0, 2))]
    return ["mesh", written(place, scaled(rings, scale)), *options(chance)]


def curved(chance, place):
    """Triangles of order 2 and 3: stars, smooth rings as samples, disks, and surfaces of equations."""
    order, n = str(chance.choice([2, 3])), str(int(10 ** chance.uniform(1, 2.7)))
    if chance.random() < 0.2:
        surface = chance.choice(["sphere:1", "sphere:1e-3", "torus:1,0.4", f"torus:{chance.uniform(1, 5)},0.9", "chair",
                                 "implicit:x^2+y^2-z^2-0.1;-1,-1,-1,1,1,1", "implicit:z-0.3*sin(3*x)*y;-1,-1,-1,1,1,1"])
        return ["mesh", surface, "--metric", chance.choice(["uniform", "curvature"]), "-n", n, "--order", order]
    ways = chance.randint(2, 6)
    wave = [(k, chance.uniform(-0.5, 0.5) / k**1.5, chance.uniform(0, 2 * math.pi)) for k in range(1, ways)]
    radius = lambda a: 1 + sum(size * math.cos(k * a + phase) for k, size, phase in wave)
    corners = chance.randint(8, 200)
    angles = [2 * math.pi * (i + chance.uniform(-0.3, 0.3)) / corners for i in range(corners)]
    smooth = [[radius(a) * math.cos(a), radius(a) * math.sin(a)] for a in angles]
    rings = chance.choice([[smooth], [smooth, [[0.1 * x, 0.1 * y] for x, y in smooth[::-1]]], [star(chance, (0, 0), 1, chance.randint(4, 40))]])
    size = 10 ** chance.choice([-6, 0, 0, 0, 6])
    domain, size = ("disk:0.5,-1,2", 1) if chance.random() < 0.2 else (written(place, scaled(rings, size)), size)
    boundary = chance.choice([[], ["--boundary", "spline"], ["--boundary", "spline"], ["--boundary", "polyline"]])
    norm = chance.choice([[], [], ["--norm", "1"], ["--norm", "inf"]])
    # Functions of the size of the domain, but for some that are nearly linear on a small one.
    hessian = "hessian:" + re.sub(r"\b([xy])\b", rf"(\1/{max(size, 1):g})", chance.choice(FUNCTIONS))
    metric = chance.choice([[chance.choice(METRICS)], [hessian, *norm]])
    return ["mesh", domain, "--metric", *metric, "-n", n, "--order", order, *boundary]


def sampled(path):
    """Whether curved triangles fold, or their boundary crosses itself, by many places of each."""
    import numpy as np

    points, triangles, order = nodes_of(path)
    size = {2: 6, 3: 10}[order]
    lattice = [[0, 0], [1, 0], [0, 1]]
    for a, b in ((0, 1), (1, 2), (2, 0)):
        lattice += [[((order - i) * lattice[a][c] + i * lattice[b][c]) / order for c in (0, 1)] for i in range(1, order)]
    lattice = np.array(lattice + [[1 / 3, 1 / 3]] * (order == 3))
    powers = [(i, j) for i in range(order + 1) for j in range(order + 1 - i)]
    basis = np.linalg.inv(np.array([[x**i * y**j for i, j in powers] for x, y in lattice]))
    at = np.array([[i / 30, j / 30] for i in range(31) for j in range(31 - i)])
    slope = [np.array([[i * x ** max(i - 1, 0) * y**j for i, j in powers] for x, y in at]) @ basis,
             np.array([[j * x**i * y ** max(j - 1, 0) for i, j in powers] for x, y in at]) @ basis]
    nodes = points[triangles[:, :size]]
    u, v = (np.einsum("sn,tnc->tsc", one, nodes) for one in slope)
    is_planar = np.ptp(points[:, 2]) == 0
    straight = np.cross(nodes[:, 1] - nodes[:, 0], nodes[:, 2] - nodes[:, 0])
    if is_planar:
        # Straight triangles between the corners of curved ones may be turned.
        straight[:] = [0, 0, 1]
    folded = (np.einsum("tsc,tc->ts", np.cross(u, v), straight) <= 0).any(axis=1)
    if folded.any():
        return "invalid", f"triangle {folded.argmax() + 1} folds"
    return crossed(points, triangles, order) if is_planar else ("meshed", "")


def crossed(points, triangles, order):
    import numpy as np

    inner = order - 1
    sides = {}
    for t in triangles:
        for s in range(3):
            way = [t[s], *t[3 + s * inner : 3 + (s + 1) * inner], t[(s + 1) % 3]]
            sides.setdefault(tuple(sorted((way[0], way[-1]))), []).append(way)
    border = [ways[0] for ways in sides.values() if len(ways) == 1]
    steps, share = np.arange(order + 1) / order, np.linspace(0, 1, 9)
    weights = np.stack([np.prod([(share - steps[k]) / (steps[i] - steps[k]) for k in range(order + 1) if k != i], axis=0)
                        for i in range(order + 1)])
    lines = np.einsum("is,bic->bsc", weights, points[np.array(border)][:, :, :2])
    low, high = lines.min(axis=1), lines.max(axis=1)
    turn = lambda a, b, c: (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])
    for i, (line, way) in enumerate(zip(lines, border)):
        near = np.flatnonzero(((low[i] <= high) & (low <= high[i])).all(axis=1))
        for j in near[near > i]:
            a, b, c, d = line[:-1, None], line[1:, None], lines[j][None, :-1], lines[j][None, 1:]
            cross = (turn(a, b, c) * turn(a, b, d) < 0) & (turn(c, d, a) * turn(c, d, b) < 0)
            if cross.any():
                return "invalid", f"sides of the boundary cross: {way}, {border[j]}"
    return "meshed", ""


def nodes_of(path):
    import numpy as np

    words = path.read_text().split()
    order = 2 if "TrianglesP2" in words else 3

    def block(name, width, kind):
        at = words.index(name) + 2
        return np.array(words[at : at + width * int(words[at - 1])], dtype=kind).reshape(-1, width)
    corners, axes = {2: 6, 3: 10}[order], int(words[words.index("Dimension") + 1])
    points = np.pad(block("Vertices", axes + 1, float)[:, :axes], ((0, 0), (0, 3 - axes)))
    return points, block(f"TrianglesP{order}", corners + 1, int)[:, :corners] - 1, order


def scaled(rings, scale):
    return [[[scale * x, scale * y] for x, y in ring] for ring in rings]


def written(place, rings):
    geometry = {"type": "Polygon", "coordinates": [ring + ring[:1] for ring in rings]}
    (place / "in.geojson").write_text(json.dumps(geometry))
    return "in.geojson"


def compare(typed, place, vertices, outcome):
    """Counts by kind of outline who fails on it."""
    kind, rings = (place / "kind").read_text(), json.loads((place / "in.geojson").read_text())["coordinates"]
    areas = [abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:]))) / 2 for ring in rings]
    write_edges(place / "in.mesh", rings)
    size = math.sqrt((areas[0] - sum(areas[1:])) / vertices * 2 / math.sqrt(3))
    typed.cases[kind] += 1
    typed.fails[kind, "voronaut"] += outcome != "meshed"
    for peer in typed.peers:
        is_bamg = "bamg" in Path(peer).name
        sized = ["-g", "in.mesh", "-hmax", str(size), "-hmin", str(size / 1e6), "-nbv", "200000"] if is_bamg else ["in.mesh", "-hsiz", str(size)]
        typed.fails[kind, peer] += fails(typed, place, [peer, *sized, *(["-o"] if is_bamg else []), "peer.mesh"], areas)


def fails(typed, place, command, areas):
    out = place / "peer.mesh"
    out.unlink(missing_ok=True)
    try:
        # What a script of pip's starts goes with it.
        with subprocess.Popen(command, cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True) as run:
            try:
                run.wait(60)
            finally:
                if run.poll() is None:
                    os.killpg(run.pid, signal.SIGKILL)
        check = subprocess.run([typed.voronaut, "check", "peer.mesh", "-q"], cwd=place, capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return True
    if check.returncode != 0:
        return True
    area = area_of(out)
    return all(abs(area / allowed - 1) > 0.02 for allowed in (areas[0], areas[0] - sum(areas[1:])))


def write_edges(path, rings):
    """The outline as users of bamg and mmg2d have it: no position twice, no edge of no length."""
    numbers, edges = {}, []
    for ring in rings:
        ends = [numbers.setdefault(tuple(p), len(numbers) + 1) for p in ring]
        edges += [(a, b) for a, b in zip(ends, ends[1:]) if a != b]
    rows = ["MeshVersionFormatted 2", "Dimension 2", f"Vertices {len(numbers)}", *(f"{x!r} {y!r} 0" for x, y in numbers),
            f"Edges {len(edges)}", *(f"{a} {b} 1" for a, b in edges), "End"]
    path.write_text("\n".join(rows) + "\n")


def area_of(path):
    words = path.read_text().split()
    def block(name, width, kind):
        at = words.index(name)
        values = [kind(word) for word in words[at + 2 : at + 2 + width * int(words[at + 1])]]
        return [values[i : i + width] for i in range(0, len(values), width)]
    points = block("Vertices", 3, float)
    corners = [[points[i - 1] for i in t[:3]] for t in block("Triangles", 4, int)]
    return sum(abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) for a, b, c in corners) / 2


def print_table(typed):
    programs = ["voronaut", *typed.peers]
    print("\n| outlines | cases | " + " | ".join(Path(program).name + " fails" for program in programs) + " |")
    print("|---" * (2 + len(programs)) + "|")
    for kind, cases in sorted(typed.cases.items()):
        print(f"| {kind} | {cases} | " + " | ".join(str(typed.fails[kind, program]) for program in programs) + " |")
    totals = [sum(typed.fails[kind, program] for kind in typed.cases) for program in programs]
    print(f"| all | {sum(typed.cases.values())} | " + " | ".join(map(str, totals)) + " |")


def outlines(chance, place):
    n = chance.randint(20, 3000)
    circle = [[math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)] for i in range(n)]
    square = [[0, 0], [1, 0], [1, 1], [0, 1]]
    kind = chance.choice(["jitter", "gap", "spike", "islands", "collinear", "repeated", "comb", "nearly", "teeth"])
    rings = [circle]
    (place / "kind").write_text(kind)
    if kind == "jitter":
        rings = [[[x + chance.uniform(-1e-14, 1e-14), y + chance.uniform(-1e-14, 1e-14)] for x, y in circle]]
    elif kind == "gap":
        gap = 10 ** chance.uniform(-13, -3)
        rings = [square, [[0.3, gap], [0.3, 0.6], [0.7, 0.6], [0.7, gap]]]
    elif kind == "spike":
        width = 10 ** chance.uniform(-14, -2)
        rings = [[[0, 0], [1, 0], [1, 1], [0.5 + width, 1], [0.5, chance.uniform(0.01, 0.9)], [0.5 - width, 1], [0, 1]]]
    elif kind == "islands":
        k = chance.randint(3, 30)
        size = chance.uniform(0.01, 0.49) / k
        rings = [square] + [[[x - size, y - size], [x - size, y + size], [x + size, y + size], [x + size, y - size]]
                            for x in ((i + 0.5) / k for i in range(k)) for y in ((i + 0.5) / k for i in range(k))]
    elif kind == "collinear":
        slope = chance.choice([0, 0.1, 1 / 3])
        rings = [[[i / n, slope * i / n] for i in range(n + 1)] + [[1, 2], [0, 2]]]
    elif kind == "repeated":
        at = chance.randrange(n)
        rings = [circle[: at + 1] + circle[at:]]
    elif kind == "comb":
        depth = chance.choice([0.5, 1e-3, 1e-9])
        rings = [[[i / n, depth * (i % 2)] for i in range(n + 1)] + [[1, 1], [0, 1]]]
    elif kind == "nearly":
        rings = [circle, [[x * (1 - 1e-9), y * (1 - 1e-9)] for x, y in circle]]
    elif kind == "teeth":
        rings = [[[i / n, chance.uniform(-1, 1) * 1e-6] for i in range(n + 1)] + [[1, 1], [0, 1]]]
    return ["mesh", written(place, rings), "--metric", "uniform", "-n", str(chance.choice([100, 1000, 3 * n]))]


def surfaces(chance, place):
    n = chance.randint(4, 30)
    grid = [(i, j) for i in range(n + 1) for j in range(n + 1)]
    bend = chance.choice([lambda u, v: (u, v, 0), lambda u, v: (u, v, 0.3 * math.sin(6 * u) * v),
                          lambda u, v: (math.cos(5 * u), math.sin(5 * u), v), lambda u, v: (u, v, abs(u - 0.5)),
                          lambda u, v: (math.cos(6.2 * u) * (2 + math.cos(6 * v)), math.sin(6.2 * u) * (2 + math.cos(6 * v)), math.sin(6 * v))])
    noise = chance.choice([0, 0, 0.02, 0.2])
    points = [[c + noise / n * chance.uniform(-1, 1) for c in bend(i / n, j / n)] for i, j in grid]
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = (i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1)
            triangles += [[a, b, c], [a, c, d]]
    damage = chance.choice(["", "", "holes", "turned", "double", "points"])
    if damage == "holes":
        triangles = [t for t in triangles if chance.random() > 0.05]
    elif damage == "turned":
        triangles = [t[::-1] if chance.random() < 0.1 else t for t in triangles]
    elif damage == "double":
        triangles += chance.sample(triangles, 3)
    elif damage == "points":
        points += [chance.choice(points) for _ in range(5)]
    scale = 10 ** chance.choice([-6, 0, 0, 0, 6])
    rows = ["v " + " ".join(f"{scale * c!r}" for c in p) for p in points] + ["f " + " ".join(str(v + 1) for v in t) for t in triangles]
    (place / "in.obj").write_text("\n".join(rows) + "\n")
    words = ["mesh", "in.obj", "--metric", chance.choice(["uniform", "curvature"]), "-n", str(int(10 ** chance.uniform(1.5, 3.3)))]
    return words + chance.choice([[], [], ["--fit"], ["--repair"], ["--nr"], ["--hausd", "1"], ["--seeding", "farthest"], ["--dual", "canvas"]])


def signalled(program, place, chance):
    commands = [
        "mesh rect:-2,-2,2,2 --metric swirl -n 8000 -o a.mesh --report a.json --picture a.svg",
        "mesh torus:2,0.7 --metric curvature -n 3000 -o a.vtu",
        "dual rect:0,0,1,1 --metric uniform --seeds ../seeds.txt -o a.mesh --diagram a.vtu",
        "distance rect:0,0,1,1 --metric swirl --from 0.5,0.5 -o a.vtu",
        "convert ../big.mesh a.vtu", "metric ../big.mesh --metric hessian:tanh(9*x) -o a.sol",
        "loop rect:0,0,1,1 --metric hessian:tanh(30*(x-t)) -n 800 --iterations 3 --every -o a.mesh",
        "loop rect:0,0,1,1 --solver sleep\x001;\x00true\x00{mesh}\x00{out} -n 50 --iterations 2 -o a.mesh",
    ]
    work, temporary = place / "work", place / "temporary"
    work.mkdir(), temporary.mkdir()
    (place / "seeds.txt").write_text("".join(f"{chance.random()} {chance.random()}\n" for _ in range(200)))
    words = [word.replace("\x00", " ") for word in chance.choice(commands).split(" ")]
    if "../big.mesh" in words:
        subprocess.run([program, "mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "60000", "--lloyd", "0", "-o", "big.mesh", "-q"],
                       cwd=place, check=True, stdout=subprocess.DEVNULL)
    run = subprocess.Popen([program, *words], cwd=work, env={**os.environ, "TMPDIR": str(temporary)}, stdout=subprocess.DEVNULL,
                           stderr=subprocess.PIPE, text=True)
    time.sleep(chance.uniform(0.01, 1.2))
    sent = time.time()
    run.send_signal(chance.choice([signal.SIGINT, signal.SIGTERM]))
    said = run.communicate()[1]
    late = time.time() - sent
    strays = [file.name for file in work.iterdir() if not file.name.startswith("a.")] + [file.name for file in temporary.iterdir()]
    if strays or late > 1:
        return "stray", f"{' '.join(words)}: {strays}, {late:.2f} s"
    if run.returncode == 0 or run.returncode == 1 and "wrote no solution" in said:
        return "ended", ""
    before = run.returncode in (-signal.SIGINT, -signal.SIGTERM) and not said
    if run.returncode == 1 and "stopped by a signal" in said or before:
        return "stopped", ""
    return "crashed", f"{' '.join(words)}: {run.returncode} {said[-300:]}"


def threads(program, place, chance):
    """A random command with several numbers of threads."""
    is_planar = chance.random() < 0.6
    words = (planar if is_planar else surfaces)(chance, place)
    domain, metric = words[1], words[3]
    repair = ["--repair"] if not is_planar else []
    if quiet(program, place, ["mesh", domain, "--metric", metric, "-n", "200", "-o", "base.mesh", *repair]):
        return "refused", "no first mesh"
    lines = (place / "base.mesh").read_text().split("\n")
    at = lines.index("Vertices") + 2
    points = [line.split()[:-1] for line in lines[at : at + int(lines[at - 1])]]
    xs = [float(point[0]) for point in points]
    extent = max(xs) - min(xs)
    (place / "seeds.txt").write_text("".join(" ".join(point[: 2 if is_planar else 3]) + "\n" for point in points))
    (place / "field.sol").write_text(f"MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n{len(points)}\n1 1\n"
                                     + "".join(f"{i % 7}\n" for i in range(len(points))) + "End\n")
    commands = [words, ["dual", domain, "--metric", metric, "--seeds", "seeds.txt", "--diagram", "{}.vtu", *repair],
                ["distance", domain, "--metric", metric, "--from", ",".join(points[0][: 2 if is_planar else 3]), "-o", "{}.vtu", *repair],
                ["remesh", "base.mesh", "{}.mesh", "-hausd", repr(0.01 * extent)]]
    if is_planar:
        commands += [["metric", "base.mesh", "--metric", "hessian:tanh(9*x)", "--gradation", "1.5", "-o", "{}.sol"],
                     ["loop", "base.mesh", "--metric", "hessian:tanh(9*(x-t))", "-n", "200", "--iterations", "2"],
                     ["interpolate", "base.mesh", "base.mesh", "field.sol", "-o", "{}.sol", "--conservative"]]
    command = chance.choice(commands)
    if not any("{}" in word for word in command) or command[0] == "dual":
        command = [*command, "-o", "{}.mesh"]
    while "--threads" in command:
        del command[command.index("--threads") :][:2]
    found = []
    for count in (1, 2, 3, 8):
        named = [word.replace("{}", f"out{count}") for word in command]
        code = quiet(program, place, [*named, "--threads", str(count)])
        files = sorted(file for file in place.iterdir() if file.name.startswith(f"out{count}"))
        found.append((code, [file.read_bytes() for file in files]))
    said = " ".join(command)
    return ("same" if all(it == found[0] for it in found) and found[0][0] in (0, 1) else "differs", said)


def quiet(program, place, words):
    return subprocess.run([program, *words], cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode


def laws(program, place, chance):
    """A star with islands and a metric, and both transformed."""
    rings = [star(chance, (0, 0), 1, chance.randint(5, 40))]
    rings += [star(chance, (0.1, 0.05), 0.05, chance.randint(3, 8)) for _ in range(chance.randint(0, 1))]
    count, law = str(int(10 ** chance.uniform(1.5, 3.3))), chance.choice(["turned", "scaled", "reordered"])
    angle, scale = (chance.uniform(0, 6) if law == "turned" else 0, 10 ** chance.uniform(-9, 9) if law == "scaled" else 1)
    ratio, size = chance.choice([1, 10, 1000]), chance.choice([0.01, 0.05])
    c, s = math.cos(angle), math.sin(angle)
    tensor = [ratio * c * c + s * s, (ratio - 1) * c * s, ratio * s * s + c * c]
    turned = [[[scale * (c * x - s * y), scale * (s * x + c * y)] for x, y in ring] for ring in rings]
    if law == "reordered":
        turned = [ring[k:] + ring[:k] for ring in rings for k in [chance.randrange(len(ring))]]
    metrics = [[f"uniform:{ratio},0,1", "uniform:" + ",".join(map(repr, tensor))],
               [f"boundary:h0={size},growth=1.5", f"boundary:h0={size * scale!r},growth=1.5"]]
    if law != "turned":
        metrics.append(["formula:1+100*x^2; 0; 1+y^2", f"formula:1+100*(x/{scale!r})^2; 0; 1+(y/{scale!r})^2"])
    pair = chance.choice(metrics)
    found = []
    for outline, metric in zip((rings, turned), pair):
        words = ["mesh", written(place, outline), "--metric", metric, "-n", count, "-o", "out.mesh", "--report", "run.json", "-q"]
        code = quiet(program, place, words)
        found.append(json.loads((place / "run.json").read_text()) if code == 0 else {"code": code})
    said = f"{law}, {pair[0]}, -n {count}, scale {scale:g}, angle {angle:g}"
    if any("code" in report for report in found):
        return ("refused" if found[0] == found[1] == {"code": 1} else "differs"), said
    one, other = found
    shares = [abs(one[part][key] - other[part][key]) for part, key in (("metric_edge_length", "unit_fraction"), ("quality", "mean"))]
    is_alike = abs(one["vertices"] - other["vertices"]) <= max(3, 0.01 * one["vertices"]) and max(shares) <= 0.05
    return ("same" if is_alike else "differs"), f"{said}: {one['vertices']}, {other['vertices']} vertices, {shares}"


if __name__ == "__main__":
    main()
