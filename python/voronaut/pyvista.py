"""Meshes of pyvista as ours, and back, with point and cell data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ._files import read_solution
from ._mesh import Mesh

_LABEL = "label"


def to_pyvista(mesh: Mesh) -> Any:
    """A `pyvista.PolyData` of a mesh: labels of triangles as cell data `label`, fields as they are called."""
    import pyvista

    points = mesh.points if mesh.points.shape[1] == 3 else np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    made = pyvista.PolyData.from_regular_faces(points, mesh.triangles.astype(int))
    for name, values in mesh.fields.items():
        made.point_data[name] = _flat(values)
    for name, values in mesh.triangle_fields.items():
        made.cell_data[name] = _flat(values)
    if mesh.triangle_labels.any():
        made.cell_data[_LABEL] = mesh.triangle_labels
    return made


def _flat(values: Any) -> Any:
    """Tensors as rows of nine, as VTK has them."""
    if values.ndim != 3:
        return values
    whole = np.zeros((len(values), 3, 3))
    whole[:, : values.shape[1], : values.shape[2]] = values
    return whole.reshape(len(values), 9)


def from_pyvista(data: Any, name: str = "mesh") -> Mesh:
    """The triangles of a pyvista data set: of volumes their boundary, polygons cut into triangles."""
    if not hasattr(data, "regular_faces"):
        data = data.extract_surface(pass_pointid=False, pass_cellid=False, algorithm=None)
    if not data.is_all_triangles:
        data = data.triangulate()
    labels = data.cell_data.get(_LABEL)
    points = np.asarray(data.points, dtype=float)
    mesh = Mesh(points, data.regular_faces, triangle_labels=labels, _name=name)
    for key, values in data.point_data.items():
        if np.asarray(values).dtype.kind in "fiub" and key != "Normals":
            mesh.fields[key] = np.asarray(values, dtype=float)
    for key, values in data.cell_data.items():
        if np.asarray(values).dtype.kind in "fiub" and key not in (_LABEL, "Normals"):
            mesh.triangle_fields[key] = np.asarray(values, dtype=float)
    return mesh


def read(path: str, **_: Any) -> Any:
    """What `pyvista.read` calls for .meshb, and for .sol and .solb: values on the mesh of the same name beside them."""
    place = Path(path)
    if place.suffix.lower() not in (".sol", ".solb"):
        return to_pyvista(Mesh.read(place))
    beside = [place.with_suffix(ending) for ending in (".meshb", ".mesh")]
    mesh = Mesh.read(next((it for it in beside if it.exists()), beside[-1]))
    found = read_solution(place)
    for kind, fields, count in (("vertices", mesh.fields, len(mesh.points)), ("triangles", mesh.triangle_fields, len(mesh.triangles))):
        for i, values in enumerate(found[kind]):
            if len(values) != count:
                raise ValueError(f"{place}: {len(values)} values, and {count} {kind} in the mesh beside it")
            fields[f"solution {i}"] = values
    return to_pyvista(mesh)
