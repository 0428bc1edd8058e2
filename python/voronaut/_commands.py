"""What users call. Written by scripts/declare.py from what the commands declare: change it there."""

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


def mesh(
    domain: object,
    metric: MetricLike,
    n: int | None = None,
    *,
    complexity: float | None = None,
    h_min: float | None = None,
    h_max: float | None = None,
    norm: float | str = 2,
    recovery: str = 'fit',
    a_max: float | None = None,
    gradation: float | None = None,
    smooth_metric: int = 0,
    tensor_order: str = 'disk',
    background: File | None = None,
    hausd: float | None = None,
    required: bool = False,
    order: int = 1,
    boundary: str = 'auto',
    periodic: str | tuple[int, int] | list[tuple[int, int]] | None = None,
    fit: bool = False,
    ar: float = 45,
    nr: bool = False,
    mesher: str = 'voronoi',
    effort: str = 'normal',
    lloyd: int = 40,
    centroid: str = 'tangent',
    polish: int = 20,
    dual: str = 'both',
    geodesic: str = 'march',
    seeding: str = 'sizing',
    protection: float = 0.2,
    picking_radius: float = 0.3,
    net: bool = False,
    canvas: str = 'intrinsic',
    canvas_size: int | str = 60,
    picture: File | None = None,
    show: str = 'mesh',
    pixels: int = 1600,
    window: str | None = None,
    histograms: File | None = None,
    view: File | None = None,
    cells: bool = False,
    repair: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Mesh:
    """Meshes a domain: valid, with edges of length one in a metric.

    Parameters
    ----------
    domain : file, shape, arrays, mesh or object with `__geo_interface__`
        What to mesh: `"rect:0,0,2,1"`, `"wing.mesh"`, `"sphere:1"`, a tuple of points (N, 2) and segments (K, 2), of
        points (N, 3) and triangles (M, 3), with labels as a third if there are some; a mesh of voronaut, pyvista or
        meshio.
    metric : Metric, number, text, array or function
        Sizes and directions: one size, what the command line has (`"uniform"`, `"swirl"`, `"curvature"`,
        `"hessian:EXPR"`, `"formula:m11; m12; m22"`, `"boundary:h0=0.1"`, `"FILE.sol"`), sizes or tensors at the
        domain's vertices, or a function of points.
    n : int, optional
        Vertices; one factor scales the metric to meet it.
    complexity : float, optional
        Integral of sqrt(det M) over the domain; one factor scales the metric to meet it
    h_min : float, optional
        Least Euclidean size the metric may ask for
    h_max : float, optional
        Greatest Euclidean size the metric may ask for
    norm : float | str, default 2
        With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    recovery : str, default 'fit'
        With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double
        projection (l2)
    a_max : float, optional
        Greatest ratio of the two sizes at a point, at least 1
    gradation : float, optional
        Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
        smooth_metric has it [default: no gradation]
    smooth_metric : int, default 0
        Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a
        .sol file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    tensor_order : str, default 'disk'
        In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper
        (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    background : File, optional
        The mesh on which a .sol metric is given [default: the domain's own]
    hausd : float, optional
        How far (Euclidean) edges may stray from the boundary [default: the domain's own tolerance]; of a surface: mesh
        and surface from each other, by more vertices unless n says how many
    required : bool, default False
        In the plane: leave the edges of the domain's curves as they are, every one an edge of the mesh
    order : int, default 1
        The order of triangles: 1, straight; 2 or 3, curved: in the plane to follow the metric, or with hessian:EXPR so
        that interpolation by polynomials of that order has the least error; on sphere:, torus: and f = 0 to follow the
        surface (.msh, .vtu, .mesh and .meshb hold them)
    boundary : str, default 'auto'
        What boundaries of curved triangles are: auto (the circle of disk:, else polyline), polyline (the domain's own
        straight segments), or spline (smooth curves through its vertices; corners of more than 45 degrees stay)
    periodic : str | tuple[int, int] | list[tuple[int, int]], optional
        In the plane: edges on the boundary curves with labels A and B correspond, which are equal but for a rotation
        and a translation; for several pairs several times
    fit : bool, default False
        Surfaces: vertices where mesh and surface are closest in the sense of least squares, instead of on the surface
    ar : float (degrees), default 45
        Edges of a surface where its normal turns by more than this angle are creases: they are kept, as borders, listed
        edges and edges between labels are, and with them the corners where such curves turn by as much. Metrics know
        nothing of what is beyond
    nr : bool, default False
        Look for no creases and corners by angles
    mesher : str, default 'voronoi'
        What makes the mesh: voronoi, or starset (Delaunay stars in the metrics of their vertices, refined until they
        agree: to compare; n then sets the scale only)
    effort : str, default 'normal'
        How much work is spent on what is left to gain: fast, normal or best
    lloyd : int, default 40
        Steps of Riemannian Lloyd relaxation, at most
    centroid : str, default 'tangent'
        The centroids seeds are relaxed to: tangent (of cells in tangent planes), canvas (of the diagram's cells) or
        weighted (equation 9 of the report, to compare)
    polish : int, default 20
        With hessian metrics: sweeps in which vertices move and edges flip so that the error of interpolation falls, at
        most; 0 for the metric's unit mesh. Not with limits on the metric
    dual : str, default 'both'
        What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where
        lengths cannot)
    geodesic : str, default 'march'
        How distances on the canvas are computed where the diagram decides: march, stvd[:window=8], dijkstra or
        konukoglu
    seeding : str, default 'sizing'
        Where interior seeds come to lie: sizing (at circumcentres), farthest (from all seeds, on a canvas) or protected
        (sizing, and power-protected)
    protection : float, default 0.2
        With seeding protected: the protection asked for, as a share of the greatest circumradius
    picking_radius : float, default 0.3
        In the plane with seeding protected: where a seed may be picked around a circumcentre, as a share of the
        circumradius
    net : bool, default False
        Measure the net of the vertices: epsilon, mu, lambda, power protection (in the report)
    canvas : str, default 'intrinsic'
        What distances travel on, where a canvas is used: intrinsic, isotropic or starset (see `dual`)
    canvas_size : int | str, default 60
        Canvas vertices per seed, where a canvas is used
    picture : File, optional
        Draw a picture: .svg or .png
    show : str, default 'mesh'
        What the picture shows: mesh, ellipses, cells, witnesses, geodesics, triangles, protection, unmet, certificate
    pixels : int, default 1600
        Pixels of the picture's longer side
    window : str, optional
        What the picture is cut to: x0,y0,x1,y1 [default: everything]
    histograms : File, optional
        Draw how metric edge lengths and angles are distributed, with straight and with geodesic edges: .svg
    view : File, optional
        Write a page to look at the mesh with, in any browser (see `view`): .html
    cells : bool, default False
        With view: show Voronoi cells, distances in them, and geodesic edges, too
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    Mesh
        With the command's report.

    Examples
    --------
    >>> layer = voronaut.mesh("rect:0,0,1,1", lambda p: 0.01 + 0.2 * abs(p[:, 1] - 0.5), n=2000)
    """
    options = {"complexity": complexity, "h_min": h_min, "h_max": h_max, "norm": norm, "recovery": recovery, "a_max": a_max, "gradation": gradation, "smooth_metric": smooth_metric, "tensor_order": tensor_order, "background": background, "hausd": hausd, "required": required, "order": order, "boundary": boundary, "periodic": periodic, "fit": fit, "ar": ar, "nr": nr, "mesher": mesher, "effort": effort, "lloyd": lloyd, "centroid": centroid, "polish": polish, "dual": dual, "geodesic": geodesic, "seeding": seeding, "protection": protection, "picking_radius": picking_radius, "net": net, "canvas": canvas, "canvas_size": canvas_size, "picture": picture, "show": show, "pixels": pixels, "window": window, "histograms": histograms, "view": view, "cells": cells, "repair": repair, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"norm": 2, "recovery": 'fit', "smooth_metric": 0, "tensor_order": 'disk', "order": 1, "boundary": 'auto', "ar": 45, "mesher": 'voronoi', "effort": 'normal', "lloyd": 40, "centroid": 'tangent', "polish": 20, "dual": 'both', "geodesic": 'march', "seeding": 'sizing', "protection": 0.2, "picking_radius": 0.3, "canvas": 'intrinsic', "canvas_size": 60, "show": 'mesh', "pixels": 1600, "memory_limit": 16}
    return _run.mesh(domain, metric, n, options, defaults, progress)


def dual(
    domain: object,
    metric: MetricLike,
    seeds: npt.ArrayLike,
    *,
    dual: str = 'both',
    voronoi: str = 'riemannian',
    geodesic: str = 'march',
    edges: str = 'straight',
    canvas: str = 'intrinsic',
    canvas_size: int | str = 60,
    certify: bool = False,
    net: bool = False,
    constants: str = 'corrected',
    strict: bool = False,
    h_min: float | None = None,
    h_max: float | None = None,
    norm: float | str = 2,
    recovery: str = 'fit',
    a_max: float | None = None,
    gradation: float | None = None,
    smooth_metric: int = 0,
    tensor_order: str = 'disk',
    background: File | None = None,
    picture: File | None = None,
    show: str = 'mesh',
    pixels: int = 1600,
    window: str | None = None,
    histograms: File | None = None,
    view: File | None = None,
    cells: bool = False,
    repair: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Mesh:
    """The dual of the Riemannian Voronoi diagram of the seeds given: none is added or moved.

    Parameters
    ----------
    domain : file, shape, arrays, mesh or object with `__geo_interface__`
        What to mesh: `"rect:0,0,2,1"`, `"wing.mesh"`, `"sphere:1"`, a tuple of points (N, 2) and segments (K, 2), of
        points (N, 3) and triangles (M, 3), with labels as a third if there are some; a mesh of voronaut, pyvista or
        meshio.
    metric : Metric, number, text, array or function
        Sizes and directions: one size, what the command line has (`"uniform"`, `"swirl"`, `"curvature"`,
        `"hessian:EXPR"`, `"formula:m11; m12; m22"`, `"boundary:h0=0.1"`, `"FILE.sol"`), sizes or tensors at the
        domain's vertices, or a function of points.
    seeds : (N, 2) or (N, 3) array
        Seed i is vertex i.
    dual : str, default 'both'
        What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where
        lengths cannot)
    voronoi : str, default 'riemannian'
        Which Voronoi diagram: riemannian, or, by straight distances, du-wang (in the metric of the place) or
        labelle-shewchuk (in that of the seed). Of these two OUT has the nerve as the canvas shows it, whatever dual
        says; show cells has their orphans in red
    geodesic : str, default 'march'
        How distances on the canvas are computed: march, stvd[:window=8], dijkstra or konukoglu
    edges : str, default 'straight'
        How OUT has the edges: straight, or as the geodesics that they are (polylines, with the regions between them)
    canvas : str, default 'intrinsic'
        What distances travel on: intrinsic (even in the metric), isotropic (Euclidean Delaunay, as fine as the metric's
        finest direction) or starset (even in the metric; methods on graphs travel along Delaunay stars, each in its own
        metric)
    canvas_size : int | str, default 60
        Canvas vertices per seed (of up to 300 seeds the canvas is that of 2,500); or certified: as many as the theorems
        ask for
    certify : bool, default False
        Say which of the report's theorems hold of these seeds and this canvas, by how much others miss, and what it
        would take
    net : bool, default False
        Measure the seeds as a net: epsilon, mu, protection (report)
    constants : str, default 'corrected'
        The formulas of these theorems: corrected, or printed (with the report's errors, to compare)
    strict : bool, default False
        Exit with 1 if what OUT would hold is not embedded: straight triangles inverted, edges that cross
    h_min : float, optional
        Least Euclidean size the metric may ask for
    h_max : float, optional
        Greatest Euclidean size the metric may ask for
    norm : float | str, default 2
        With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    recovery : str, default 'fit'
        With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double
        projection (l2)
    a_max : float, optional
        Greatest ratio of the two sizes at a point, at least 1
    gradation : float, optional
        Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
        smooth_metric has it [default: no gradation]
    smooth_metric : int, default 0
        Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a
        .sol file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    tensor_order : str, default 'disk'
        In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper
        (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    background : File, optional
        The mesh on which a .sol metric is given [default: the domain's own]
    picture : File, optional
        Draw a picture: .svg or .png
    show : str, default 'mesh'
        What the picture shows: mesh, ellipses, cells, witnesses, geodesics, triangles, protection, unmet, certificate
    pixels : int, default 1600
        Pixels of the picture's longer side
    window : str, optional
        What the picture is cut to: x0,y0,x1,y1 [default: everything]
    histograms : File, optional
        Draw how metric edge lengths and angles are distributed, with straight and with geodesic edges: .svg
    view : File, optional
        Write a page to look at the mesh with, in any browser (see `view`): .html
    cells : bool, default False
        With view: show Voronoi cells, distances in them, and geodesic edges, too
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    Mesh
        With the report, and in `diagram` the canvas: fields `colour` (seeds from 0) and `distance`.

    Examples
    --------
    >>> rdt = voronaut.dual("rect:-2,-2,2,2", "swirl", seeds)
    """
    options = {"dual": dual, "voronoi": voronoi, "geodesic": geodesic, "edges": edges, "canvas": canvas, "canvas_size": canvas_size, "certify": certify, "net": net, "constants": constants, "strict": strict, "h_min": h_min, "h_max": h_max, "norm": norm, "recovery": recovery, "a_max": a_max, "gradation": gradation, "smooth_metric": smooth_metric, "tensor_order": tensor_order, "background": background, "picture": picture, "show": show, "pixels": pixels, "window": window, "histograms": histograms, "view": view, "cells": cells, "repair": repair, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"dual": 'both', "voronoi": 'riemannian', "geodesic": 'march', "edges": 'straight', "canvas": 'intrinsic', "canvas_size": 60, "constants": 'corrected', "norm": 2, "recovery": 'fit', "smooth_metric": 0, "tensor_order": 'disk', "show": 'mesh', "pixels": 1600, "memory_limit": 16}
    return _run.dual(domain, metric, seeds, options, defaults, progress)


def distance(
    domain: object,
    metric: MetricLike,
    start: npt.ArrayLike,
    to: npt.ArrayLike | None = None,
    *,
    geodesic: str = 'march',
    canvas: str = 'intrinsic',
    canvas_size: int | str = 40000,
    picture: File | None = None,
    pixels: int = 1600,
    h_min: float | None = None,
    h_max: float | None = None,
    norm: float | str = 2,
    recovery: str = 'fit',
    a_max: float | None = None,
    gradation: float | None = None,
    smooth_metric: int = 0,
    tensor_order: str = 'disk',
    background: File | None = None,
    repair: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Mesh:
    """Distances in a metric from points to everywhere, and the shortest path to one.

    Parameters
    ----------
    domain : file, shape, arrays, mesh or object with `__geo_interface__`
        What to mesh: `"rect:0,0,2,1"`, `"wing.mesh"`, `"sphere:1"`, a tuple of points (N, 2) and segments (K, 2), of
        points (N, 3) and triangles (M, 3), with labels as a third if there are some; a mesh of voronaut, pyvista or
        meshio.
    metric : Metric, number, text, array or function
        Sizes and directions: one size, what the command line has (`"uniform"`, `"swirl"`, `"curvature"`,
        `"hessian:EXPR"`, `"formula:m11; m12; m22"`, `"boundary:h0=0.1"`, `"FILE.sol"`), sizes or tensors at the
        domain's vertices, or a function of points.
    start : point or (N, 2), (N, 3) array
        Where distances start.
    to : point, optional
        Where a path leads; its points come behind the canvas's, its segments are the mesh's edges.
    geodesic : str, default 'march'
        How distances are computed
    canvas : str, default 'intrinsic'
        What distances travel on: intrinsic, isotropic or starset (see `dual`)
    canvas_size : int | str, default 40000
        Vertices of the canvas, in all
    picture : File, optional
        Draw the distances, lines of equal distance and the path: .svg or .png
    pixels : int, default 1600
        Pixels of the picture's longer side
    h_min : float, optional
        Least Euclidean size the metric may ask for
    h_max : float, optional
        Greatest Euclidean size the metric may ask for
    norm : float | str, default 2
        With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    recovery : str, default 'fit'
        With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double
        projection (l2)
    a_max : float, optional
        Greatest ratio of the two sizes at a point, at least 1
    gradation : float, optional
        Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
        smooth_metric has it [default: no gradation]
    smooth_metric : int, default 0
        Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a
        .sol file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    tensor_order : str, default 'disk'
        In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper
        (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    background : File, optional
        The mesh on which a .sol metric is given [default: the domain's own]
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    Mesh
        The canvas, with the field `distance`, and the report.

    Examples
    --------
    >>> far = voronaut.distance("rect:-2,-2,2,2", "swirl", (1, 0.5))
    """
    options = {"geodesic": geodesic, "canvas": canvas, "canvas_size": canvas_size, "picture": picture, "pixels": pixels, "h_min": h_min, "h_max": h_max, "norm": norm, "recovery": recovery, "a_max": a_max, "gradation": gradation, "smooth_metric": smooth_metric, "tensor_order": tensor_order, "background": background, "repair": repair, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"geodesic": 'march', "canvas": 'intrinsic', "canvas_size": 40000, "pixels": 1600, "norm": 2, "recovery": 'fit', "smooth_metric": 0, "tensor_order": 'disk', "memory_limit": 16}
    return _run.distance(domain, metric, start, to, options, defaults, progress)


def check(
    mesh: object,
    metric: MetricLike | None = None,
    domain: object | None = None,
    *,
    metric_scale: float | None = None,
    function: str | None = None,
    h_min: float | None = None,
    h_max: float | None = None,
    norm: float | str = 2,
    recovery: str = 'fit',
    a_max: float | None = None,
    gradation: float | None = None,
    smooth_metric: int = 0,
    tensor_order: str = 'disk',
    background: File | None = None,
    ar: float = 45,
    nr: bool = False,
    picture: File | None = None,
    show: str = 'mesh',
    pixels: int = 1600,
    window: str | None = None,
    histograms: File | None = None,
    repair: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> dict[str, Any]:
    """Examines a mesh: validity, quality in a metric, distance to its domain.

    Parameters
    ----------
    mesh : Mesh, file or arrays
        What to examine.
    metric : Metric, number, text, array or function
        Sizes and directions: one size, what the command line has (`"uniform"`, `"swirl"`, `"curvature"`,
        `"hessian:EXPR"`, `"formula:m11; m12; m22"`, `"boundary:h0=0.1"`, `"FILE.sol"`), sizes or tensors at the
        domain's vertices, or a function of points.
    domain : as for `mesh`, optional
        What it should be a mesh of.
    metric_scale : float, optional
        A factor on the metric tensor, such as `metric_scale` of a report
    function : str, optional
        Measure the error of interpolation of this function of x and y, by polynomials of the triangles' order, on a
        surface (of order 1) of x, y and z, in the L^p norm of norm
    h_min : float, optional
        Least Euclidean size the metric may ask for
    h_max : float, optional
        Greatest Euclidean size the metric may ask for
    norm : float | str, default 2
        With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    recovery : str, default 'fit'
        With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double
        projection (l2)
    a_max : float, optional
        Greatest ratio of the two sizes at a point, at least 1
    gradation : float, optional
        Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
        smooth_metric has it [default: no gradation]
    smooth_metric : int, default 0
        Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a
        .sol file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    tensor_order : str, default 'disk'
        In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper
        (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    background : File, optional
        The mesh on which a .sol metric is given [default: the domain's own]
    ar : float (degrees), default 45
        Edges of a surface where its normal turns by more than this angle are creases: they are kept, as borders, listed
        edges and edges between labels are, and with them the corners where such curves turn by as much. Metrics know
        nothing of what is beyond
    nr : bool, default False
        Look for no creases and corners by angles
    picture : File, optional
        Draw a picture: .svg or .png
    show : str, default 'mesh'
        What the picture shows: mesh, ellipses, cells, witnesses, geodesics, triangles, protection, unmet, certificate
    pixels : int, default 1600
        Pixels of the picture's longer side
    window : str, optional
        What the picture is cut to: x0,y0,x1,y1 [default: everything]
    histograms : File, optional
        Draw how metric edge lengths and angles are distributed, with straight and with geodesic edges: .svg
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    dict
        The report; of a mesh that is not valid `valid`, False, and `fault`.

    Examples
    --------
    >>> voronaut.check(layer)["valid"]
    True
    """
    options = {"metric_scale": metric_scale, "function": function, "h_min": h_min, "h_max": h_max, "norm": norm, "recovery": recovery, "a_max": a_max, "gradation": gradation, "smooth_metric": smooth_metric, "tensor_order": tensor_order, "background": background, "ar": ar, "nr": nr, "picture": picture, "show": show, "pixels": pixels, "window": window, "histograms": histograms, "repair": repair, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"norm": 2, "recovery": 'fit', "smooth_metric": 0, "tensor_order": 'disk', "ar": 45, "show": 'mesh', "pixels": 1600, "memory_limit": 16}
    return _run.check(mesh, metric, domain, options, defaults, progress)


def remesh(
    mesh: object,
    metric: npt.ArrayLike | None = None,
    *,
    hausd: float = 0.01,
    hmin: float | None = None,
    hmax: float | None = None,
    hsiz: float | None = None,
    ar: float = 45,
    nr: bool = False,
    repair: bool = False,
    hgrad: float = 1.3,
    anisotropic: bool = False,
    optim: bool = False,
    nosurf: bool = False,
    opnbdy: bool = False,
    nosizreq: bool = False,
    no_fit: bool = False,
    effort: str | None = None,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Mesh:
    """Meshes a planar mesh or a surface anew, with the options of mmg2d and mmgs.

    Parameters
    ----------
    mesh : Mesh, file or arrays
        What to remesh.
    metric : array, optional
        Sizes or tensors at its vertices.
    hausd : float, default 0.01
        How far the mesh may be from the surface, or from the curves of a planar domain
    hmin : float, optional
        No size is less [default: a thousandth of the extent; of a planar mesh with a metric a tenth of its least]
    hmax : float, optional
        No size is more [default: the bounding box's diagonal; of a planar mesh twice its extent, or ten times a
        metric's greatest]
    hsiz : float, optional
        The same size everywhere, but where the distance to surface or curves asks for less
    ar : float (degrees), default 45
        Edges where the normal turns by more than this angle (degrees) are creases, and curves that do have a corner;
        both are kept
    nr : bool, default False
        Look for no creases and corners by angles
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    hgrad : float, default 1.3
        Sizes grow from edge to edge by this factor at most; -1: as they will
    anisotropic : bool, default False
        Sizes that follow the directions of curvature and curves, or of the planar mesh's own triangles (-optim)
    optim : bool, default False
        The sizes that a planar mesh has
    nosurf : bool, default False
        Leave the edges of a planar mesh's boundary and interfaces as they are
    opnbdy : bool, default False
        Keep listed edges inside a region of a planar mesh, required or not
    nosizreq : bool, default False
        Sizes at required edges of a planar mesh as elsewhere, even where these are shorter
    no_fit : bool, default False
        Vertices on the surface, instead of where mesh and surface are closest in the sense of least squares
    effort : str, optional
        How much work is spent on what is left to gain: fast, normal or best [default: fast in the plane, normal on a
        surface]
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    Mesh
        With the report, and the metric that was used as the field `metric`.

    Examples
    --------
    >>> fine = voronaut.remesh("part.mesh", hausd=0.001, hmax=0.1)
    """
    options = {"hausd": hausd, "hmin": hmin, "hmax": hmax, "hsiz": hsiz, "ar": ar, "nr": nr, "repair": repair, "hgrad": hgrad, "anisotropic": anisotropic, "optim": optim, "nosurf": nosurf, "opnbdy": opnbdy, "nosizreq": nosizreq, "no_fit": no_fit, "effort": effort, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"hausd": 0.01, "ar": 45, "hgrad": 1.3, "memory_limit": 16}
    return _run.remesh(mesh, metric, options, defaults, progress)


def transfer(
    old: object,
    new: object,
    fields: Mapping[str, npt.ArrayLike] | npt.ArrayLike,
    *,
    conservative: bool = False,
    overshoot: bool = False,
    linear_tensors: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Any:
    """Carries fields from one planar mesh to another of the same domain.

    Parameters
    ----------
    old, new : Mesh, file or arrays
        The meshes.
    fields : array, or mapping of names to arrays
        At the vertices of the old mesh, linear between them, or one for each of its triangles. Symmetric tensors (N, 2,
        2) are taken for metrics, unless `linear_tensors`.
    conservative : bool, default False
        Keep the integral of every component over the domain
    overshoot : bool, default False
        With conservative: let values next to a front be beyond those on both its sides, for the least L2 distance
    linear_tensors : bool, default False
        Symmetric tensors are no metrics (stresses, Hessians): carry each entry for itself
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    array, or dict of arrays
        As the fields are given.

    Examples
    --------
    >>> u_new = voronaut.transfer(old, new, u, conservative=True)
    """
    options = {"conservative": conservative, "overshoot": overshoot, "linear_tensors": linear_tensors, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"memory_limit": 16}
    return _run.transfer(old, new, fields, options, defaults, progress)


def view(
    meshes: object,
    metric: MetricLike | None = None,
    *,
    metric_scale: float | None = None,
    domain: str | None = None,
    cells: bool = False,
    canvas_size: int | str = 60,
    title: str | None = None,
    h_min: float | None = None,
    h_max: float | None = None,
    norm: float | str = 2,
    recovery: str = 'fit',
    a_max: float | None = None,
    gradation: float | None = None,
    smooth_metric: int = 0,
    tensor_order: str = 'disk',
    background: File | None = None,
    ar: float = 45,
    nr: bool = False,
    repair: bool = False,
    threads: int | None = None,
    time_limit: float | None = None,
    memory_limit: float = 16,
    progress: Progress = False,
) -> Page:
    """A page to look at meshes with: in a notebook, or in a file that any browser opens, without a network.

    Parameters
    ----------
    meshes : Mesh, file, arrays, or list of these
        What to show; of several, one after the other or two side by side.
    metric : Metric, number, text, array or function
        Sizes and directions: one size, what the command line has (`"uniform"`, `"swirl"`, `"curvature"`,
        `"hessian:EXPR"`, `"formula:m11; m12; m22"`, `"boundary:h0=0.1"`, `"FILE.sol"`), sizes or tensors at the
        domain's vertices, or a function of points.
    metric_scale : float, optional
        A factor on the metric tensor, such as `metric_scale` of a report
    domain : str, optional
        The domain or the surface that the metric is given on (as for `mesh`) [default: the mesh]
    cells : bool, default False
        Show Voronoi cells of the vertices in the metric, distances from them, and edges as geodesics
    canvas_size : int | str, default 60
        With cells: canvas vertices per seed
    title : str, optional
        What stands above the page [default: the names of the meshes]
    h_min : float, optional
        Least Euclidean size the metric may ask for
    h_max : float, optional
        Greatest Euclidean size the metric may ask for
    norm : float | str, default 2
        With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    recovery : str, default 'fit'
        With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double
        projection (l2)
    a_max : float, optional
        Greatest ratio of the two sizes at a point, at least 1
    gradation : float, optional
        Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
        smooth_metric has it [default: no gradation]
    smooth_metric : int, default 0
        Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a
        .sol file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    tensor_order : str, default 'disk'
        In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper
        (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    background : File, optional
        The mesh on which a .sol metric is given [default: the domain's own]
    ar : float (degrees), default 45
        Edges of a surface where its normal turns by more than this angle are creases: they are kept, as borders, listed
        edges and edges between labels are, and with them the corners where such curves turn by as much. Metrics know
        nothing of what is beyond
    nr : bool, default False
        Look for no creases and corners by angles
    repair : bool, default False
        Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a
        point; and small holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.)
        Outlines: points nearer than 1e-9 of the diagonal are joined, lines cut where they cross, and where polygons
        overlap the first has the say
    threads : int, optional
        Threads to use [default: all]
    time_limit : float (seconds), optional
        Stop, without an output, after so many seconds
    memory_limit : float (GiB), default 16
        Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more
        all the same
    progress : bool or function, default False
        True shows a bar; a function is called with the stage, how much is done and of how much, and stops the work
        where it returns False.

    Returns
    -------
    Page
        Notebooks show it; `save(path)` writes it. Without `metric_scale` the metric is scaled as that of the mesh was.

    Examples
    --------
    >>> voronaut.view(layer, cells=True, metric="swirl").save("layer.html")
    """
    options = {"metric_scale": metric_scale, "domain": domain, "cells": cells, "canvas_size": canvas_size, "title": title, "h_min": h_min, "h_max": h_max, "norm": norm, "recovery": recovery, "a_max": a_max, "gradation": gradation, "smooth_metric": smooth_metric, "tensor_order": tensor_order, "background": background, "ar": ar, "nr": nr, "repair": repair, "threads": threads, "time_limit": time_limit, "memory_limit": memory_limit}
    defaults: dict[str, Any] = {"canvas_size": 60, "norm": 2, "recovery": 'fit', "smooth_metric": 0, "tensor_order": 'disk', "ar": 45, "memory_limit": 16}
    return _run.view(meshes, metric, options, defaults, progress)
