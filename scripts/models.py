#!/usr/bin/env python3
"""Meshes every model of a folder, and tabulates what comes of it.

    scripts/models.py FOLDER                        # every surface below the folder
    scripts/models.py FOLDER --listed               # those of scripts/models.tsv, found by their checksums
    scripts/models.py FOLDER --only bunny -n 5000 -- --fit   # options for `voronaut mesh`
    scripts/models.py FOLDER --write-list           # print lines for scripts/models.tsv

The models of scripts/models.tsv are public and not part of this project: clone github.com/libigl/libigl-tutorial-data and
github.com/alecjacobson/common-3d-test-models into FOLDER. Each is meshed as it is; where that is refused, with --repair.

outcome: meshed, repaired (meshed with --repair only), refused (exit 1, the message beside it), late (over the time limit),
crashed (any other exit). Of the mesh, by `voronaut check --domain`: vertices; valid; pairs of triangles or vertices of the mesh that
meet where the input meets itself, and those that meet elsewhere; the share of unit edges, mean and least quality in the metric scaled as it was;
needles (quality below 0.05) that features do not force; triangles folded over; root mean square and greatest distance to the input, both ways, as shares of its diagonal. The last line counts.
"""

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIST = ROOT / "scripts/models.tsv"
ENDINGS = {".off", ".obj", ".ply", ".stl", ".mesh", ".meshb", ".msh", ".vtu", ".vtp"}
COLUMNS = ["model", "outcome", "seconds", "vertices", "valid", "input_meets", "ours_meet", "unit", "quality", "least", "loose", "folded",
           "rms", "greatest"]


def main():
    arguments = sys.argv[1:]
    options = []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--listed", action="store_true", help="only models of scripts/models.tsv")
    parser.add_argument("--only", default="", help="only names that contain this")
    parser.add_argument("--write-list", action="store_true")
    parser.add_argument("-n", default="2000", help="vertices; 0 leaves it to the metric")
    parser.add_argument("--metric", default="curvature")
    parser.add_argument("--time-limit", type=float, default=100.0)
    parser.add_argument("--jobs", type=int, default=1, help="models at a time")
    parser.add_argument("--voronaut", default=str(ROOT / "target/release/voronaut"))
    parser.add_argument("--json", type=Path, help="write all rows")
    typed = parser.parse_args(arguments)
    models = found(typed)
    if typed.write_list:
        print("\n".join(f"{checksum(file)}\t{name}" for name, file in models))
        return
    print("\t".join(COLUMNS + ["message"]), flush=True)
    with ThreadPoolExecutor(typed.jobs) as pool:
        rows = list(pool.map(lambda model: one(typed, options, *model), models))
    if typed.json:
        typed.json.write_text(json.dumps(rows, indent=1))
    outcomes = [row["outcome"] for row in rows]
    told = ", ".join(f"{outcomes.count(outcome)} {outcome}" for outcome in sorted(set(outcomes)))
    wrong = sum(1 for row in rows if row["outcome"] in ("meshed", "repaired") and (row.get("valid") != "yes" or row.get("ours_meet")))
    print(f"{len(rows)} models: {told}; {wrong} meshes with faults of ours; {sum(row['seconds'] for row in rows):.0f} s")


def found(typed):
    """Names and files."""
    below = sorted(p for p in typed.folder.rglob("*") if p.suffix.lower() in ENDINGS and p.is_file())
    if typed.listed:
        listed = [line.split("\t") for line in LIST.read_text().splitlines() if line and not line.startswith("#")]
        by_sum = {checksum(file): file for file in below}
        missing = [name for sum_, name in listed if sum_ not in by_sum]
        if missing:
            sys.exit(f"{len(missing)} models of {LIST.name} are not below {typed.folder}: {', '.join(missing)}")
        models = [(name, by_sum[sum_]) for sum_, name in listed]
    else:
        models = [(str(file.relative_to(typed.folder)), file) for file in below]
    return [(name, file) for name, file in models if typed.only in name]


def checksum(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def one(typed, options, name, file):
    """Meshes a model, as it is or else repaired, and prints its row."""
    with tempfile.TemporaryDirectory() as directory:
        row = {"model": name, "seconds": 0.0}
        for repair in ([], ["--repair"]):
            row |= attempt(typed, options + repair, file, Path(directory), row["seconds"])
            if row["outcome"] not in ("refused", "crashed"):
                break
        if row["outcome"] == "meshed" and repair:
            row["outcome"] = "repaired"
    print("\t".join(shown(row.get(column, "")) for column in COLUMNS + ["message"]), flush=True)
    return row


def attempt(typed, options, file, place, before):
    out, report, checked = place / "out.mesh", place / "mesh.json", place / "check.json"
    count = [] if typed.n == "0" else ["-n", typed.n]
    command = [typed.voronaut, "mesh", file, "--metric", typed.metric, *count, *options, "-o", out, "--report", report]
    begin = time.perf_counter()
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=typed.time_limit)
    except subprocess.TimeoutExpired:
        return {"outcome": "late", "seconds": before + time.perf_counter() - begin, "message": ""}
    message = " ".join(run.stderr.split())[:300]
    row = {"seconds": before + time.perf_counter() - begin, "message": message}
    if run.returncode != 0:
        return row | {"outcome": "refused" if run.returncode == 1 else "crashed"}
    figures = json.loads(report.read_text())
    repair = [word for word in options if word == "--repair"]
    subprocess.run([typed.voronaut, "check", out, "--metric", typed.metric, "--metric-scale", str(figures["metric_scale"]), "--domain", file,
                    *repair, "--report", checked], capture_output=True, text=True)
    needles = figures["unmet"]["needles"]
    loose = {"loose": needles["count"] - needles["forced"]}
    return row | {"outcome": "meshed", "message": " | ".join(figures["notes"])} | loose | of_mesh(json.loads(checked.read_text()))


def of_mesh(figures):
    fidelity = figures["fidelity"] or {}
    meetings = figures.get("meetings") or {}
    return {
        "vertices": figures["vertices"],
        "valid": "yes" if figures["valid"] else "NO",
        "input_meets": meetings.get("count", 0),
        "ours_meet": figures["overlaps"] + figures["duplicate_vertices"],
        "unit": figures["metric_edge_length"]["unit_fraction"],
        "quality": figures["quality"]["mean"],
        "least": figures["quality"]["min"],
        "folded": fidelity.get("folded", ""),
        "rms": fidelity.get("rms_share", ""),
        "greatest": fidelity.get("hausdorff_share", ""),
    }


def shown(value):
    return f"{value:.3g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    main()
