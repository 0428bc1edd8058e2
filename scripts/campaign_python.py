#!/usr/bin/env python3
"""Calls the package with random arguments, replayable by their seeds, and counts what comes of it.

    scripts/campaign_python.py -n 10000        # with the package installed
    scripts/campaign_python.py --seed 17 -n 1 -v    # case 17 again, with its call

Arguments are those of calls that work, spoilt: other types, shapes and orders, huge and empty arrays, strided, read-only, float32,
masked, not finite; options are any, with any value. Calls run in a process of their own, so that its end is seen.

outcome: done, refused (an exception that says what is wrong: counted by its class), wrong (another exception), crashed, hung (over 60 s).
The last line counts; the exit code is 1 if there is anything but done and refused.
"""

import argparse
import inspect
import os
import random
import select
import subprocess
import sys
import tempfile
import traceback
from collections import Counter

# What calls may end with besides the package's own errors; the last is raised by a function of ours.
REFUSED = (TypeError, ValueError, MemoryError, OSError, ZeroDivisionError)
LIMIT = 60


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", type=int, default=1000, help="cases")
    parser.add_argument("--seed", type=int, default=0, help="of the first case")
    parser.add_argument("-v", action="store_true", help="say each case")
    parser.add_argument("--calls", action="store_true", help=argparse.SUPPRESS)
    typed = parser.parse_args()
    if typed.calls:
        return calls(range(typed.seed, typed.seed + typed.n))
    counts, reasons, seed = Counter(), Counter(), typed.seed
    while seed < typed.seed + typed.n:
        for outcome, said in watched(seed, typed.seed + typed.n - seed):
            counts[outcome] += 1
            if outcome == "refused":
                reasons[said.split(":")[0]] += 1
            if typed.v or outcome not in ("done", "refused"):
                print(f"{seed}\t{outcome}\t{said}", flush=True)
            seed += 1
    for reason, count in reasons.most_common():
        print(f"refused {count}: {reason}")
    print(", ".join(f"{counts[outcome]} {outcome}" for outcome in sorted(counts)))
    sys.exit(any(outcome not in ("done", "refused") for outcome in counts))


def watched(seed, count):
    """The outcomes of calls in a process of their own, up to the one that ends it."""
    words = [sys.executable, __file__, "--calls", "--seed", str(seed), "-n", str(count)]
    with tempfile.TemporaryDirectory() as folder, subprocess.Popen(
        words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        rest = b""
        for _ in range(count):
            while b"\n" not in rest:
                if not select.select([process.stdout], [], [], LIMIT)[0]:
                    process.kill()
                    yield "hung", f"over {LIMIT} s"
                    return
                more = os.read(process.stdout.fileno(), 1 << 16)
                if not more:
                    yield "crashed", f"exit code {process.wait()}"
                    return
                rest += more
            line, _, rest = rest.partition(b"\n")
            yield tuple(line.decode().split("\t", 1))


def calls(seeds):
    """Makes the calls, and says a line of each."""
    import voronaut

    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    for seed in seeds:
        name, arguments, options = call_of(random.Random(f"python {seed}"))
        said = f"{name}({', '.join([*map(brief, arguments), *(f'{key}={brief(value)}' for key, value in options.items())])})"
        try:
            functions_of(voronaut)[name](*arguments, **options)
            outcome = "done"
        except BaseException as error:
            kind = type(error).__name__
            expected = isinstance(error, (voronaut.Error, *REFUSED))
            outcome = "refused" if expected and str(error) else "wrong"
            where = "" if outcome == "refused" else traceback.format_exc().replace("\n", " | ")
            said = f"{kind}: {str(error)[:160]!r} of {said} {where}"
        out.write(f"{outcome}\t{said}\n".replace("\n", " ").rstrip() + "\n")
        out.flush()


def functions_of(voronaut):
    """What is called, by its name."""
    metric, mesh = voronaut.Metric, voronaut.Mesh
    return {
        **{name: getattr(voronaut, name) for name in ("mesh", "dual", "distance", "check", "remesh", "transfer", "adapt", "convert")},
        "at": lambda value, on: metric.of(value, on).at(on), "combined": lambda a, b, on: (metric.of(a, on) & b).limit(h_min=1e-3).at(on),
        "hessian": lambda values, on: metric.from_hessian(values, on).at(on), "uniform": metric.uniform,
        "Mesh": lambda points, cells, **more: mesh(points, cells, **more)._repr_html_(),
        "save": lambda points, cells, path, **more: mesh(points, cells, **more).save(path), "read": mesh.read,
        "at_vertices": voronaut.at_vertices,
    }  # fmt: skip


def call_of(chance):
    """A call: its name, its arguments, some of them spoilt, and options."""
    name, arguments, options = chance.choice(templates(chance))
    arguments = [spoilt(chance, it) if chance.random() < 0.25 else it for it in arguments]
    options = {key: spoilt(chance, it) if chance.random() < 0.25 else it for key, it in options.items()}
    if name in ("mesh", "dual", "distance", "check", "remesh", "transfer"):
        options |= any_options(chance, name)
    return name, arguments, options


def templates(chance):
    """Calls that work."""
    import numpy as np

    square, sides, halves = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1], [1, 2], [2, 3], [3, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    tetrahedron = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
    geo = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}
    domain = chance.choice(["rect:0,0,1,1", (square, sides), (square, halves), (square, sides, [1, 2, 3, 4]), tetrahedron, geo, "sphere:1"])
    flat, sizes = (square, halves), np.full(4, 0.2)
    function = chance.choice([lambda p: 0.1 + 0.1 * p[:, 0], lambda p: np.tile(np.eye(2) * 9, (len(p), 1, 1)), lambda p: p])
    metric = chance.choice(["uniform", "swirl", "curvature", "formula:1;0;2", function, sizes, np.tile(np.eye(2), (4, 1, 1))])
    seeds = np.array([[0.2, 0.3], [0.7, 0.4], [0.5, 0.8], [0.6, 0.1]])
    return [
        *[("mesh", [domain, metric, 30], {})] * 3, ("mesh", [flat, sizes, 30], {}), ("dual", ["rect:0,0,1,1", metric, seeds], {}),
        ("distance", [domain, metric, (0.1, 0.2), (0.8, 0.5)], {"canvas_size": 500}), ("check", [flat, metric, domain], {}),
        ("remesh", [flat, sizes], {}), ("transfer", [flat, flat, {"u": np.arange(4.0), "cells": np.ones(2)}], {}),
        ("transfer", [flat, flat, square], {}), ("adapt", [flat, metric], {"n": 30}), ("convert", ["a.mesh", "b.vtu"], {}),
        ("at", [metric, flat], {}), ("combined", [metric, sizes, flat], {}), ("hessian", [np.arange(4.0), flat], {}),
        ("uniform", [chance.choice([0.1, np.eye(2)])], {}), ("Mesh", [square, halves], {"edges": sides, "fields": {"u": np.ones(4)}}),
        ("save", [square, halves, chance.choice(["a.mesh", "a.meshb", "a.vtu", "a.sol", "a.ply"])], {"triangle_labels": [1, 2], "fields": {"u": sizes}}),
        ("read", [chance.choice(["a.mesh", "a.meshb", "a.vtu", "a.sol", "a.none"])], {}),
        ("at_vertices", [flat, [metric, sizes]], {"complexity": 50, "h_min": 0.01, "weights": [1, 2]}),
    ]  # fmt: skip


def any_options(chance, name):
    """Some of a function's options, with values that they may have or not."""
    from voronaut import _commands

    known = [key for key, it in inspect.signature(getattr(_commands, name)).parameters.items() if it.kind is it.KEYWORD_ONLY]
    known = [key for key in known if key not in ("threads", "memory_limit", "time_limit", "canvas_size", "pixels")]
    words = ["march", "starset", "sizing", "protected", "canvas", "a.svg", "a.png", "fit", "none"]
    values = [True, False, None, 1, 2, 0.1, 1.3, -1, 10**30, float("nan"), *words, (0, 0, 1, 1), lambda *_: None, lambda *_: False]
    return {key: chance.choice(values) for key in chance.sample(known, min(len(known), chance.choice([0, 0, 1, 2])))}


def spoilt(chance, value):
    """The value as something else, or an array of it in another form."""
    import numpy as np

    odd = [None, True, -1, 0, 3.5, "", "a", "a\0b", "\ud800", b"a", [], {}, (), object(), float("nan"), 10**30, [[]], [[1], [1, 2]], np.array(3),
           np.zeros((0, 2)), np.zeros((2, 2, 2)), np.array(["a"]), np.array([None]), np.zeros(3, complex), np.array(["2020-01-01"], "M8[D]"),
           np.broadcast_to(1.0, (10**15, 2)), np.zeros((200_000, 2)), np.zeros((0, 3), np.int8), lambda p: p, lambda p: 1 / 0]  # fmt: skip
    if isinstance(value, tuple) and value and chance.random() < 0.7:
        parts = list(value)
        place = chance.randrange(len(parts))
        parts[place] = spoilt(chance, parts[place])
        return tuple(parts)
    if isinstance(value, dict) and value and chance.random() < 0.7:
        return {key: spoilt(chance, it) for key, it in value.items()}
    if not isinstance(value, np.ndarray) or chance.random() < 0.2:
        return chance.choice(odd)
    return another(chance, value)


def another(chance, array):
    """The array in another type, shape or order, or with another entry."""
    import numpy as np

    entry = np.array(array, dtype=chance.choice([float, np.int64, np.int32]), copy=True)
    if entry.size:
        bad = [float("nan"), float("inf"), -1.0, 1e300, 1e-300, 5e-324, 2.0**31, 0.5] if entry.dtype == float else [-1, 2**31 - 1, 99]
        entry.reshape(-1)[chance.randrange(entry.size)] = chance.choice(bad)
    read_only = array.copy()
    read_only.flags.writeable = False
    forms = [
        entry, entry, read_only, np.repeat(array, 2, axis=0)[::2], array[::-1], np.asfortranarray(array), array.T, array[:0], array[:-1], array[None],
        array.ravel(), array.astype(chance.choice(["f4", "f2", "i1", "u1", "u8", ">f8", ">i4", "c16", "O", "S9", "?"])), np.ma.masked_equal(array, 0),
        np.ma.masked_array(array), np.repeat(array, 50_000 if array.dtype.kind == "f" else 500, axis=0), np.broadcast_to(array, (3, *array.shape)), array.tolist(), array * 1e200, array * 0,
    ]  # fmt: skip
    return chance.choice(forms)


def brief(value):
    """The value as a few words."""
    shape = getattr(value, "shape", None)
    if isinstance(value, (tuple, list)) and len(value) < 6:
        return f"({', '.join(map(brief, value))})"
    return f"{value.dtype}{shape}" if shape is not None and len(shape) else repr(value)[:60]


if __name__ == "__main__":
    main()
