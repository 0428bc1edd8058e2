"""What goes in and what comes out."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import voronaut
from voronaut import Metric

ROOT = Path(__file__).resolve().parents[2]
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
SIDES = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])
SPOT = str(ROOT / "data/spot.obj")


def is_whole(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    return ((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > 0).all()


@pytest.mark.parametrize(
    "domain",
    [
        "rect:0,0,1,1",
        (SQUARE, SIDES),
        (SQUARE.astype(np.float32), SIDES.astype(np.uint8), [1, 2, 3, 4]),
        (SQUARE.tolist(), np.array([[0, 1, 2], [0, 2, 3]])),
        {"type": "Polygon", "coordinates": [[*SQUARE.tolist(), [0, 0]]]},
        voronaut.Mesh(np.asfortranarray(SQUARE), [[0, 1, 2], [0, 2, 3]]),
    ],
    ids=["shape", "segments", "labels", "triangles", "geo", "mesh"],
)
def test_a_square_however_it_is_given(domain):
    mesh = voronaut.mesh(domain, "uniform", n=200)
    assert mesh.points.shape == (200, 2) and mesh.triangles.dtype == np.int32
    assert is_whole(mesh) and mesh.report["valid"] and mesh.is_planar
    assert mesh.report["metric_edge_length"]["unit_fraction"] == 1.0
    assert mesh.quality.shape == (len(mesh.triangles),) and mesh.quality.min() > 0.5


def test_labels_come_along():
    mesh = voronaut.mesh((SQUARE, SIDES, [1, 2, 3, 4]), "uniform", n=100)
    assert set(mesh.edge_labels.tolist()) == {1, 2, 3, 4}
    bottom = mesh.points[mesh.edges[mesh.edge_labels == 1]]
    assert (bottom[..., 1] == 0).all()


def test_periodic_sides(tmp_path):
    mesh = voronaut.mesh((SQUARE, SIDES, [1, 2, 3, 4]), lambda p: 0.02 + 0.2 * p[:, 0], n=300, periodic=[(4, 2), (1, 3)])
    (labels, turn, by, off, vertices), _ = mesh.periodic
    assert (labels, turn, by, off) == ((4, 2), (1, 0), (1, 0), 0) and mesh.report["periodic"][0]["vertices"] == len(vertices)
    left, right = mesh.points[vertices[:, 0]], mesh.points[vertices[:, 1]]
    assert (left[:, 1] == right[:, 1]).all() and (left[:, 0] == 0).all() and (right[:, 0] == 1).all()
    mesh.save(tmp_path / "a.msh")
    assert "$Periodic\n2\n" in (tmp_path / "a.msh").read_text()
    assert voronaut.mesh((SQUARE, SIDES, [1, 2, 3, 4]), 0.2, n=60, periodic="4,2").periodic[0][0] == (4, 2)


def test_geo_interface_of_an_object():
    class Land:
        __geo_interface__ = {"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]]]}

    assert voronaut.mesh(Land(), "uniform", n=50).points[:, 0].max() == 2.0


def test_options_are_the_program_s_and_reported():
    mesh = voronaut.mesh("rect:0,0,1,1", "uniform", complexity=100.0, lloyd=3, h_min=1e-3, nr=False)
    options = mesh.report["options"]
    assert (options["complexity"], options["lloyd"], options["h_min"]) == (100.0, 3, 1e-3)


def test_the_same_bytes_for_any_number_of_threads():
    one, two = (voronaut.mesh("disk:0,0,1", "swirl", n=400, threads=threads) for threads in (1, 2))
    assert one.points.tobytes() == two.points.tobytes() and one.triangles.tobytes() == two.triangles.tobytes()


def test_surfaces():
    mesh = voronaut.mesh(SPOT, "curvature", n=600)
    assert mesh.points.shape == (600, 3) and not mesh.is_planar and mesh.report["euler"] == 2
    again = voronaut.mesh(mesh, Metric.from_callable(lambda points: 0.2 + 0.1 * points[:, 0] ** 2), n=400)
    assert again.points.shape == (400, 3)
    by_size, by_values = voronaut.mesh(mesh, 0.1), voronaut.mesh(mesh, np.full(600, 0.1))
    assert abs(len(by_size.points) / len(by_values.points) - 1) < 0.02
    by_values = voronaut.mesh(mesh, np.full(600, 0.1), n=400)
    assert by_values.report["valid"]


def test_duals_and_distances():
    seeds = np.random.default_rng(1).uniform(-1, 1, (60, 2))
    dual = voronaut.dual("rect:-1,-1,1,1", "swirl", seeds)
    assert (dual.points == seeds).all()
    assert set(np.unique(dual.diagram.fields["colour"])) <= set(range(60))
    found = voronaut.distance("rect:-1,-1,1,1", "uniform", (0, 0), to=(0.6, 0.8))
    assert abs(found.report["distance"] - 1) < 0.01
    d = found.fields["distance"]
    assert np.abs(d - np.linalg.norm(found.points, axis=1)).max() < 0.02
    sphere = voronaut.distance("sphere:1", "uniform", [(0, 0, 1)], (0, 0, -1), canvas_size=20000)
    assert abs(sphere.report["distance"] - np.pi) < 0.02


def test_transfer_keeps_linear_fields_and_masses():
    old, new = (voronaut.mesh("rect:0,0,1,1", "uniform", n=n) for n in (300, 200))
    fields = {"u": old.points @ [2.0, 1.0], "v": old.points.copy(), "cells": np.ones(len(old.triangles))}
    carried = voronaut.transfer(old, new, fields, conservative=True)
    assert np.allclose(carried["u"], new.points @ [2.0, 1.0]) and np.allclose(carried["v"], new.points)
    assert np.allclose(carried["cells"], 1.0)
    assert np.allclose(voronaut.transfer(old, new, fields["u"]), carried["u"])


def test_adapt_carries_fields():
    mesh = voronaut.mesh("rect:0,0,1,1", "uniform", n=2000)
    mesh.fields["u"] = np.tanh(20 * (mesh.points[:, 0] - 0.3))
    adapted = voronaut.adapt(mesh, Metric.from_hessian(mesh.fields["u"], mesh), np.full(2000, 0.2), n=600)
    assert len(adapted.points) == 600 and adapted.fields["u"].shape == (600,)
    assert (np.abs(adapted.points[:, 0] - 0.3) < 0.1).mean() > 0.4


def test_remesh_and_check(tmp_path):
    mesh = voronaut.mesh("rect:0,0,1,1", "uniform", n=100)
    fine = voronaut.remesh(mesh, hsiz=0.05)
    assert len(fine.points) > 300 and fine.fields["metric"].shape == (len(fine.points), 2, 2) or fine.fields["metric"].ndim == 1
    sized = voronaut.remesh(mesh, np.full(100, 0.05), hgrad=-1)
    assert abs(len(sized.points) / len(fine.points) - 1) < 0.2
    found = voronaut.check(fine, lambda points: np.full(len(points), 0.05), "rect:0,0,1,1")
    assert found["valid"] and found["metric_edge_length"]["unit_fraction"] > 0.95
    folded = voronaut.Mesh(SQUARE, [[0, 1, 2], [0, 3, 2]])
    assert voronaut.check(folded)["valid"] is False


def test_files_and_other_programs_arrays(tmp_path):
    mesh = voronaut.mesh("rect:0,0,1,1", "uniform", n=80)
    mesh.fields["u"] = mesh.points[:, 0].copy()
    mesh.fields["m"] = np.tile(np.eye(2), (80, 1, 1))
    for ending in ("mesh", "meshb", "msh", "vtu"):
        path = tmp_path / f"a.{ending}"
        mesh.save(path)
        back = voronaut.Mesh.read(path)
        assert (back.points == mesh.points).all() and (back.triangles == mesh.triangles).all()
        if ending in ("msh", "vtu"):
            assert np.array_equal(back.fields["u"], mesh.fields["u"]) and back.fields["m"].shape == (80, 2, 2)
    mesh.save(tmp_path / "a.sol")
    values = voronaut.read_solution(tmp_path / "a.sol")["vertices"]
    assert np.array_equal(values[0], mesh.fields["u"]) and values[1].shape == (80, 2, 2)
    assert voronaut.convert(tmp_path / "a.msh", tmp_path / "b.ply").triangles.shape == mesh.triangles.shape
    meshio = pytest.importorskip("meshio")
    assert np.array_equal(meshio.read(tmp_path / "a.vtu").points[:, :2], mesh.points)
    assert voronaut.check(mesh.to_meshio())["valid"]
    labelled = voronaut.mesh((SQUARE, SIDES, [1, 2, 3, 4]), "uniform", n=60).to_meshio()
    assert set(voronaut.mesh(labelled, "uniform", n=60).edge_labels.tolist()) == {1, 2, 3, 4}
    by_file = voronaut.mesh(tmp_path / "a.mesh", "uniform", n=50)
    assert len(by_file.points) == 50


def test_scikit_fem_reads_labels():
    pytest.importorskip("skfem")
    mesh = voronaut.mesh((SQUARE, SIDES, [1, 1, 2, 2]), "uniform", n=60).to_skfem()
    assert mesh.nvertices == 60 and set(mesh.boundaries) == {"1", "2"}


def curved_disk(order):
    form = "2-4.1" if order == 2 else "3-2.2"
    return voronaut.Mesh.read(ROOT / f"crates/voronaut-io/tests/data/gmsh/order-{form}.msh")


@pytest.mark.parametrize("order", [2, 3])
def test_curved_triangles_are_arrays(tmp_path, order):
    disk = curved_disk(order)
    assert disk.order == order and disk.points.shape == (8, 2) and f"of order {order}" in repr(disk)
    assert disk.curved_triangles.shape == (7, 3 if order == 2 else 7) and disk.nodes.shape == (14 if order == 2 else 35, 2)
    assert np.isclose(np.linalg.norm(disk.nodes, axis=1), 1).sum() == 7 * (order - 1)
    made = voronaut.Mesh(
        disk.points, disk.triangles, edges=disk.edges, nodes=disk.nodes, curved_triangles=disk.curved_triangles.astype(np.int64)
    )
    for ending in ("mesh", "meshb", "msh", "vtu"):
        made.save(tmp_path / f"a.{ending}")
        back = voronaut.Mesh.read(tmp_path / f"a.{ending}")
        assert (back.nodes == disk.nodes).all() and (back.curved_triangles == disk.curved_triangles).all()
        assert (back.points == disk.points).all() and back.order == order
    for refused in (lambda: made.save(tmp_path / "a.obj"), lambda: voronaut.mesh(made, 0.3)):
        with pytest.raises(voronaut.UnsupportedError, match=f"triangles of order {order}"):
            refused()
    assert not (tmp_path / "a.obj").exists()
    for wrong in ({"nodes": disk.nodes}, {"nodes": disk.nodes[1:], "curved_triangles": disk.curved_triangles}):
        with pytest.raises(ValueError, match="curved_triangles"):
            voronaut.Mesh(disk.points, disk.triangles, **wrong)
    with pytest.raises(ValueError, match="save it as .vtu"):
        disk.to_pyvista()


def test_meshio_takes_curved_triangles():
    pytest.importorskip("meshio")
    triangles, edges = curved_disk(3).to_meshio().cells
    assert (triangles.type, triangles.data.shape, edges.type, edges.data.shape) == ("triangle10", (7, 10), "line4", (7, 4))
    quadratic = curved_disk(2).to_meshio()
    with pytest.raises(ValueError, match="curved cells .line3"):
        voronaut.check(quadratic)
    ends, middles = quadratic.points[quadratic.cells[1].data[:, :2]], quadratic.points[quadratic.cells[1].data[:, 2]]
    assert np.allclose(np.linalg.norm(middles, axis=1), 1) and np.allclose(np.linalg.norm(ends, axis=2), 1)


def test_scikit_fem_integrates_over_a_curved_disk():
    skfem = pytest.importorskip("skfem")
    mesh = curved_disk(2).to_skfem()
    basis = skfem.Basis(mesh, skfem.ElementTriP2())
    area = skfem.Functional(lambda w: 1 + 0 * w.x[0]).assemble(basis)
    # The polygon of its seven corners has 2.74.
    assert abs(area - np.pi) < 5e-3 and set(mesh.boundaries) == {"5"}
    assert len(mesh.boundaries["5"]) == 7
    with pytest.raises(ValueError, match="of order 3"):
        curved_disk(3).to_skfem()


def test_a_quadratic_solution_on_a_curved_disk_converges_at_its_order():
    """-div grad u = f with u = (1 - r^2)(2 + x) and 0 on the circle."""
    skfem = pytest.importorskip("skfem")
    from skfem.helpers import dot, grad

    def error(n):
        basis = skfem.Basis(voronaut.mesh("disk:0,0,1", "uniform", n=n, order=2).to_skfem(), skfem.ElementTriP2(), intorder=6)
        stiffness = skfem.BilinearForm(lambda u, v, w: dot(grad(u), grad(v))).assemble(basis)
        load = skfem.LinearForm(lambda v, w: 8 * (1 + w.x[0]) * v).assemble(basis)
        u = skfem.solve(*skfem.condense(stiffness, load, D=basis.get_dofs()))
        exact = lambda x: (1 - x[0] ** 2 - x[1] ** 2) * (2 + x[0])
        return skfem.Functional(lambda w: (w["u"] - exact(w.x)) ** 2).assemble(basis, u=basis.interpolate(u)) ** 0.5

    coarse, fine = error(100), error(400)
    assert np.log2(coarse / fine) > 2.7, (coarse, fine)


def test_pictures_and_notebooks():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    mesh = voronaut.mesh("disk:0,0,1", "uniform", n=60)
    mesh.fields["u"] = mesh.points[:, 0].copy()
    assert mesh.plot("u") is not None and "60" in repr(mesh)
    assert len(mesh.plot(ellipses="uniform").lines) == 60 + 2
    assert "data:image/png" in mesh._repr_html_() and "unit edges" in mesh._repr_html_()
    sphere = voronaut.mesh("sphere:1", "uniform", n=100)
    assert np.array_equal(sphere.plot(sphere.quality).collections[0].get_array(), sphere.quality)
    (curves,) = curved_disk(3).plot().lines
    assert np.nanmax(np.hypot(*curves.get_data())) == pytest.approx(1, abs=2e-3)
    with pytest.raises(ValueError, match="planar meshes only"):
        sphere.plot(ellipses="curvature")
    with pytest.raises(KeyError, match="there are"):
        mesh.plot("v")


def test_pages(tmp_path):
    swirl = voronaut.mesh("disk:0,0,1", "swirl", n=200)
    page = swirl.view("swirl", cells=True, title="A swirl")
    assert page.html.startswith("<!doctype html>") and "<title>A swirl</title>" in page.html
    assert page._repr_html_().startswith("<iframe srcdoc=") and "<script" not in page._repr_html_()
    page.save(tmp_path / "swirl.html")
    assert (tmp_path / "swirl.html").read_text() == page.html
    plain = voronaut.view([swirl, voronaut.mesh("disk:0,0,1", "uniform", n=100)])
    assert '"name":"mesh 2"' in plain.html
    with pytest.raises(ValueError, match="there is none"):
        voronaut.view([])


def test_pyvista_chains_and_carries():
    pyvista = pytest.importorskip("pyvista")
    sphere = pyvista.Sphere(theta_resolution=24, phi_resolution=24)
    sphere.point_data["height"] = sphere.points[:, 2]
    made = sphere.voronaut.remesh(n=300, metric="curvature")
    assert made.n_points == 300 and np.abs(made.point_data["height"] - made.points[:, 2]).max() < 0.1
    assert made.voronaut.check()["valid"]
    plane = pyvista.Plane(i_resolution=40, j_resolution=40).triangulate()
    plane.point_data["u"] = np.tanh(20 * plane.points[:, 0])
    adapted = plane.voronaut.adapt("u", n=500)
    assert adapted.n_points == 500 and "u" in adapted.point_data


def test_pyvista_reads_what_it_lacks(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = voronaut.mesh("rect:0,0,1,1", "uniform", n=80)
    mesh.fields["u"] = mesh.points[:, 0].copy()
    for name in ("a.meshb", "a.solb", "a.sol"):
        mesh.save(tmp_path / name)
    assert pyvista.read(tmp_path / "a.meshb").n_cells == len(mesh.triangles)
    for name in ("a.solb", "a.sol"):
        assert np.array_equal(pyvista.read(tmp_path / name).point_data["solution 0"], mesh.fields["u"])
    voronaut.mesh("rect:0,0,1,1", "uniform", n=50).save(tmp_path / "a.meshb")
    with pytest.raises(ValueError, match="80 values, and 50 vertices"):
        pyvista.read(tmp_path / "a.solb")


def test_the_program_is_the_program(tmp_path):
    words = [sys.executable, "-m", "voronaut"]
    done = subprocess.run([*words, "mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "50", "-o", "a.mesh", "-q"], cwd=tmp_path)
    assert done.returncode == 0 and len(voronaut.Mesh.read(tmp_path / "a.mesh").points) == 50
    refused = subprocess.run([*words, "remesh", "none.mesh"], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 2 and "none.mesh" in refused.stderr


def test_functions_are_those_declared():
    done = subprocess.run([sys.executable, ROOT / "scripts/declare.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_types(tmp_path):
    pytest.importorskip("mypy")
    for words in (["mypy"], ["mypy.stubtest", "voronaut._voronaut"]):
        env = {**os.environ, "MYPY_CACHE_DIR": str(tmp_path)}
        done = subprocess.run([sys.executable, "-m", *words], cwd=ROOT, capture_output=True, text=True, env=env)
        assert done.returncode == 0, done.stdout + done.stderr
