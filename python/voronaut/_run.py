"""Commands of voronaut on what users hold: what the generated functions call."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _given, _voronaut
from ._errors import MeshError
from ._mesh import Mesh, _values
from ._metric import Metric, MetricLike
from ._page import Page

Progress = Union[bool, Callable[[str, int, int], object]]
Options = dict[str, Any]
Held = dict[str, dict[str, Any]]


def mesh(domain: object, metric: MetricLike, n: int | None, options: Options, defaults: Options, progress: Progress) -> Mesh:
    held: Held = {}
    words = {"domain": _given.domain_word(domain, held), "metric": _metric_word(metric, held, domain), "vertices": n, "out": "mesh"}
    return _mesh_of(_perform("mesh", words, options, defaults, held, progress))


def mesh_in_parts(
    domain: object,
    metric: MetricLike,
    n: int,
    options: Options,
    make: Callable[[str, list[tuple[dict[str, Any], int, dict[str, Any] | None]]], Iterable[dict[str, Any]]],
    progress: Progress,
) -> Mesh:
    held: Held = {"parts": {"maker": make}}
    words = {"domain": _given.domain_word(domain, held), "metric": _metric_word(metric, held, domain), "vertices": n, "out": "mesh"}
    return _mesh_of(_perform("mesh", words, options, {}, held, progress))


def part(
    domain: object,
    metric: MetricLike,
    n: int,
    of_part: tuple[dict[str, Any], int, dict[str, Any] | None],
    options: Options,
    progress: Progress,
) -> dict[str, Any]:
    """The arrays of one part of a mesh. Where it has a metric of its own, neither domain nor metric of the whole are looked at."""
    held: Held = {}
    shape, vertices, own = of_part
    words: Options = {"domain": "part", "metric": "part", "vertices": n, "out": "mesh", "part": f"{vertices},part-job.mesh"}
    if own is None:
        words |= {"domain": _given.domain_word(domain, held), "metric": _metric_word(metric, held, domain)}
    documents = held.setdefault("documents", {})
    documents["part-job.mesh"] = shape
    if own is not None:
        documents["part-metric.mesh"] = own
    made: dict[str, Any] = _perform("mesh", words, options, {}, held, progress)["mesh"]
    return made


def dual(
    domain: object, metric: MetricLike, seeds: npt.ArrayLike, options: Options, defaults: Options, progress: Progress
) -> Mesh:
    held: Held = {}
    words = {"domain": _given.domain_word(domain, held), "metric": _metric_word(metric, held, domain), "seeds": "seeds", "out": "mesh"}
    held["seeds"] = {"seeds": _given.floats("seeds", seeds, (2, 3))}
    told = _perform("dual", words, options, defaults, held, progress)
    made = _mesh_of(told)
    made.diagram = canvas = _canvas_of(told)
    canvas.fields["colour"] = canvas.point_labels
    return made


def distance(
    domain: object, metric: MetricLike, start: npt.ArrayLike, to: npt.ArrayLike | None, options: Options, defaults: Options, progress: Progress
) -> Mesh:
    held: Held = {}
    starts = _given.floats("start", np.atleast_2d(np.asarray(start)), (2, 3))
    words: Options = {"domain": _given.domain_word(domain, held), "metric": _metric_word(metric, held, domain), "out": "canvas.vtu"}
    words["from"] = [_given.text_of("start", point) for point in starts]
    words["to"] = None if to is None else _given.text_of("to", _given.floats("to", to))
    told = _perform("distance", words, options, defaults, held, progress)
    made = _canvas_of(told)
    made.report = json.loads(told["report"])
    return made


def check(
    mesh: object, metric: MetricLike | None, domain: object | None, options: Options, defaults: Options, progress: Progress
) -> dict[str, Any]:
    held: Held = {}
    words = {"mesh": _given.mesh_word(mesh, held, "mesh")}
    if metric is not None:
        words["metric"] = _metric_word(metric, held, mesh if domain is None else domain)
    if domain is not None:
        words["domain"] = _given.domain_word(domain, held)
    try:
        found: dict[str, Any] = json.loads(_perform("check", words, options, defaults, held, progress)["report"])
    except MeshError as error:
        return {"valid": False, "fault": error.what}
    return found


def remesh(mesh: object, metric: npt.ArrayLike | None, options: Options, defaults: Options, progress: Progress) -> Mesh:
    held: Held = {}
    words: Options = {"input": _given.mesh_word(mesh, held, "mesh"), "out": "made.mesh"}
    if metric is not None:
        arrays = held.get("documents", {}).get("mesh")
        count = None if arrays is None else len(arrays["points"])
        held["solutions"] = {"sol": {"vertex_fields": {"metric": _given.tensor_values("metric", metric, count)}}}
        words["sol"] = "sol"
    told = _perform("remesh", words, options, defaults, held, progress)
    made = _mesh_of(told)
    made.fields["metric"] = _values(told["solutions"][0][0])
    return made


def transfer(
    old: object,
    new: object,
    fields: Mapping[str, npt.ArrayLike] | npt.ArrayLike,
    options: Options,
    defaults: Options,
    progress: Progress,
) -> Any:
    held: Held = {}
    # Which fields are of vertices and which of triangles is seen by their numbers.
    of_arrays = Mesh.read(old) if isinstance(old, (str, os.PathLike)) else old
    words: Options = {"old": _given.mesh_word(of_arrays, held, "old"), "new": _given.mesh_word(new, held, "new")}
    words |= {"field": "fields", "out": "carried"}
    named = dict(fields) if isinstance(fields, Mapping) else {"": fields}
    places, document = _fields_of(named, held["documents"]["old"])
    held["solutions"] = {"fields": document}
    carried = iter_solutions(_perform("interpolate", words, options, defaults, held, progress)["solutions"])
    found = {name: carried[place].pop(0) for name, place in places}
    return found if isinstance(fields, Mapping) else found[""]


def view(meshes: object, metric: MetricLike | None, options: Options, defaults: Options, progress: Progress) -> Page:
    held: Held = {}
    given = list(meshes) if isinstance(meshes, list) else [meshes]
    if not given:
        raise ValueError("meshes: there is none")
    names = ["mesh"] if len(given) == 1 else [f"mesh {i}" for i in range(1, len(given) + 1)]
    words: Options = {"meshes": [_given.mesh_word(mesh, held, name) for mesh, name in zip(given, names)], "out": "page.html"}
    if metric is not None:
        words["metric"] = _metric_word(metric, held, given[0])
        if len(given) == 1 and isinstance(given[0], Mesh) and options.get("metric_scale") is None:
            options = {**options, "metric_scale": given[0].metric_scale}
    return Page(_perform("view", words, options, defaults, held, progress)["page"])


def iter_solutions(solutions: list[list[Any]]) -> dict[str, list[npt.NDArray[Any]]]:
    """The values of vertices and of triangles, in their order."""
    return {place: [_values(found) for found in all_of] for place, all_of in zip(("vertices", "triangles"), solutions)}


def _fields_of(named: dict[str, npt.ArrayLike], arrays: dict[str, Any]) -> tuple[list[tuple[str, str]], dict[str, Any]]:
    """Where each field belongs, by its length, and all of them as the extension has them."""
    counts = {"vertices": len(arrays["points"]), "triangles": len(arrays["triangles"])}
    places: list[tuple[str, str]] = []
    kinds: dict[str, dict[str, Any]] = {"vertices": {}, "triangles": {}}
    for name, given in named.items():
        label = f"fields[{name!r}]" if name else "fields"
        values = _given.values(label, given)
        place = next((place for place, count in counts.items() if count == len(values[1])), None)
        if place is None:
            raise ValueError(f"{label}: {len(values[1])} entries, and the old mesh has {counts['vertices']} vertices and {counts['triangles']} triangles")
        places.append((name, place))
        kinds[place][str(len(kinds[place]))] = values
    return places, {"points": arrays["points"][:1], "vertex_fields": kinds["vertices"], "triangle_fields": kinds["triangles"]}


def adapt(mesh: Any, metrics: tuple[MetricLike, ...], n: int, fields: bool, options: Options, progress: Progress) -> Mesh:
    from ._commands import mesh as make
    from ._commands import transfer as carry
    from ._metric import at_vertices

    own = mesh if isinstance(mesh, Mesh) else Mesh(*_points_and_triangles(mesh))
    tensors, _ = at_vertices(own, [Metric.of(metric, own) for metric in metrics], complexity=n / 1.15)
    made = make(own, Metric.from_array(tensors, own), n, progress=progress, **options)
    if fields and (own.fields or own.triangle_fields):
        made.fields = carry(own, made, own.fields) if own.fields else {}
        made.triangle_fields = carry(own, made, own.triangle_fields) if own.triangle_fields else {}
    return made


def _points_and_triangles(mesh: object) -> tuple[Any, Any]:
    arrays = _given.mesh_arrays("mesh", mesh)
    return arrays["points"], arrays["triangles"].astype(np.int32)


def _metric_word(metric: MetricLike, held: Held, domain: object) -> str:
    if isinstance(metric, str):
        return metric
    on = domain if isinstance(domain, Mesh) or hasattr(domain, "points") or isinstance(domain, tuple) else None
    held["metrics"] = {"metric": Metric.of(metric, on)._description}
    return "metric"


def _perform(
    command: str, words: Options, options: Options, defaults: Options, held: Held, progress: Progress
) -> dict[str, Any]:
    asked = {name: value for name, value in options.items() if value is not None and value != defaults.get(name)}
    texts: list[tuple[str, list[str]]] = []
    for name, value in {**words, **asked}.items():
        if value is None or value is False:
            continue
        if value is True:
            texts.append((name, []))
        elif isinstance(value, list) and name in ("from", "meshes"):
            texts.append((name, value))
        else:
            texts.append((name, [_given.text_of("n" if name == "vertices" else name, value)]))
    try:
        told = _voronaut.perform(command, texts, held, _callback(progress))
    finally:
        if progress is True:
            print(file=sys.stderr)
    sys.stderr.writelines(f"voronaut: {warning}\n" for warning in told["warnings"])
    return told


def _callback(progress: Progress) -> Callable[[str, int, int], object] | None:
    if progress is False or progress is None:
        return None
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress: True, False or a function is expected, not {type(progress).__name__}")
        return progress

    def bar(stage: str, done: int, total: int) -> None:
        share = done / max(total, 1)
        print(f"\r{stage:<16} {'━' * round(40 * share):<40} {100 * share:3.0f} %", end="", file=sys.stderr, flush=True)

    return bar


def _mesh_of(told: dict[str, Any]) -> Mesh:
    return Mesh._of(told["mesh"], json.loads(told["report"]))


def _canvas_of(told: dict[str, Any]) -> Mesh:
    canvas = Mesh._of(told["canvas"])
    canvas.fields["distance"] = told["distances"]
    return canvas
