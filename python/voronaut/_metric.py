"""Metrics: what edges should be of length one in."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _given, _voronaut
from ._given import Floats

MetricLike = Union["Metric", str, "os.PathLike[str]", npt.ArrayLike, Callable[[Floats], npt.ArrayLike]]


class Metric:
    """A metric field: a symmetric positive definite tensor M at every point; an edge e has the length sqrt(e' M e).

    An eigenvalue 1/h**2 asks for edges of length h along its eigenvector. Wherever a metric is expected, a text of the command line
    (`"swirl"`, `"hessian:tanh(40*(y-x))"`, `"sizes.sol"`) will do, and so will a function of points. Metrics are made of others by
    `&` (`intersect`), `average`, `limit`, `gradate` and `scale_to`.
    """

    def __init__(self, description: tuple[str, tuple[Any, ...]]) -> None:
        self._description = description

    @staticmethod
    def of(value: MetricLike, mesh: Any = None) -> Metric:
        """Whatever may stand for a metric as one; a number is a size, arrays need the mesh that they belong to."""
        if isinstance(value, Metric):
            return value
        if isinstance(value, (str, os.PathLike)):
            return Metric(("text", (os.fspath(value),)))
        if callable(value):
            return Metric.from_callable(value)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return Metric.uniform(value)
        return Metric.from_array(value, mesh)

    @staticmethod
    def uniform(m: npt.ArrayLike = 1.0) -> Metric:
        """The same tensor everywhere, 2 x 2; a number h stands for the size h in all directions."""
        tensor = _given.floats("m", m)
        if tensor.ndim == 0:
            if not tensor > 0:
                raise ValueError(f"m: the size {tensor} is not positive")
            tensor = np.eye(2) / tensor**2
        if tensor.shape != (2, 2):
            raise ValueError(f"m: a size or a matrix 2 x 2 is expected, not {tensor.shape}")
        xx, xy, yy = _given.entries("m", tensor[None])[0]
        return Metric(("text", (f"uniform:{xx!r},{xy!r},{yy!r}".replace("np.float64(", "").replace(")", ""),)))

    @staticmethod
    def formula(text: str) -> Metric:
        """Formulas in x and y, `"m11; m12; m22"`, or on surfaces in x, y, z, `"m11; m12; m22; m13; m23; m33"`."""
        return Metric(("text", (f"formula:{text}",)))

    @staticmethod
    def boundary(h0: float, *, growth: float | None = None, aspect: float | None = None, h_max: float | None = None) -> Metric:
        """Sizes by the distance to the boundary: h0 across it, `growth` per layer, `aspect` times that along it, at most h_max."""
        more = {"growth": growth, "aspect": aspect, "h_max": h_max}
        words = [f"h0={float(h0)!r}", *(f"{name}={float(value)!r}" for name, value in more.items() if value is not None)]
        return Metric(("text", ("boundary:" + ",".join(words),)))

    @staticmethod
    def curvature(floor: float | None = None) -> Metric:
        """On surfaces: the metric of their curvature, for the least distance; flatter places count as curved by `floor`."""
        return Metric(("text", ("curvature" if floor is None else f"curvature:floor={float(floor)!r}",)))

    @staticmethod
    def from_callable(function: Callable[[Floats], npt.ArrayLike]) -> Metric:
        """Of a function that takes points (N, 2), on surfaces (N, 3), and returns sizes (N,), one size for all, or tensors.

        It is called a few times with many points, from one thread at a time: at the vertices of a background that is refined by what
        it says, on surfaces at the vertices of the surface.
        """
        if not callable(function):
            raise TypeError(f"function: a function of points is expected, not {type(function).__name__}")

        def called(points: Floats) -> tuple[str, Floats]:
            said = function(points)
            try:
                if isinstance(said, (int, float)) and not isinstance(said, bool):
                    said = np.full(len(points), float(said))
                return _given.tensor_values("the metric function's result", said, len(points))
            except ValueError as error:
                raise ValueError(f"{error}{_place(said, points)}") from None

        return Metric(("function", (called,)))

    @staticmethod
    def from_array(values: npt.ArrayLike, mesh: Any = None) -> Metric:
        """Of sizes (N,) or tensors (N, 3), (N, 6), (N, 2, 2), (N, 3, 3) at the vertices of a mesh; on surfaces at its own."""
        on = None if mesh is None else _given.mesh_arrays("mesh", mesh)
        count = None if on is None else len(on["points"])
        return Metric(("values", (on, _given.tensor_values("values", values, count))))

    @staticmethod
    def from_hessian(values: npt.ArrayLike | str, mesh: Any = None) -> Metric:
        """For the least error of interpolating a solution, values (N,) at the vertices of a mesh, or a formula in x and y."""
        if isinstance(values, str):
            return Metric(("text", (f"hessian:{values}",)))
        if mesh is None:
            raise ValueError("mesh: the mesh that the values belong to is missing")
        on = _given.mesh_arrays("mesh", mesh)
        kind, numbers = _given.values("values", values, len(on["points"]))
        if numbers.shape[1] != 1:
            raise ValueError(f"values: one number per vertex is expected, not {numbers.shape[1]}")
        return Metric(("solution", (on, (kind, numbers))))

    @staticmethod
    def implied(mesh: Any) -> Metric:
        """The metric in which a planar mesh is as even as can be."""
        return Metric(("implied", (_given.mesh_arrays("mesh", mesh),)))

    def intersect(self, *others: MetricLike) -> Metric:
        """As fine as each of them everywhere, and not finer than it takes."""
        return Metric(("combined", (None, [self._description, *(Metric.of(other)._description for other in others)])))

    def __and__(self, other: MetricLike) -> Metric:
        return self.intersect(other)

    def average(self, *others: MetricLike, weights: Sequence[float] | None = None) -> Metric:
        """The log-Euclidean mean of them."""
        all_of = [self._description, *(Metric.of(other)._description for other in others)]
        given = [1.0] * len(all_of) if weights is None else [float(weight) for weight in weights]
        if len(given) != len(all_of):
            raise ValueError(f"weights: {len(all_of)} are expected, one for each metric, not {len(given)}")
        return Metric(("combined", (given, all_of)))

    def limit(self, *, h_min: float | None = None, h_max: float | None = None, a_max: float | None = None) -> Metric:
        """Within a least and a greatest size, and a greatest ratio of the sizes at a point."""
        return Metric(("limited", ((h_min, h_max, a_max), self._description)))

    def gradate(self, factor: float = 1.3) -> Metric:
        """With sizes of neighbouring edges that differ by about this factor at most."""
        return Metric(("graded", (float(factor), self._description)))

    def scale_to(self, complexity: float) -> Metric:
        """Times the factor by which the integral of sqrt(det M) is this; meshes have about 1.15 vertices for each unit."""
        return Metric(("scaled", (float(complexity), self._description)))

    # As animate calls these.
    normalise = scale_to

    def combine(self, *others: MetricLike, average: bool = True, weights: Sequence[float] | None = None) -> Metric:
        """`average`, or with `average=False` `intersect`."""
        return self.average(*others, weights=weights) if average else self.intersect(*others)

    def at(self, mesh: Any) -> Floats:
        """The tensors at the vertices of a planar mesh: (N, 2, 2)."""
        return at_vertices(mesh, [self])[0]

    def __repr__(self) -> str:
        kind, parts = self._description
        return f"<voronaut.Metric: {parts[0] if kind == 'text' else kind}>"


def at_vertices(
    mesh: Any,
    metrics: Sequence[MetricLike],
    *,
    weights: Sequence[float] | None = None,
    norm: float | str = 2,
    h_min: npt.ArrayLike | None = None,
    h_max: npt.ArrayLike | None = None,
    a_max: npt.ArrayLike | None = None,
    complexity: float | None = None,
    gradation: float | None = None,
) -> tuple[Floats, float]:
    """What `voronaut metric` does: metrics at the vertices of a planar mesh, combined, limited, graded, of a complexity.

    Returns the tensors (N, 2, 2) and the integral of sqrt(det M).
    """
    arrays = _given.mesh_arrays("mesh", mesh)
    count = len(arrays["points"])

    def limit(name: str, value: npt.ArrayLike | None) -> float | Floats | None:
        if value is None:
            return None
        given = _given.floats(name, value)
        if given.ndim == 0:
            return float(given)
        if given.shape != (count,):
            raise ValueError(f"{name}: a number or {count} of them are expected, not {given.shape}")
        return given.reshape(-1, 1)

    shaping = {"h_min": limit("h_min", h_min), "h_max": limit("h_max", h_max), "a_max": limit("a_max", a_max)}
    given = [Metric.of(metric, mesh)._description for metric in metrics]
    weighted = None if weights is None else [float(weight) for weight in weights]
    more = {"weights": weighted, "norm": _given.text_of("norm", norm), "complexity": complexity, "gradation": gradation}
    flat, found = _voronaut.metric_at(arrays, given, {**shaping, **more})
    return _given.matrices(flat), found


def _place(said: object, points: Floats) -> str:
    """Where a function's result is not finite or not positive."""
    try:
        array = np.asarray(said, dtype=float)
        bad = ~np.isfinite(array) | ((array <= 0) if array.ndim == 1 else False)
        if len(array) != len(points) or not bad.any():
            return ""
    except (TypeError, ValueError):
        return ""
    point = points[int(np.argwhere(bad)[0][0])]
    return f", at the point ({', '.join(f'{x:g}' for x in point)})"
