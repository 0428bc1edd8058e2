"""Voronaut inside pyvista: `mesh.voronaut.remesh(n=2000, metric="curvature")`, `.adapt("u", n=...)`, `.check()`.

pyvista 0.48 and later imports this by its entry point. Meshes come and go with their point and cell data.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista

from . import _commands
from ._mesh import Mesh
from ._metric import Metric
from .pyvista import from_pyvista, to_pyvista


@pyvista.register_dataset_accessor("voronaut", pyvista.DataSet)
class Accessor:
    """What `mesh.voronaut` offers; results are `pyvista.PolyData` again."""

    def __init__(self, data: Any) -> None:
        self._data = data

    def remesh(self, n: int | None = None, metric: Any = "uniform", **options: Any) -> Any:
        """The surface, or the planar domain, anew: see `voronaut.mesh`. Point and cell data are carried in the plane."""
        own = from_pyvista(self._data)
        made = _commands.mesh(own, metric, n, **options)
        made.fields.update(_carried(own, made, own.fields))
        made.triangle_fields.update(_carried(own, made, own.triangle_fields))
        return to_pyvista(made)

    def adapt(self, *metrics: Any, n: int, **options: Any) -> Any:
        """The planar mesh adapted to its point data, by name, or to metrics: see `voronaut.adapt`."""
        own = from_pyvista(self._data)
        given = [Metric.from_hessian(own.fields[m], own) if isinstance(m, str) and m in own.fields else m for m in metrics]
        return to_pyvista(_commands.adapt(own, *given, n=n, **options))

    def check(self, metric: Any = None, **options: Any) -> dict[str, Any]:
        """Whether the mesh is valid, and its figures in a metric: see `voronaut.check`."""
        return _commands.check(from_pyvista(self._data), metric, **options)


def _carried(old: Mesh, new: Mesh, fields: dict[str, Any]) -> dict[str, Any]:
    """Fields of the plane on the new mesh; those of surfaces at the closest vertices and triangles."""
    if not fields:
        return {}
    if old.is_planar:
        carried: dict[str, Any] = _commands.transfer(old, new, fields)
        return carried
    return {name: values[_nearest(old, new, len(values))] for name, values in fields.items()}


def _nearest(old: Mesh, new: Mesh, count: int) -> Any:
    """The vertex, or the triangle, of the old mesh that is closest to each of the new."""
    at_vertices = count == len(old.points)
    old_places, new_places = (
        mesh.points if at_vertices else mesh.points[mesh.triangles].mean(axis=1) for mesh in (old, new)
    )
    cloud = pyvista.PolyData(np.ascontiguousarray(old_places))
    return np.array([cloud.find_closest_point(place) for place in new_places])
