#!/usr/bin/env python3
"""Writes python/voronaut/_commands.py from the options that the commands declare: names, defaults, help.

    scripts/declare.py            # with the package installed
    scripts/declare.py --check    # whether the file is what comes out

Options of files and of terminals are left out; what several functions take besides stands below.
"""

import argparse
import importlib.machinery
import importlib.util
import json
import re
import sys
import textwrap
from pathlib import Path

PLACE = Path(__file__).resolve().parent.parent / "python/voronaut/_commands.py"
WIDTH = 120
# Options of every command that functions have no use for.
TERMINAL = {"out", "report", "quiet", "verbose", "verbosity", "help", "version"}
INTEGERS = {"N", "STEPS", "SWEEPS", "K", "PIXELS"}
NUMBERS = {"H", "D", "C", "RATIO", "FACTOR", "DEGREES", "SHARE", "SECONDS", "GIB", "G", "MB"}
FILES = {"FILE", "MESH"}
UNITS = {"GIB": "GiB", "SECONDS": "seconds", "DEGREES": "degrees"}

DOMAIN = ("domain : file, shape, arrays, mesh or object with `__geo_interface__`", "What to mesh: `\"rect:0,0,2,1\"`, "
          "`\"wing.mesh\"`, `\"sphere:1\"`, a tuple of points (N, 2) and segments (K, 2), of points (N, 3) and triangles (M, 3), "
          "with labels as a third if there are some; a mesh of voronaut, pyvista or meshio.")
METRIC = ("metric : Metric, number, text, array or function", "Sizes and directions: one size, what the command line has (`\"uniform\"`, `\"swirl\"`, "
          "`\"curvature\"`, `\"hessian:EXPR\"`, `\"formula:m11; m12; m22\"`, `\"boundary:h0=0.1\"`, `\"FILE.sol\"`), sizes or tensors at "
          "the domain's vertices, or a function of points.")
PROGRESS = ("progress : bool or function, default False", "True shows a bar; a function is called with the stage, how much is done and "
            "of how much, and stops the work where it returns False.")
FUNCTIONS = {
    "mesh": {
        "command": "mesh", "parameters": [("domain", "object", None), ("metric", "MetricLike", None), ("n", "int | None", "None")],
        "title": "Meshes a domain: valid, with edges of length one in a metric.",
        "docs": [DOMAIN, METRIC, ("n : int, optional", "Vertices; one factor scales the metric to meet it.")],
        "skip": {"domain", "metric", "vertices", "parts", "parts_dir", "part"}, "returns": ("Mesh", "With the command's report."),
        "example": ">>> layer = voronaut.mesh(\"rect:0,0,1,1\", lambda p: 0.01 + 0.2 * abs(p[:, 1] - 0.5), n=2000)",
    },
    "dual": {
        "command": "dual", "parameters": [("domain", "object", None), ("metric", "MetricLike", None), ("seeds", "npt.ArrayLike", None)],
        "title": "The dual of the Riemannian Voronoi diagram of the seeds given: none is added or moved.",
        "docs": [DOMAIN, METRIC, ("seeds : (N, 2) or (N, 3) array", "Seed i is vertex i.")],
        "skip": {"domain", "metric", "seeds", "diagram"},
        "returns": ("Mesh", "With the report, and in `diagram` the canvas: fields `colour` (seeds from 0) and `distance`."),
        "example": ">>> rdt = voronaut.dual(\"rect:-2,-2,2,2\", \"swirl\", seeds)",
    },
    "distance": {
        "command": "distance",
        "parameters": [("domain", "object", None), ("metric", "MetricLike", None), ("start", "npt.ArrayLike", None),
                       ("to", "npt.ArrayLike | None", "None")],
        "title": "Distances in a metric from points to everywhere, and the shortest path to one.",
        "docs": [DOMAIN, METRIC, ("start : point or (N, 2), (N, 3) array", "Where distances start."),
                 ("to : point, optional", "Where a path leads; its points come behind the canvas's, its segments are the mesh's edges.")],
        "skip": {"domain", "metric", "from", "to"}, "returns": ("Mesh", "The canvas, with the field `distance`, and the report."),
        "example": ">>> far = voronaut.distance(\"rect:-2,-2,2,2\", \"swirl\", (1, 0.5))",
    },
    "check": {
        "command": "check", "parameters": [("mesh", "object", None), ("metric", "MetricLike | None", "None"), ("domain", "object | None", "None")],
        "title": "Examines a mesh: validity, quality in a metric, distance to its domain.",
        "docs": [("mesh : Mesh, file or arrays", "What to examine."), METRIC, ("domain : as for `mesh`, optional", "What it should be a mesh of.")],
        "skip": {"mesh", "metric", "domain"}, "returns": ("dict", "The report; of a mesh that is not valid `valid`, False, and `fault`."),
        "example": ">>> voronaut.check(layer)[\"valid\"]\n    True",
    },
    "remesh": {
        "command": "remesh", "parameters": [("mesh", "object", None), ("metric", "npt.ArrayLike | None", "None")],
        "title": "Meshes a planar mesh or a surface anew, with the options of mmg2d and mmgs.",
        "docs": [("mesh : Mesh, file or arrays", "What to remesh."), ("metric : array, optional", "Sizes or tensors at its vertices.")],
        "skip": {"first", "second", "input", "sol", "memory", "tensor_order", "hgradreq", "noinsert", "noswap", "nomove", "nreg", "xreg",
                 "rmc", "nofem", "keep_ref", "medit", "debug"},
        "returns": ("Mesh", "With the report, and the metric that was used as the field `metric`."),
        "example": ">>> fine = voronaut.remesh(\"part.mesh\", hausd=0.001, hmax=0.1)",
    },
    "transfer": {
        "command": "interpolate", "parameters": [("old", "object", None), ("new", "object", None),
                                                ("fields", "Mapping[str, npt.ArrayLike] | npt.ArrayLike", None)],
        "title": "Carries fields from one planar mesh to another of the same domain.",
        "docs": [("old, new : Mesh, file or arrays", "The meshes."),
                 ("fields : array, or mapping of names to arrays", "At the vertices of the old mesh, linear between them, or one for each "
                  "of its triangles. Symmetric tensors (N, 2, 2) are taken for metrics, unless `linear_tensors`.")],
        "skip": {"old", "new", "field"}, "returns": ("array, or dict of arrays", "As the fields are given."),
        "example": ">>> u_new = voronaut.transfer(old, new, u, conservative=True)",
    },
    "view": {
        "command": "view", "parameters": [("meshes", "object", None), ("metric", "MetricLike | None", "None")],
        "title": "A page to look at meshes with: in a notebook, or in a file that any browser opens, without a network.",
        "docs": [("meshes : Mesh, file, arrays, or list of these", "What to show; of several, one after the other or two side by side."), METRIC],
        "skip": {"meshes", "metric", "sol"},
        "returns": ("Page", "Notebooks show it; `save(path)` writes it. Without `metric_scale` the metric is scaled as that of the mesh was."),
        "example": ">>> voronaut.view(layer, cells=True, metric=\"swirl\").save(\"layer.html\")",
    },
}

HEAD = '''"""What users call. Written by scripts/declare.py from what the commands declare: change it there."""

# ruff: noqa

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Union

import numpy.typing as npt

from . import _run
from ._mesh import Mesh
from ._metric import MetricLike
from ._page import Page
from ._run import Progress

File = Union[str, "os.PathLike[str]"]


def adapt(
    mesh: Any,
    *metrics: MetricLike,
    n: int,
    fields: bool = True,
    progress: Progress = False,
    **options: Any,
) -> Mesh:
    """Adapts a planar mesh to metrics: as fine as each of them, with so many vertices.

    Parameters
    ----------
    mesh : Mesh, mesh of pyvista or meshio, or tuple of points and triangles
        Its boundary, interfaces and labels are kept.
    *metrics : Metric, text, array or function
        Each is made of one complexity first, so that units do not matter; `Metric.from_hessian` is for the least error.
    n : int
        Vertices.
    fields : bool, default True
        Whether the mesh's fields are carried over.
    progress : bool or function, default False
        As for `mesh`.
    **options
        As for `mesh`.

    Returns
    -------
    Mesh

    Examples
    --------
    >>> adapted = voronaut.adapt(mesh, voronaut.Metric.from_hessian(u, mesh), n=2000)
    """
    return _run.adapt(mesh, metrics, n, fields, options, progress)
'''


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    is_check = parser.parse_args().check
    commands = json.loads(extension().commands())
    text = HEAD + "".join(function(name, spec, commands[spec["command"]]) for name, spec in FUNCTIONS.items())
    if not is_check:
        PLACE.write_text(text)
    elif PLACE.read_text() != text:
        sys.exit(f"{PLACE.name} is not what the commands declare: run scripts/declare.py")


def extension():
    """The extension alone: the package may not be there yet."""
    found = importlib.util.find_spec("voronaut")
    folders = list(found.submodule_search_locations) if found else []
    files = [file for folder in folders for file in Path(folder).glob("_voronaut*") if file.suffix in (".so", ".pyd")]
    if not files:
        sys.exit("the package is not installed: pip install .")
    loader = importlib.machinery.ExtensionFileLoader("_voronaut", str(files[0]))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("_voronaut", loader))
    loader.exec_module(module)
    return module


def function(name, spec, command):
    options = [it for it in command["options"] if it["name"] not in spec["skip"] | TERMINAL]
    types = {option["name"]: kind(option) for option in options}
    lines = [f"    {key}: {of}{f' = {default}' if default else ''}," for key, of, default in spec["parameters"]]
    lines += ["    *,", *(f"    {it['name']}: {types[it['name']]} = {default(it)}," for it in options)]
    lines.append("    progress: Progress = False,")
    docs = "".join(described(*it) for it in spec["docs"])
    docs += "".join(described(f"{it['name']} : {shown(types[it['name']], it)}", keywords(it["help"]) + choices(it)) for it in options)
    docs += described(*PROGRESS)
    given = ", ".join(f'"{it["name"]}": {it["name"]}' for it in options)
    defaults = ", ".join(f'"{it["name"]}": {default(it)}' for it in options if it["default"] is not None)
    names = ", ".join(key for key, *_ in spec["parameters"])
    of = {"mesh": "Mesh", "dual": "Mesh", "distance": "Mesh", "remesh": "Mesh", "check": "dict[str, Any]", "transfer": "Any", "view": "Page"}[name]
    return (
        f"\n\ndef {name}(\n" + "\n".join(lines) + f"\n) -> {of}:\n"
        f'    """{spec["title"]}\n\n    Parameters\n    ----------\n{docs}\n    Returns\n    -------\n'
        f"{described(*spec['returns'])}\n    Examples\n    --------\n    {spec['example']}\n    \"\"\"\n"
        f"    options = {{{given}}}\n    defaults: dict[str, Any] = {{{defaults}}}\n"
        f"    return _run.{name}({names}, options, defaults, progress)\n"
    )


def kind(option):
    if option["is_flag"]:
        return "bool"
    value, given = option["value"], option["default"]
    if option["name"] == "norm":
        return "float | str"
    if option["name"] == "periodic":
        return "str | tuple[int, int] | list[tuple[int, int]] | None"
    if given is not None and value in INTEGERS and not option["choices"]:
        return "int | str" if option["name"] == "canvas_size" else "int"
    found = "int" if value in INTEGERS else "float" if value in NUMBERS else "File" if value in FILES else "str"
    return found if given is not None else f"{found} | None"


def default(option):
    if option["is_flag"]:
        return "False"
    given = option["default"]
    if given is None:
        return "None"
    return given if re.fullmatch(r"-?\d+(\.\d+)?(e-?\d+)?", given) else repr(given)


def choices(option):
    """What it may be, where its help does not say so."""
    unsaid = [it for it in option["choices"] if it not in (option["help"] or "")]
    return f": {', '.join(option['choices'])}" if unsaid and not option["is_flag"] else ""


def shown(of, option):
    unit = f" ({UNITS[option['value']]})" if option["value"] in UNITS else ""
    rest = ", optional" if default(option) == "None" else f", default {default(option)}"
    return of.removesuffix(" | None") + unit + rest


def keywords(text):
    """Flags as keywords: --canvas-size becomes canvas_size."""
    return re.sub(r"--([a-z][a-z-]*)", lambda found: found[1].replace("-", "_"), text or "").replace("`-n`", "`n`").replace(" -n ", " n ")


def described(head, text):
    body = textwrap.fill(text, WIDTH, initial_indent=" " * 8, subsequent_indent=" " * 8, break_on_hyphens=False)
    return f"    {head}\n{body}\n"


if __name__ == "__main__":
    main()
