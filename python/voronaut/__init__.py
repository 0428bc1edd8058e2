"""Anisotropic triangle meshes from a Riemannian metric field.

    import voronaut

    mesh = voronaut.mesh("rect:0,0,1,1", "hessian:tanh(40*(y - x))", n=2000)
    mesh.points, mesh.triangles, mesh.report["metric_edge_length"]
    mesh.save("layer.vtu")

Domains are files, shapes as text (`"disk:0,0,1"`, `"sphere:1"`), arrays (`(points, segments)`, `(points, triangles)`), meshes of
pyvista and meshio, objects with `__geo_interface__`. Metrics are texts, arrays, functions of points, or a `Metric`.
"""

from . import distributed
from ._commands import adapt, check, distance, dual, mesh, remesh, transfer, view
from ._errors import (
    Cancelled,
    DomainError,
    Error,
    FileError,
    InputError,
    LimitError,
    MeshError,
    MetricError,
    UnsupportedError,
)
from ._files import convert, read_solution
from ._mesh import Mesh
from ._metric import Metric, at_vertices
from ._page import Page

__all__ = [
    "Cancelled",
    "DomainError",
    "Error",
    "FileError",
    "InputError",
    "LimitError",
    "Mesh",
    "MeshError",
    "Metric",
    "MetricError",
    "Page",
    "UnsupportedError",
    "adapt",
    "at_vertices",
    "check",
    "convert",
    "distance",
    "distributed",
    "dual",
    "mesh",
    "read_solution",
    "remesh",
    "transfer",
    "view",
]
