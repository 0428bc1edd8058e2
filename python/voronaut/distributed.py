"""One mesh in parts, made by the ranks of MPI, or by the cores of one machine.

    from mpi4py import MPI
    mesh = voronaut.distributed.mesh("sea.geojson", "boundary:h0=0.5,growth=1.2", n=2_000_000, comm=MPI.COMM_WORLD)

What comes out depends on the input and the number of parts alone: not on the number of ranks, nor on who is faster.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple, Union
from xml.etree import ElementTree

import numpy as np

from . import _given, _run
from ._errors import Error
from ._given import Floats, Ints
from ._mesh import Mesh
from ._metric import MetricLike
from ._run import Options, Progress

__all__ = ["Share", "mesh"]


class Job(NamedTuple):
    """A part to make: the name of its round and its number in it, its domain as arrays, and how many vertices."""

    round: str
    number: int
    domain: dict[str, Any]
    vertices: int

    def __str__(self) -> str:
        points = self.domain["points"]
        points = points if points[:, 2].any() else points[:, :2]
        low, high = (tuple(at(points, axis=0).tolist()) for at in (np.min, np.max))
        return f"{self.round} {self.number}, from {low} to {high}"


class Share(NamedTuple):
    """What a rank has of a mesh: its triangles, their vertices by global numbers, and a layer of others' triangles around (ghosts).

    Vertices are in the order of their numbers. A vertex belongs to the least rank that has a triangle at it.
    """

    triangles: Ints
    """(M, 3) global numbers; the rank's own first, then ghosts."""
    triangle_labels: Ints
    """(M,) their labels."""
    owned_triangles: int
    """How many are the rank's own."""
    edges: Ints
    """(K, 2) global numbers of the edges that mean something of the rank's own triangles; of two ranks' triangles both have them."""
    edge_labels: Ints
    """(K,) their labels."""
    vertices: Ints
    """(N,) global numbers of the vertices of all of them."""
    points: Floats
    """(N, 2) where they are; on a surface (N, 3)."""
    owner: Ints
    """(N,) the rank that each belongs to."""
    vertex_count: int
    """Vertices of the whole mesh."""
    report: dict[str, Any]
    """That of the whole mesh."""

    def save(self, path: str | os.PathLike[str], comm: Any) -> None:
        """Writes the whole mesh as a `.pvtu`, which all ranks call: each writes its own triangles beside it, as `.vtu`, with their
        labels (`region`) and the vertices' numbers (`global_number`)."""
        place = Path(path)
        if place.suffix != ".pvtu":
            raise ValueError(f"{place} does not end in .pvtu")
        own = self.triangles[: self.owned_triangles]
        used = np.unique(own)
        labels = self.triangle_labels[: self.owned_triangles]
        points = self.points[np.searchsorted(self.vertices, used)]
        fields = {"global_number": used.astype(np.float64)}
        piece = Mesh(points, np.searchsorted(used, own), fields=fields, triangle_fields={"region": labels.astype(np.float64)})
        name = f"{place.stem}-{comm.Get_rank()}.vtu"
        piece.save(place.with_name(name))
        names = comm.gather(name)
        if names is not None:
            _write_pvtu(place, names)


def mesh(
    domain: object,
    metric: MetricLike,
    n: int,
    parts: int | str = "auto",
    comm: Any = None,
    *,
    parts_dir: str | os.PathLike[str] | None = None,
    gather: bool = True,
    progress: Progress = False,
    **options: Any,
) -> Union[Mesh, Share, None]:
    """Meshes a planar domain or a surface in parts: valid, with n vertices and edges of length one in a metric.

    Parameters
    ----------
    domain, metric : as for `voronaut.mesh`
        The same on every rank; each makes the metric by itself.
    n : int
        Vertices.
    parts : int or "auto", default "auto"
        How many parts, of 1,000 vertices or more; by itself as many as there are 100,000 vertices.
    comm : communicator of mpi4py, optional
        Whose ranks make parts, all of which call this. Without, as many threads of this process as there are cores.
    parts_dir : path, optional
        A folder for the meshes of parts that are done, which ranks share; whoever starts again with it goes on from them.
    gather : bool, default True
        Whether rank 0 gets the mesh, and others None; else each rank gets its `Share`.
    progress : bool or function, default False
        As for `voronaut.mesh`, on rank 0.
    **options
        As for `voronaut.mesh`, but for those that need the mesh as a whole.

    Returns
    -------
    Mesh, Share or None

    Examples
    --------
    >>> sea = voronaut.distributed.mesh("rect:0,0,1,1", "shock", n=20000, parts=4)
    """
    team = _Team(comm, _Maker(domain, metric, n, options, None if parts_dir is None else Path(parts_dir)))
    made = None
    if team.rank == 0:
        made = team.lead(parts, options, progress)
    else:
        team.follow()
    if gather or comm is None:
        return made
    shares = None if made is None else _shares(made, comm.Get_size())
    share: Share = comm.scatter(shares)
    return share


class _Maker:
    """Makes the meshes of jobs, unless they are there."""

    def __init__(self, domain: object, metric: MetricLike, n: int, options: Options, folder: Path | None) -> None:
        self.domain, self.metric, self.n, self.folder = domain, metric, n, folder
        self.options = {"threads": 1, **options}
        self.functions: list[Callable[..., Any]] = []
        self.told = hashlib.sha256()
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
            held: dict[str, dict[str, Any]] = {}
            domain_word = _given.domain_word(domain, held)
            metric_word = _run._metric_word(metric, held, domain)
            version = importlib.metadata.version("voronaut")
            self.tell(self.told, (version, n, self.options, domain_word, metric_word, held))

    def tell(self, found: Any, given: object) -> None:
        """Adds what is given to a digest: arrays and files by what is in them; functions are kept for later."""
        if isinstance(given, Mapping):
            given = sorted(given.items())
        if isinstance(given, (tuple, list)):
            found.update(f"[{len(given)}".encode())
            for part in given:
                self.tell(found, part)
        elif isinstance(given, np.ndarray):
            found.update(f"{given.dtype}{given.shape}".encode() + np.ascontiguousarray(given).tobytes())
        elif callable(given):
            self.functions.append(given)
        else:
            found.update(repr(given).encode())
            name = given.removeprefix("hessian:") if isinstance(given, str) else ""
            if name and Path(name).is_file():
                found.update(Path(name).read_bytes())

    def place(self, job: Job) -> Path | None:
        """Where the mesh of a job is kept: the name says all that it depends on, functions by their values at the part's corners."""
        if self.folder is None:
            return None
        found = self.told.copy()
        self.tell(found, (job.domain, job.vertices))
        for function in self.functions:
            self.tell(found, _values(function, job.domain["points"]))
        return self.folder / f"{job.round}-{job.number}-{found.hexdigest()[:16]}.meshb"

    def make(self, job: Job, place: Path | None) -> dict[str, Any]:
        if place is not None and place.exists():
            kept = Mesh.read(place)
            return kept._arrays() | {"is_planar": kept.is_planar}
        made = _run.part(self.domain, self.metric, self.n, job.domain, job.vertices, self.options)
        if place is not None:
            Mesh._of(made).save(place)
        return made


def _values(function: Callable[..., Any], points: Floats) -> Any:
    """What a function of places says; of a part in the plane z = 0 the domain may be a surface all the same."""
    if points[:, 2].any():
        return function(points)
    try:
        return function(np.ascontiguousarray(points[:, :2]))
    except Exception:
        return function(points)


class _Team:
    """Who makes parts: rank 0 says what, and all of them do."""

    def __init__(self, comm: Any, maker: _Maker) -> None:
        self.comm, self.maker = comm, maker
        self.rank = 0 if comm is None else comm.Get_rank()
        self.size = 1 if comm is None else comm.Get_size()

    def lead(self, parts: int | str, options: Options, progress: Progress) -> Mesh:
        asked = {**options, "parts": parts}
        try:
            made = _run.mesh_in_parts(self.maker.domain, self.maker.metric, self.maker.n, asked, self.make, progress)
        except BaseException as error:
            self.end(f"{type(error).__name__}: {error}")
            raise
        self.end(None)
        return made

    def end(self, fault: str | None) -> None:
        if self.size > 1:
            self.comm.bcast(("end", fault))

    def make(self, name: str, parts: list[tuple[dict[str, Any], int]]) -> list[dict[str, Any]]:
        """The meshes of a round, in the order of its parts."""
        jobs = [Job(name, number, domain, vertices) for number, (domain, vertices) in enumerate(parts)]
        if self.size > 1:
            self.comm.bcast(("round", None))
            mine = self.comm.scatter(_dealt(jobs, self.size))
            done = self.comm.gather(_attempt(self.maker, mine, self.maker.place))
        else:
            largest_first = sorted(jobs, key=lambda job: -job.vertices)
            # Functions are called from one thread at a time.
            places = {job.number: self.maker.place(job) for job in jobs}
            with ThreadPoolExecutor(_cores()) as pool:
                done = list(pool.map(lambda job: _attempt(self.maker, [job], lambda job: places[job.number]), largest_first))
        found: dict[int, dict[str, Any]] = {}
        for meshes, fault in done:
            if fault is not None:
                raise Error(*fault)
            found.update(meshes)
        return [found[job.number] for job in jobs]

    def follow(self) -> None:
        while True:
            what, fault = self.comm.bcast(None)
            if what == "end":
                if fault is not None:
                    raise Error(f"rank 0: {fault}")
                return
            self.comm.gather(_attempt(self.maker, self.comm.scatter(None), self.maker.place))


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _dealt(jobs: list[Job], ranks: int) -> list[list[Job]]:
    """Jobs for each rank: the largest first, each to whom has least."""
    dealt: list[list[Job]] = [[] for _ in range(ranks)]
    load = [0] * ranks
    for job in sorted(jobs, key=lambda job: (-job.vertices, job.number)):
        least = load.index(min(load))
        dealt[least].append(job)
        load[least] += job.vertices
    return dealt


Attempt = tuple[dict[int, dict[str, Any]], Union[tuple[str, str], None]]


def _attempt(maker: _Maker, jobs: Iterable[Job], place: Callable[[Job], Union[Path, None]]) -> Attempt:
    """The meshes of jobs by their numbers, up to one that fails; and how that failed."""
    found = {}
    for job in jobs:
        try:
            found[job.number] = maker.make(job, place(job))
        except Exception as error:
            return found, (f"{job}: {getattr(error, 'what', error)}", getattr(error, "help", ""))
    return found, None


def _write_pvtu(place: Path, pieces: list[str]) -> None:
    file = ElementTree.Element("VTKFile", type="PUnstructuredGrid", version="1.0", byte_order="LittleEndian", header_type="UInt64")
    grid = ElementTree.SubElement(file, "PUnstructuredGrid", GhostLevel="0")
    for kind, name, components in (("PPoints", "Points", 3), ("PPointData", "global_number", 1), ("PCellData", "region", 1)):
        of = ElementTree.SubElement(grid, kind)
        ElementTree.SubElement(of, "PDataArray", type="Float64", Name=name, NumberOfComponents=str(components))
    for piece in pieces:
        ElementTree.SubElement(grid, "Piece", Source=piece)
    ElementTree.ElementTree(file).write(place, encoding="utf-8", xml_declaration=True)


def _shares(whole: Mesh, ranks: int) -> list[Share]:
    """What each rank has of a mesh: blocks of like many triangles, cut across the longest side of what is cut."""
    block = np.zeros(len(whole.triangles), np.int32)
    _bisect(whole.points[whole.triangles].mean(axis=1), np.arange(len(block)), 0, ranks, block)
    owner = np.full(len(whole.points), ranks, np.int32)
    np.minimum.at(owner, whole.triangles, block[:, None])
    ends = np.sort(whole.edges, axis=1)
    return [_share(whole, ends, block == rank, owner) for rank in range(ranks)]


def _share(whole: Mesh, ends: Ints, own: Any, owner: Ints) -> Share:
    touched = np.zeros(len(owner), bool)
    touched[whole.triangles[own]] = True
    chosen = np.concatenate([np.flatnonzero(own), np.flatnonzero(touched[whole.triangles].any(axis=1) & ~own)])
    triangles = whole.triangles[chosen]
    vertices = np.unique(triangles)
    sides = np.sort(whole.triangles[own][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    here = np.isin(ends.astype(np.int64) @ [len(owner), 1], sides @ [len(owner), 1])
    return Share(
        triangles, whole.triangle_labels[chosen], int(own.sum()), whole.edges[here], whole.edge_labels[here],
        vertices, whole.points[vertices], owner[vertices], len(owner), whole.report,
    )


def _bisect(centres: Floats, numbers: Any, first: int, ranks: int, block: Ints) -> None:
    if ranks == 1:
        block[numbers] = first
        return
    axis = int(np.argmax(np.ptp(centres[numbers], axis=0)))
    ordered = numbers[np.argsort(centres[numbers, axis], kind="stable")]
    half = ranks // 2
    cut = len(ordered) * half // ranks
    _bisect(centres, ordered[:cut], first, half, block)
    _bisect(centres, ordered[cut:], first + half, ranks - half, block)
