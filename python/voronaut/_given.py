"""What users give, as the extension takes it: arrays of one type and shape, texts, files; faults with the argument's name."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int32]
MeshArrays = dict[str, Any]

# Largest number of a vertex, and of labels.
_MOST = 2**31 - 1
# Where meshio keeps labels: of ours, of gmsh's and of Medit's files.
_MESHIO_LABELS = ("label", "gmsh:physical", "medit:ref")
# More numbers than any option takes.
_LONGEST = 7


def text_of(name: str, value: object) -> str:
    """An option's value as the command line has it."""
    if isinstance(value, bool) or value is None:
        raise TypeError(f"{name}: a number or a text is expected, not {value!r}")
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value) if not isinstance(value, str) else value
    if isinstance(value, np.ndarray):
        return text_of(name, value[()] if value.ndim == 0 else list(value[:_LONGEST]))
    if isinstance(value, (list, tuple)) and 0 < len(value) < _LONGEST:
        return ",".join(text_of(name, part) for part in value)
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return repr(int(number) if number.is_integer() and abs(number) < 2**53 else number)
    raise TypeError(f"{name}: a number or a text is expected, not {type(value).__name__}")


def floats(name: str, value: object, columns: tuple[int, ...] | None = None) -> Floats:
    """A whole array of finite numbers, (N, columns) if these are said, as doubles in rows."""
    array = _array(name, value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: numbers are expected, not {array.dtype}")
    made = np.asarray(array, dtype=np.float64, order="C")
    if columns is not None and (made.ndim != 2 or made.shape[1] not in columns):
        expected = " or ".join(f"(N, {count})" for count in columns)
        raise ValueError(f"{name}: an array {expected} is expected, not {made.shape}")
    if not np.isfinite(made).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(made))[0])
        where = f" at index {place if len(place) > 1 else place[0]}" if place else ""
        raise ValueError(f"{name}: {made[place]}{where}: finite numbers are expected")
    return made


def integers(name: str, value: object, columns: int | None = None, least: int = -_MOST - 1) -> npt.NDArray[np.int64]:
    """A whole array of integers, (N, columns) or, without, (N,)."""
    array = _array(name, value)
    if array.size == 0:
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: integers are expected, not {array.dtype}")
    if columns is not None and array.size == 0:
        array = array.reshape(0, columns)
    if array.ndim != (1 if columns is None else 2) or (columns is not None and array.shape[1] != columns):
        raise ValueError(f"{name}: an array {'(N,)' if columns is None else f'(N, {columns})'} is expected, not {array.shape}")
    if array.size and (int(array.min()) < least or int(array.max()) > _MOST):
        raise ValueError(f"{name}: numbers from {least} to {_MOST} are expected, not {array.min()} to {array.max()}")
    return np.ascontiguousarray(array, dtype=np.int64)


def _array(name: str, value: object) -> npt.NDArray[Any]:
    if isinstance(value, np.ma.MaskedArray):
        if np.ma.is_masked(value):
            raise ValueError(f"{name}: the array has masked entries, and there is no value for them")
        value = value.data
    try:
        return np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None


def in_space(points: Floats) -> Floats:
    """Points with a third coordinate."""
    if points.shape[1] == 3:
        return points
    return np.column_stack([points, np.zeros(len(points))])


def mesh_arrays(name: str, value: object) -> MeshArrays:
    """A mesh as the extension has it: of ours, of pyvista, of meshio, or a tuple of points and triangles."""
    from ._mesh import Mesh

    if isinstance(value, Mesh):
        return value._arrays()
    if hasattr(value, "cells_dict") and hasattr(value, "points"):
        return _of_meshio(name, value)
    if hasattr(value, "regular_faces") and hasattr(value, "points"):
        return _of_pyvista(name, value)
    if isinstance(value, tuple) and len(value) in (2, 3):
        return _of_tuple(name, value)
    raise TypeError(
        f"{name}: a mesh is expected (voronaut.Mesh, pyvista, meshio, or a tuple of points and triangles or segments), "
        f"not {type(value).__name__}"
    )


def _of_tuple(name: str, value: tuple[object, ...]) -> MeshArrays:
    from ._mesh import Mesh

    cells = _array(f"{name}[1]", value[1])
    columns = cells.shape[1] if cells.ndim == 2 else 0
    labels = value[2] if len(value) == 3 else None
    if columns == 3:
        return Mesh(value[0], cells, triangle_labels=labels, _name=name)._arrays()
    if columns == 2:
        return Mesh(value[0], np.empty((0, 3), np.int32), edges=cells, edge_labels=labels, _name=name)._arrays()
    raise ValueError(f"{name}[1]: segments (K, 2) or triangles (M, 3) are expected, not {cells.shape}")


def _of_meshio(name: str, value: Any) -> MeshArrays:
    from ._mesh import Mesh

    cells, data = value.cells_dict, value.cell_data_dict
    if curved := sorted({"triangle6", "triangle7", "triangle10", "line3", "line4"} & set(cells)):
        raise ValueError(f"{name}: curved cells ({curved[0]}): write a .msh or .vtu with meshio, which voronaut.Mesh.read takes")
    labels: Mapping[str, Any] = next((data[key] for key in _MESHIO_LABELS if key in data), {})
    triangles = cells.get("triangle", np.empty((0, 3), np.int32))
    of_triangles, of_edges = labels.get("triangle"), labels.get("line")
    mesh = Mesh(value.points, triangles, edges=cells.get("line"), triangle_labels=of_triangles, edge_labels=of_edges, _name=name)
    # Names with a colon are a format's own.
    mesh.fields.update({key: np.asarray(found) for key, found in value.point_data.items() if ":" not in key})
    found = {key: of["triangle"] for key, of in data.items() if "triangle" in of and ":" not in key and key != "label"}
    mesh.triangle_fields.update(found)
    return mesh._arrays()


def _of_pyvista(name: str, value: Any) -> MeshArrays:
    from .pyvista import from_pyvista

    return from_pyvista(value, name)._arrays()


def values(name: str, value: object, count: int | None = None) -> tuple[str, Floats]:
    """Values with their kind: (N,) scalars, (N, k) vectors, (N, d, d) symmetric tensors, which become 3 or 6 entries each."""
    array = floats(name, value)
    if array.ndim == 0 or array.ndim > 3:
        raise ValueError(f"{name}: an array (N,), (N, k) or (N, d, d) is expected, not {array.shape}")
    if count is not None and len(array) != count:
        raise ValueError(f"{name}: {count} entries are expected, one for each vertex or triangle, not {len(array)}")
    if array.ndim == 1:
        return "scalar", array.reshape(-1, 1)
    if array.ndim == 2:
        return "vector", array
    return "tensor", entries(name, array)


def tensor_values(name: str, value: object, count: int | None = None) -> tuple[str, Floats]:
    """Sizes or tensors: (N,) sizes, (N, 3) or (N, 6) entries in the order of .sol, (N, 2, 2) or (N, 3, 3) matrices."""
    array = floats(name, value)
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    expected = "(N,) sizes, (N, 3) or (N, 6) entries m11, m12, m22[, m13, m23, m33], or (N, 2, 2) or (N, 3, 3) matrices"
    if array.ndim not in (1, 2, 3) or (array.ndim == 2 and array.shape[1] not in (3, 6)):
        raise ValueError(f"{name}: {expected} are expected, not an array {array.shape}")
    if count is not None and len(array) != count:
        raise ValueError(f"{name}: {count} entries are expected, not {len(array)}")
    if array.ndim == 1:
        if (array <= 0).any():
            i = int(np.argmax(array <= 0))
            raise ValueError(f"{name}: the size {array[i]} at index {i} is not positive")
        return "scalar", array.reshape(-1, 1)
    return "tensor", array if array.ndim == 2 else entries(name, array)


def entries(name: str, matrices: Floats) -> Floats:
    """The entries m11, m12, m22[, m13, m23, m33] of symmetric matrices."""
    size = matrices.shape[1]
    if matrices.shape[1:] not in ((2, 2), (3, 3)):
        raise ValueError(f"{name}: matrices 2 x 2 or 3 x 3 are expected, not {matrices.shape[1:]}")
    scale = np.abs(matrices).max(axis=(1, 2), initial=0.0)
    skew = np.abs(matrices - matrices.transpose(0, 2, 1)).max(axis=(1, 2), initial=0.0) > 1e-9 * scale
    if skew.any():
        raise ValueError(f"{name}: the matrix at index {int(np.argmax(skew))} is not symmetric")
    order = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)][: 3 if size == 2 else 6]
    return np.ascontiguousarray(np.column_stack([matrices[:, i, j] for i, j in order]))


def matrices(flat: Floats) -> Floats:
    """Symmetric matrices of their entries."""
    order = [[0, 1], [1, 2]] if flat.shape[1] == 3 else [[0, 1, 3], [1, 2, 4], [3, 4, 5]]
    return flat[:, order]


def domain_word(value: object, held: dict[str, dict[str, Any]], word: str = "domain") -> str:
    """The word for a domain: a text or a file is itself; others are held under the word."""
    geo = getattr(value, "__geo_interface__", value if isinstance(value, Mapping) else None)
    if geo is None:
        return mesh_word(value, held, word)
    held.setdefault("polygons", {})[word] = _polygons(word, geo)
    return word


def mesh_word(value: object, held: dict[str, dict[str, Any]], word: str) -> str:
    """The word for a mesh, as that for a domain; polygons are none."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    held.setdefault("documents", {})[word] = mesh_arrays(word, value)
    return word


def _polygons(word: str, geo: object) -> str:
    try:
        return json.dumps(geo, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{word}: not what __geo_interface__ promises: {error}") from None
