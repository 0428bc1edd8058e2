"""Meshes in parts, by threads and by ranks."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import voronaut
from voronaut.distributed import Job, _Maker

PLACE = {"domain": "rect:-1,-1,1,1", "metric": "shock:phi=1,lambda=0.6", "n": 4000, "parts": 3, "effort": "fast"}


def the_bytes(mesh, path):
    mesh.save(path)
    return path.read_bytes()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    mesh = voronaut.distributed.mesh(**PLACE)
    assert mesh.report["valid"] and len(mesh.points) == 4000
    return mesh, the_bytes(mesh, tmp_path_factory.mktemp("whole") / "whole.meshb")


@pytest.mark.parametrize("ranks", [1, 2])
def test_ranks_make_what_threads_make(whole, ranks, tmp_path):
    mpiexec = Path(sys.executable).with_name("mpiexec")
    if not mpiexec.exists():
        pytest.skip("no mpich from pip")
    script = Path(__file__).with_name("ranks.py")
    # As many as asked for, on whatever machine.
    run = subprocess.run(
        [mpiexec, "-n", str(ranks), sys.executable, script, tmp_path], capture_output=True, text=True, timeout=300, env=dict(os.environ)
    )
    assert run.returncode == 0, run.stdout + run.stderr
    mesh, expected = whole
    assert (tmp_path / "whole.meshb").read_bytes() == expected
    meshio, pyvista = pytest.importorskip("meshio"), pytest.importorskip("pyvista")
    grid = pyvista.read(tmp_path / "whole.pvtu")
    assert grid.n_cells == len(mesh.triangles)
    numbers = np.asarray(grid["global_number"]).astype(int)
    assert len(np.unique(numbers)) == 4000 and (np.asarray(grid.points)[:, :2] == mesh.points[numbers]).all()
    pieces = [meshio.read(tmp_path / f"whole-{rank}.vtu") for rank in range(ranks)]
    assert sum(len(piece.cells_dict["triangle"]) for piece in pieces) == len(mesh.triangles)


def test_the_program_makes_the_same(whole, tmp_path):
    words = ["mesh", PLACE["domain"], "--metric", PLACE["metric"], "-n", "4000", "--parts", "3", "--effort", "fast", "-q"]
    subprocess.run([sys.executable, "-m", "voronaut", *words, "-o", tmp_path / "out.meshb"], check=True)
    assert (tmp_path / "out.meshb").read_bytes() == whole[1]


def test_parts_of_a_sampled_metric_are_the_same_by_threads_and_processes(tmp_path):
    grid = voronaut.mesh("rect:0,0,1,1", "uniform", n=500)
    voronaut.Mesh(grid.points, grid.triangles).save(tmp_path / "square.mesh")
    sizes = [0.02 + 0.08 * x for x, _ in grid.points]
    (tmp_path / "h.sol").write_text("\n".join(["MeshVersionFormatted 2\nDimension 2\nSolAtVertices", str(len(sizes)), "1 1", *map(str, sizes), "End"]))
    place = {"domain": str(tmp_path / "square.mesh"), "metric": str(tmp_path / "h.sol")}
    mesh = voronaut.distributed.mesh(**place, n=4000, parts=3, effort="fast")
    words = ["mesh", place["domain"], "--metric", place["metric"], "-n", "4000", "--parts", "3", "--effort", "fast", "-q"]
    subprocess.run([sys.executable, "-m", "voronaut", *words, "-o", tmp_path / "out.meshb"], check=True)
    assert (tmp_path / "out.meshb").read_bytes() == the_bytes(mesh, tmp_path / "mesh.meshb")


def test_work_goes_on_in_a_folder(whole, tmp_path):
    voronaut.distributed.mesh(**PLACE, parts_dir=tmp_path)
    kept = sorted(tmp_path.glob("*.meshb"))
    assert {path.name.split("-")[0] for path in kept} == {"parts", "strips", "junctions"}
    kept[2].unlink()
    others = {path: path.stat().st_mtime_ns for path in kept if path.exists()}
    again = voronaut.distributed.mesh(**PLACE, parts_dir=tmp_path)
    assert (again.points == whole[0].points).all() and (again.triangles == whole[0].triangles).all()
    assert kept[2].exists() and all(path.stat().st_mtime_ns == when for path, when in others.items())


def test_parts_are_kept_under_what_they_depend_on(tmp_path):
    square = voronaut.Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    job = Job("parts", 0, square._arrays(), 1000, None)
    (tmp_path / "h.sol").write_text("1")

    def name(metric, **options):
        return _Maker("rect:0,0,1,1", metric, 2000, options, tmp_path).place(job).name

    def sizes(*values):
        return voronaut.Metric.from_array(values, square)

    metrics = [sizes(1, 1, 1, 1), sizes(1, 1, 2, 1), sizes(1, 1, 1, 1).gradate(1.2), lambda p: p[:, 0] + 1, lambda p: p[:, 0] + 2]
    names = [name(metric) for metric in [*metrics, "uniform", str(tmp_path / "h.sol")]]
    assert names == [name(metric) for metric in [*metrics, "uniform", str(tmp_path / "h.sol")]]
    (tmp_path / "h.sol").write_text("2")
    names += [name(str(tmp_path / "h.sol")), name("uniform", effort="fast")]
    assert len(set(names)) == len(names)


def test_what_fails_in_a_part_is_an_error():
    with pytest.raises(voronaut.Error, match=r"parts \d+, from \(.*are estimated to need"):
        voronaut.distributed.mesh(**{**PLACE, "n": 400_000}, memory_limit=0.1)
    with pytest.raises(voronaut.Error, match="distances to the surface of a mesh in parts"):
        voronaut.distributed.mesh("sphere:1", "uniform", 4000, parts=2, hausd=0.1)


def test_a_surface_comes_in_parts(tmp_path):
    def steep(p):
        assert p.shape[1] == 3
        return 1 + p[:, 2] ** 2

    mesh = voronaut.distributed.mesh("sphere:1", steep, 3000, parts=2, effort="fast", parts_dir=tmp_path)
    assert mesh.report["valid"] and mesh.report["euler"] == 2 and len(mesh.points) == 3000
    again = voronaut.distributed.mesh("sphere:1", steep, 3000, parts=2, effort="fast", parts_dir=tmp_path)
    assert (again.points == mesh.points).all() and (again.triangles == mesh.triangles).all()
