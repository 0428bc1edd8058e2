"""Files without a mesh in between."""

from __future__ import annotations

import os
from typing import Any

import numpy.typing as npt

from . import _voronaut
from ._mesh import Mesh
from ._run import iter_solutions


def convert(source: str | os.PathLike[str], destination: str | os.PathLike[str]) -> Mesh:
    """Reads a mesh in one format and writes it in another; the mesh is returned."""
    mesh = Mesh.read(source)
    mesh.save(destination)
    return mesh


def read_solution(path: str | os.PathLike[str]) -> dict[str, list[npt.NDArray[Any]]]:
    """The values of a .sol or .solb file, in their order: under `vertices`, and under `triangles`."""
    return iter_solutions(_voronaut.read(os.fspath(path))["solutions"])
