"""Meshes as arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _given, _voronaut
from ._given import Floats, Ints

_LISTS = ("corners", "required_points", "ridges", "required_edges", "required_triangles")


class Mesh:
    """A triangle mesh of the plane or of a surface: plain arrays, and what they mean.

    Parameters
    ----------
    points : (N, 2) or (N, 3) array of numbers
    triangles : (M, 3) array of integers, from 0
    edges : (K, 2) array, optional
        Edges that mean something: boundaries, interfaces, creases.
    point_labels, triangle_labels, edge_labels : (N,), (M,), (K,) arrays, optional
        References, markers, physical groups; 0 where there are none.
    fields, triangle_fields : mappings of names to arrays, optional
        Values at vertices, on triangles: (N,) scalars, (N, k) vectors, (N, d, d) symmetric tensors.

    Attributes
    ----------
    points, triangles, edges, point_labels, triangle_labels, edge_labels : as above
    corners, required_points, ridges, required_edges, required_triangles : arrays of numbers
        What Medit's format calls so.
    fields, triangle_fields : dict
    periodic : list
        Curves of the boundary that correspond: labels (a, b), cosine and sine, translation, how far corners are off at most, and an
        array (N, 2) of vertices with their partners. Gmsh's and SU2's files have them.
    report : dict
        What the command that made the mesh reports; empty of others.
    diagram : Mesh or None
        Of a dual: the canvas, with the fields `colour` and `distance`.
    """

    points: Floats
    triangles: Ints
    edges: Ints
    diagram: Mesh | None = None

    def __init__(
        self,
        points: npt.ArrayLike | Any,
        triangles: npt.ArrayLike | Any,
        *,
        edges: npt.ArrayLike | Any | None = None,
        point_labels: npt.ArrayLike | Any | None = None,
        triangle_labels: npt.ArrayLike | Any | None = None,
        edge_labels: npt.ArrayLike | Any | None = None,
        fields: Mapping[str, npt.ArrayLike] | None = None,
        triangle_fields: Mapping[str, npt.ArrayLike] | None = None,
        _name: str = "",
    ) -> None:
        dot = f"{_name}." if _name else ""
        self.points = _given.floats(f"{dot}points", points, (2, 3))
        self.triangles = self._cells(f"{dot}triangles", triangles, 3)
        self.edges = self._cells(f"{dot}edges", np.empty((0, 2), np.int32) if edges is None else edges, 2)
        self.point_labels = _labels(f"{dot}point_labels", point_labels, len(self.points))
        self.triangle_labels = _labels(f"{dot}triangle_labels", triangle_labels, len(self.triangles))
        self.edge_labels = _labels(f"{dot}edge_labels", edge_labels, len(self.edges))
        self.corners, self.required_points, self.ridges, self.required_edges, self.required_triangles = (
            np.empty(0, np.int32) for _ in _LISTS
        )
        self.fields: dict[str, npt.NDArray[Any]] = _named(f"{dot}fields", fields)
        self.triangle_fields: dict[str, npt.NDArray[Any]] = _named(f"{dot}triangle_fields", triangle_fields)
        self.periodic: list[Any] = []
        self.report: dict[str, Any] = {}

    def _cells(self, name: str, value: object, columns: int) -> Ints:
        cells = _given.integers(name, value, columns, least=0)
        if cells.size and int(cells.max()) >= len(self.points):
            row = int(np.argmax(cells.max(axis=1) >= len(self.points)))
            raise ValueError(f"{name}: row {row} names vertex {int(cells[row].max())}, and there are {len(self.points)}")
        return cells.astype(np.int32)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Mesh:
        """Reads a mesh with its fields: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply, .stl."""
        found = _voronaut.read(os.fspath(path))
        if "points" not in found:
            raise ValueError(f"{os.fspath(path)}: values without a mesh; voronaut.read_solution reads them")
        return cls._of(found)

    @classmethod
    def _of(cls, arrays: dict[str, Any], report: dict[str, Any] | None = None) -> Mesh:
        """The mesh of arrays of the extension, which own what it made: nothing is copied."""
        made = cls.__new__(cls)
        points = arrays["points"]
        made.points = points[:, :2] if arrays["is_planar"] else points
        made.triangles, made.edges = arrays["triangles"].view(np.int32), arrays["edges"].view(np.int32)
        counts = {"point_labels": len(points), "triangle_labels": len(made.triangles), "edge_labels": len(made.edges)}
        for name, count in counts.items():
            labels = arrays[name]
            setattr(made, name, labels if len(labels) == count else np.zeros(count, np.int32))
        for name in _LISTS:
            setattr(made, name, arrays[name].view(np.int32))
        made.fields = {name: _values(found) for name, found in arrays.get("vertex_fields", {}).items()}
        made.triangle_fields = {name: _values(found) for name, found in arrays.get("triangle_fields", {}).items()}
        made.periodic = [(tuple(labels), tuple(turn), tuple(by), off, pairs.view(np.int32)) for labels, turn, by, off, pairs in arrays.get("periodic", [])]
        made.report = report if report is not None else {"notes": arrays.get("notes", [])}
        return made

    def _arrays(self) -> dict[str, Any]:
        """As the extension takes it."""
        arrays: dict[str, Any] = {name: np.ascontiguousarray(getattr(self, name), dtype=np.uint32) for name in _LISTS}
        arrays["points"] = _given.in_space(np.ascontiguousarray(self.points, dtype=np.float64))
        for name in ("triangles", "edges"):
            arrays[name] = np.ascontiguousarray(getattr(self, name)).astype(np.uint32)
        for name in ("point_labels", "triangle_labels", "edge_labels"):
            arrays[name] = np.ascontiguousarray(getattr(self, name), dtype=np.int32)
        arrays["periodic"] = [(*pair[:4], np.ascontiguousarray(pair[4]).astype(np.uint32)) for pair in self.periodic]
        count, triangles = len(self.points), len(self.triangles)
        arrays["vertex_fields"] = {name: _given.values(f"fields[{name!r}]", it, count) for name, it in self.fields.items()}
        arrays["triangle_fields"] = {
            name: _given.values(f"triangle_fields[{name!r}]", it, triangles) for name, it in self.triangle_fields.items()
        }
        return arrays

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the mesh, with its fields where the format holds them; a .sol file has the fields alone."""
        _voronaut.write(os.fspath(path), self._arrays())

    @property
    def labels(self) -> Ints:
        """The labels of the triangles."""
        labels: Ints = self.triangle_labels
        return labels

    @property
    def is_planar(self) -> bool:
        """Whether all vertices are in the plane z = 0."""
        return self.points.shape[1] == 2 or not self.points[:, 2].any()

    @property
    def metric_scale(self) -> float:
        """The factor on the metric for which the edges are of length one."""
        return float(self.report.get("metric_scale") or 1.0)

    @property
    def quality(self) -> Floats:
        """The shape of each triangle, 1 where it is equilateral and 0 where flat, in plain lengths; in the metric: `report["quality"]`."""
        points = _given.in_space(self.points)
        a, b, c = (points[self.triangles[:, k]] for k in range(3))
        double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        squares = sum(((p - q) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a)))
        found: Floats = 2 * np.sqrt(3) * double_area / np.maximum(squares, np.finfo(float).tiny)
        return found

    def to_pyvista(self) -> Any:
        """A `pyvista.PolyData` with labels and fields."""
        from .pyvista import to_pyvista

        return to_pyvista(self)

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` with labels and fields."""
        import meshio

        cells: list[tuple[str, npt.NDArray[Any]]] = [("triangle", self.triangles)]
        labels = [self.triangle_labels]
        if len(self.edges):
            cells.append(("line", self.edges))
            labels.append(self.edge_labels)
        return meshio.Mesh(self.points, cells, point_data=dict(self.fields), cell_data={"label": labels})

    def to_skfem(self) -> Any:
        """A `skfem.MeshTri`, with boundaries and subdomains named after labels that are not 0."""
        import skfem

        if not self.is_planar:
            raise ValueError("scikit-fem's MeshTri is planar, this mesh is not")
        mesh = skfem.MeshTri(np.ascontiguousarray(self.points[:, :2].T), np.ascontiguousarray(self.triangles.T))
        subdomains = {str(label): np.nonzero(self.triangle_labels == label)[0] for label in set(self.triangle_labels.tolist()) - {0}}
        return mesh.with_subdomains(subdomains).with_boundaries(self._facets(mesh))

    def _facets(self, mesh: Any) -> dict[str, npt.NDArray[Any]]:
        """By their labels, the numbers of edges among scikit-fem's."""
        ends = [np.sort(pairs, axis=0).astype(np.int64) for pairs in (mesh.facets, self.edges.T)]
        facets, edges = (least * len(self.points) + greatest for least, greatest in ends)
        order = np.argsort(facets)
        numbers = order[np.searchsorted(facets, edges, sorter=order).clip(max=len(facets) - 1)]
        labels = np.where(facets[numbers] == edges, self.edge_labels, 0)
        return {str(label): numbers[labels == label] for label in set(labels.tolist()) - {0}}

    def view(self, metric: Any = None, **options: Any) -> Any:
        """A page to look at the mesh with: notebooks show it, `save(path)` writes it. Options are those of `voronaut.view`."""
        from ._commands import view

        return view(self, metric, **options)

    def plot(
        self, field: str | npt.ArrayLike | None = None, *, ax: Any = None, ellipses: Any = None, **style: Any
    ) -> Any:
        """Draws the mesh with matplotlib, coloured by a field of vertices or triangles; returns the axes.

        With `ellipses`, a metric, what is of length one half in it around some 300 vertices of a planar mesh, in the mesh's scale.
        """
        import matplotlib.pyplot as plt

        values = None if field is None else np.asarray(self._field(field) if isinstance(field, str) else field)
        if self.is_planar:
            ax = ax if ax is not None else plt.figure().add_subplot(aspect="equal")
            x, y = self.points[:, 0], self.points[:, 1]
            if values is None:
                ax.triplot(x, y, self.triangles, **{"linewidth": 0.4, "color": "#26547c", **style})
            else:
                ax.tripcolor(x, y, self.triangles, values, **{"shading": "gouraud" if len(values) == len(x) else "flat", **style})
            if ellipses is not None:
                self._draw_ellipses(ax, ellipses)
            return ax
        ax = ax if ax is not None else plt.figure().add_subplot(projection="3d", aspect="equal")
        if ellipses is not None:
            raise ValueError("ellipses: they are drawn of planar meshes only")
        drawn = ax.plot_trisurf(
            *self.points.T, triangles=self.triangles, **{"linewidth": 0.2, "edgecolor": "#26547c", "color": "#dbe9f4", **style}
        )
        if values is not None:
            drawn.set_array(values if len(values) == len(self.triangles) else values[self.triangles].mean(axis=1))
        return ax

    def _draw_ellipses(self, ax: Any, metric: Any) -> None:
        from ._metric import at_vertices

        some = slice(None, None, max(1, len(self.points) // 300))
        size, axes = np.linalg.eigh(at_vertices(self, [metric])[0][some] * self.metric_scale)
        angle = np.linspace(0, 2 * np.pi, 33)
        circle = 0.5 * np.stack([np.cos(angle), np.sin(angle)])
        outlines = self.points[some, :2, None] + axes @ (circle / np.sqrt(size)[:, :, None])
        ax.plot(outlines[:, 0].T, outlines[:, 1].T, color="#d1495b", linewidth=0.8)

    def _field(self, name: str) -> npt.NDArray[Any]:
        for fields in (self.fields, self.triangle_fields):
            if name in fields:
                return fields[name]
        raise KeyError(f"no field {name!r}: there are {[*self.fields, *self.triangle_fields]}")

    def __repr__(self) -> str:
        of = "plane" if self.is_planar else "surface"
        fields = f", fields {[*self.fields, *self.triangle_fields]}" if self.fields or self.triangle_fields else ""
        return f"<voronaut.Mesh of the {of}: {len(self.points):,} vertices, {len(self.triangles):,} triangles{fields}>"

    def _repr_html_(self) -> str:
        figures = {"vertices": len(self.points), "triangles": len(self.triangles)}
        lengths, quality = self.report.get("metric_edge_length"), self.report.get("quality")
        rows = [f"<tr><th>{name}</th><td>{value:,}</td></tr>" for name, value in figures.items()]
        if lengths and quality:
            rows.append(f"<tr><th>unit edges</th><td>{100 * lengths['unit_fraction']:.1f} %</td></tr>")
            rows.append(f"<tr><th>quality, mean / min</th><td>{quality['mean']:.3f} / {quality['min']:.3f}</td></tr>")
        return f"<table>{''.join(rows)}</table>{self._picture()}"

    def _picture(self) -> str:
        try:
            import base64
            import io

            from matplotlib.figure import Figure
        except ImportError:
            return ""
        figure = Figure(figsize=(6, 6))
        axes = figure.add_subplot(projection=None if self.is_planar else "3d", aspect="equal")
        axes.set_axis_off()
        self.plot(ax=axes)
        out = io.BytesIO()
        figure.savefig(out, format="png", bbox_inches="tight")
        return f'<img src="data:image/png;base64,{base64.b64encode(out.getvalue()).decode()}" style="max-width: 30em">'


def _labels(name: str, value: object, count: int) -> Ints:
    if value is None:
        return np.zeros(count, np.int32)
    labels = _given.integers(name, value)
    if len(labels) != count:
        raise ValueError(f"{name}: {count} labels are expected, not {len(labels)}")
    return labels.astype(np.int32)


def _named(name: str, given: Mapping[str, npt.ArrayLike] | None) -> dict[str, npt.NDArray[Any]]:
    if given is not None and not isinstance(given, Mapping):
        raise TypeError(f"{name}: a mapping of names to arrays is expected, not {type(given).__name__}")
    return {key: np.asarray(value) for key, value in (given or {}).items()}


def _values(found: tuple[str, Floats]) -> npt.NDArray[Any]:
    """Values of the extension as users have them."""
    kind, numbers = found
    return numbers[:, 0] if kind == "scalar" else _given.matrices(numbers) if kind == "tensor" else numbers
