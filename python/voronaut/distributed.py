"""One mesh in parts, made by the ranks of MPI, or by the cores of one machine.

    from mpi4py import MPI
    mesh = voronaut.distributed.mesh("sea.geojson", "boundary:h0=0.5,growth=1.2", n=2_000_000, comm=MPI.COMM_WORLD)

What comes out depends on the input and the number of parts alone: not on the number of ranks, nor on who is faster.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib.metadata
import os
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
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

_PERIOD = 0.005
"""Seconds between two looks at whether there is news."""
_ARENA_MAX, _MMAP_THRESHOLD = -8, -3
"""The numbers of these options of glibc's mallopt."""
_GIVES_BACK = 0.05
"""Seconds between two times that memory is given back."""


class Job(NamedTuple):
    """A part to make: the name of its round and its number in it, its domain as arrays, how many vertices, and its metric as a mesh with
    values, where it has one of its own."""

    round: str
    number: int
    domain: dict[str, Any]
    vertices: int
    metric: dict[str, Any] | None

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
        The same on every rank. Of a metric that is interpolated in a mesh in the plane (values on one, files, functions, what is graded or
        smoothed) rank 0 alone looks at it, and sends what parts need; others every rank makes by itself.
    n : int
        Vertices.
    parts : int or "auto", default "auto"
        How many parts, of 1,000 vertices or more; by itself as many as there are 100,000 vertices.
    comm : communicator of mpi4py, optional
        Whose ranks make parts, one at a time each; all of them call this. Without, as many threads of this process as there are cores.
        So that ranks need little memory, glibc is told to use one arena for all threads of theirs from then on.
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

    def make(self, job: Job, place: Path | None, progress: Progress = False) -> dict[str, Any] | Path:
        """The mesh of a job, or where it is."""
        if place is not None and place.exists():
            return place
        _give_back()
        made = _run.part(self.domain, self.metric, self.n, (job.domain, job.vertices, job.metric), self.options, progress)
        _give_back()
        if place is None:
            return made
        Mesh._of(made).save(place)
        return place


def _tune(option: int, value: int) -> None:
    """Sets an option of the C library's memory, where it has them."""
    if sys.platform == "linux":
        mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
        if mallopt is not None:
            mallopt(option, value)


def _give_back() -> None:
    """Has the C library return what was freed to the system, where it can: each part is made on threads of its own, whose memory glibc
    would keep apart, so that a rank would come to hold several parts' worth."""
    if sys.platform == "linux":
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim is not None:
            trim(0)


def _values(function: Callable[..., Any], points: Floats) -> Any:
    """What a function of places says; of a part in the plane z = 0 the domain may be a surface all the same."""
    if points[:, 2].any():
        return function(points)
    try:
        return function(np.ascontiguousarray(points[:, :2]))
    except Exception:
        return function(points)


class _Team:
    """Who makes parts: rank 0 says what, and all of them do, itself included; who is done gets the next."""

    def __init__(self, comm: Any, maker: _Maker) -> None:
        # What is said here is not mixed up with what the caller's ranks say to each other.
        self.comm: Any = None if comm is None else comm.Dup()
        if comm is not None:
            # Of what each thread would have to itself not all can be given back.
            _tune(_ARENA_MAX, 1)
        self.maker = maker
        self.rank = 0 if comm is None else comm.Get_rank()
        self.others = 0 if comm is None else comm.Get_size() - 1
        self.idle = list(range(1, self.others + 1))
        self.jobs: deque[Job] = deque()
        self.done: list[tuple[int, Path]] = []
        self.faults: list[tuple[int, Fault]] = []
        self.scratch = Path()
        self.done_with: threading.Event | None = None

    def lead(self, parts: int | str, options: Options, progress: Progress) -> Mesh:
        asked, fault = {**options, "parts": parts}, None
        # What is done waits in files: it would take the memory in which parts are made.
        with tempfile.TemporaryDirectory(prefix="voronaut-") as scratch:
            self.scratch = Path(scratch)
            try:
                return _run.mesh_in_parts(self.maker.domain, self.maker.metric, self.maker.n, asked, self.make, progress)
            except BaseException as error:
                fault = f"{type(error).__name__}: {error}"
                raise
            finally:
                if self.done_with is not None:
                    self.done_with.set()
                self.jobs.clear()
                self.await_others()
                for rank in self.idle:
                    self.comm.send(fault, rank)
                if self.comm is not None:
                    self.comm.Free()

    def make(self, name: str, parts: list[tuple[dict[str, Any], int, dict[str, Any] | None]]) -> Iterator[dict[str, Any]]:
        """The meshes of a round, in the order of its parts."""
        jobs = [Job(name, number, *part) for number, part in enumerate(parts)]
        largest_first = sorted(jobs, key=lambda job: -job.vertices)
        self.done, self.faults = [], []
        if self.comm is None:
            # Functions are called from one thread at a time.
            places = {job.number: self.maker.place(job) for job in jobs}
            with ThreadPoolExecutor(_cores()) as pool:
                for attempt in pool.map(lambda job: _attempt(self.maker, job, lambda job: places[job.number]), largest_first):
                    self.keep(*attempt)
        else:
            self.jobs = deque(largest_first)
            self.serve()
            while self.jobs:
                self.keep(*_attempt(self.maker, self.jobs.popleft(), self.maker.place, self.serve))
            self.await_others()
            self.tidy()
        if self.faults:
            raise Error(*min(self.faults)[1])
        return (_arrays_in(place) for _, place in sorted(self.done))

    def keep(self, number: int, made: dict[str, Any] | bytes | Path | None, fault: Fault | None) -> None:
        if fault is not None:
            self.faults.append((number, fault))
            self.jobs.clear()
            return
        place = made if isinstance(made, Path) else self.scratch / f"{number}.meshb"
        if isinstance(made, bytes):
            place.write_bytes(made)
        elif isinstance(made, dict):
            Mesh._of(made).save(place)
        self.done.append((number, place))

    def serve(self, *_: object) -> None:
        """Takes what others have made, and gives them more to do."""
        while self.others and self.comm.iprobe():
            rank, attempt = self.comm.recv()
            self.idle.append(rank)
            self.keep(*attempt)
        while self.jobs and self.idle:
            self.comm.send(self.jobs.popleft(), self.idle.pop())

    def await_others(self) -> None:
        while len(self.idle) < self.others:
            time.sleep(_PERIOD)
            self.serve()

    def tidy(self) -> None:
        """From now on, while rank 0 holds the whole mesh, has what was freed given back again and again: it would come to be half as
        much as is in use."""
        if self.done_with is None:
            # What is larger is given back at once; while parts are made that takes a tenth of the time.
            _tune(_MMAP_THRESHOLD, 1 << 20)
            done = self.done_with = threading.Event()

            def give_back() -> None:
                while not done.wait(_GIVES_BACK):
                    _give_back()

            threading.Thread(target=give_back, daemon=True).start()

    def follow(self) -> None:
        """Does what rank 0 says. Whoever waits sleeps: MPI's own waiting takes a core."""
        while True:
            while not self.comm.iprobe():
                time.sleep(_PERIOD)
            job = self.comm.recv()
            if not isinstance(job, Job):
                break
            number, made, failed = _attempt(self.maker, job, self.maker.place)
            self.comm.send((self.rank, (number, _packed(made) if isinstance(made, dict) else made, failed)), 0)
        self.comm.Free()
        if job is not None:
            raise Error(f"rank 0: {job}")


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


Fault = tuple[str, str]
Attempt = tuple[int, Union[dict[str, Any], Path, None], Union[Fault, None]]


def _attempt(maker: _Maker, job: Job, place: Callable[[Job], Union[Path, None]], progress: Progress = False) -> Attempt:
    """The number of a job with its mesh, or where that is, or how it failed."""
    try:
        return job.number, maker.make(job, place(job), progress), None
    except Exception as error:
        return job.number, None, (f"{job}: {getattr(error, 'what', error)}", getattr(error, "help", ""))


def _packed(made: dict[str, Any]) -> bytes:
    """A mesh as it is in a file: less than half of its arrays."""
    with tempfile.TemporaryDirectory(prefix="voronaut-") as scratch:
        place = Path(scratch) / "part.meshb"
        Mesh._of(made).save(place)
        return place.read_bytes()


def _arrays_in(place: Path) -> dict[str, Any]:
    mesh = Mesh.read(place)
    return mesh._arrays() | {"is_planar": mesh.is_planar}


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
