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
    nodes : (K, 2) or (K, 3) array of numbers, optional
        Of curved triangles: the nodes that are not vertices.
    curved_triangles : (M, 3) or (M, 7) array of integers, from 0, optional
        Of each triangle of order 2 or 3 its nodes, which neighbours share: of the edge from corner 0 to corner 1, of that from 1 to 2, of
        that from 2 to 0, and for order 3 the one inside.

    Attributes
    ----------
    points, triangles, edges, point_labels, triangle_labels, edge_labels : as above
    nodes, curved_triangles : as above, or None of straight triangles
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
    nodes: Floats | None = None
    curved_triangles: Ints | None = None
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
        nodes: npt.ArrayLike | Any | None = None,
        curved_triangles: npt.ArrayLike | Any | None = None,
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
        if nodes is not None or curved_triangles is not None:
            self._curve(dot, nodes, curved_triangles)

    def _curve(self, dot: str, nodes: object, triangles: object) -> None:
        """Takes the nodes of curved triangles."""
        if nodes is None or triangles is None:
            raise ValueError(f"{dot}nodes: they need {dot}curved_triangles, and these need nodes")
        self.nodes = _given.floats(f"{dot}nodes", nodes, (self.points.shape[1],))
        found = np.asarray(triangles)
        columns = found.shape[1] if found.ndim == 2 else 0
        if columns not in (3, 7):
            raise ValueError(f"{dot}curved_triangles: (M, 3) of order 2 or (M, 7) of order 3 is expected, not {found.shape}")
        if len(found) != len(self.triangles):
            raise ValueError(f"{dot}curved_triangles: {len(self.triangles)} rows are expected, not {len(found)}")
        numbers = _given.integers(f"{dot}curved_triangles", found, columns, least=0)
        if numbers.size and int(numbers.max()) >= len(self.nodes):
            row = int(np.argmax(numbers.max(axis=1) >= len(self.nodes)))
            raise ValueError(f"{dot}curved_triangles: row {row} names node {int(numbers[row].max())}, and there are {len(self.nodes)}")
        self.curved_triangles = numbers.astype(np.int32)

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
        if "nodes" in arrays:
            made.nodes = arrays["nodes"][:, :2] if arrays["is_planar"] else arrays["nodes"]
            made.curved_triangles = arrays["curved_triangles"].view(np.int32)
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
        if self.nodes is not None:
            arrays["nodes"] = _given.in_space(np.ascontiguousarray(self.nodes, dtype=np.float64))
            arrays["curved_triangles"] = np.ascontiguousarray(self.curved_triangles).astype(np.uint32)
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
        """Whether all vertices, and nodes, are in the plane z = 0."""
        nodes = self.nodes is not None and self.points.shape[1] == 3 and self.nodes[:, 2].any()
        return self.points.shape[1] == 2 or not (self.points[:, 2].any() or nodes)

    @property
    def order(self) -> int:
        """1 of straight triangles, 2 or 3 of curved ones."""
        return 1 if self.curved_triangles is None else 2 if self.curved_triangles.shape[1] == 3 else 3

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

        self._demand_straight("to_pyvista", "save it as .vtu, which pyvista reads")
        return to_pyvista(self)

    def to_meshio(self) -> Any:
        """A `meshio.Mesh` with labels and fields."""
        import meshio

        triangle, line = (("triangle", "line"), ("triangle6", "line3"), ("triangle10", "line4"))[self.order - 1]
        points, triangles, edges = self._with_nodes()
        cells: list[tuple[str, npt.NDArray[Any]]] = [(triangle, triangles)]
        labels = [self.triangle_labels]
        if len(self.edges):
            cells.append((line, edges))
            labels.append(self.edge_labels)
        fields = dict(self.fields) if self.order == 1 else {}
        return meshio.Mesh(points, cells, point_data=fields, cell_data={"label": labels})

    def _with_nodes(self) -> tuple[Floats, Ints, Ints]:
        """Vertices and then nodes, and triangles and edges by both, corners first."""
        if self.nodes is None or self.curved_triangles is None:
            return self.points, self.triangles, self.edges
        count, per_edge = len(self.points), self.order - 1
        sides = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        inside = self.curved_triangles[:, : 3 * per_edge].reshape(-1, per_edge)
        both = np.concatenate([sides, sides[:, ::-1]]).astype(np.int64)
        nodes = np.concatenate([inside, inside[:, ::-1]])
        keys, edges = both[:, 0] * count + both[:, 1], self.edges[:, 0].astype(np.int64) * count + self.edges[:, 1]
        order = np.argsort(keys, kind="stable")
        found = order[np.searchsorted(keys, edges, sorter=order).clip(max=len(keys) - 1)]
        if (keys[found] != edges).any():
            raise ValueError("edges: one is of no triangle, and so without curve")
        return (
            np.concatenate([self.points, self.nodes]),
            np.concatenate([self.triangles, count + self.curved_triangles], axis=1),
            np.concatenate([self.edges, count + nodes[found]], axis=1),
        )

    def _demand_straight(self, what: str, instead: str) -> None:
        if self.order > 1:
            raise ValueError(f"{what}: it has straight triangles, this mesh is of order {self.order}; {instead}")

    def to_skfem(self) -> Any:
        """A `skfem.MeshTri`, or `MeshTri2` of order 2, with boundaries and subdomains named after labels that are not 0."""
        import skfem

        if not self.is_planar:
            raise ValueError("scikit-fem's MeshTri is planar, this mesh is not")
        if self.order == 3:
            raise ValueError("scikit-fem has triangles of order 1 and 2, this mesh is of order 3: make one with order=2")
        mesh = skfem.MeshTri(np.ascontiguousarray(self.points[:, :2].T), np.ascontiguousarray(self.triangles.T))
        subdomains = {str(label): np.nonzero(self.triangle_labels == label)[0] for label in set(self.triangle_labels.tolist()) - {0}}
        boundaries = self._facets(mesh)
        if self.nodes is not None and self.curved_triangles is not None:
            curved = skfem.MeshTri2.from_mesh(mesh)
            sides = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1).T
            places = curved.doflocs.copy()
            places[:, len(self.points) + self._numbers(mesh, sides)] = self.nodes[self.curved_triangles.ravel(), :2].T
            mesh = skfem.MeshTri2(places, curved.t)
        return mesh.with_subdomains(subdomains).with_boundaries(boundaries)

    def _facets(self, mesh: Any) -> dict[str, npt.NDArray[Any]]:
        """By their labels, the numbers of edges among scikit-fem's."""
        edges = np.sort(self.edges.T, axis=0)
        numbers = self._numbers(mesh, edges)
        labels = np.where((mesh.facets[:, numbers] == edges).all(axis=0), self.edge_labels, 0)
        return {str(label): numbers[labels == label] for label in set(labels.tolist()) - {0}}

    def _numbers(self, mesh: Any, edges: Ints) -> npt.NDArray[Any]:
        """The numbers of edges, by their ends, the smaller first, among scikit-fem's; of others any."""
        facets, edges = (ends[0].astype(np.int64) * len(self.points) + ends[1] for ends in (np.sort(mesh.facets, axis=0), edges))
        order = np.argsort(facets)
        numbers: npt.NDArray[Any] = order[np.searchsorted(facets, edges, sorter=order).clip(max=len(facets) - 1)]
        return numbers

    def view(self, metric: Any = None, **options: Any) -> Any:
        """A page to look at the mesh with: notebooks show it, `save(path)` writes it. Options are those of `voronaut.view`."""
        from ._commands import view

        return view(self, metric, **options)

    def plot(
        self, field: str | npt.ArrayLike | None = None, *, ax: Any = None, ellipses: Any = None, **style: Any
    ) -> Any:
        """Draws the mesh with matplotlib, coloured by a field of vertices or triangles; returns the axes.

        Curved triangles of a planar mesh have their curves; fields are drawn on straight ones between the vertices.
        With `ellipses`, a metric, what is of length one half in it around some 300 vertices of a planar mesh, in the mesh's scale.
        """
        import matplotlib.pyplot as plt

        values = None if field is None else np.asarray(self._field(field) if isinstance(field, str) else field)
        if self.is_planar:
            ax = ax if ax is not None else plt.figure().add_subplot(aspect="equal")
            x, y = self.points[:, 0], self.points[:, 1]
            if values is None and self.order > 1:
                ax.plot(*self._curves(), **{"linewidth": 0.4, "color": "#26547c", **style})
            elif values is None:
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

    def _curves(self) -> npt.NDArray[Any]:
        """Points along all sides of the triangles of a curved planar mesh, with NaN between them: x, y."""
        points, triangles, _ = self._with_nodes()
        order = self.order
        knots, at = np.arange(order + 1) / order, np.linspace(0, 1, 9)
        others = [[k for k in range(order + 1) if k != i] for i in range(order + 1)]
        weights = np.array([np.prod([(at - knots[k]) / (knots[i] - knots[k]) for k in row], axis=0) for i, row in enumerate(others)])
        sides = [[i, *range(3 + i * (order - 1), 3 + (i + 1) * (order - 1)), (i + 1) % 3] for i in range(3)]
        along = np.einsum("snd,np->spd", points[triangles[:, sides].reshape(-1, order + 1), :2], weights)
        broken: npt.NDArray[Any] = np.concatenate([along, np.full((len(along), 1, 2), np.nan)], axis=1).reshape(-1, 2).T
        return broken

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
        order = f" of order {self.order}" if self.order > 1 else ""
        return f"<voronaut.Mesh of the {of}: {len(self.points):,} vertices, {len(self.triangles):,} triangles{order}{fields}>"

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
