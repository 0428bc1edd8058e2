"""A front that turns around the middle of a square, in scikit-fem, on meshes that follow it.

    python python/examples/moving_front.py OUT.png

u_t + b . grad u = eps lap u for a quarter of a turn. Between parts the mesh is adapted to where the front is and where it will be, and
the solution carried over with its mass. The L2 error is that against a uniform mesh of ten times the vertices.
"""

import sys
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import skfem
from skfem.helpers import dot, grad

import voronaut

EPS, STEPS, PARTS = 1e-3, 40, 8
HALF_STEP = 0.25 * np.pi / STEPS


def start(points: Any) -> Any:
    x, y = points.T
    return 0.5 - 0.5 * np.tanh(((x - 0.4) ** 2 + y**2 - 0.04) / 0.008)


def mass(u: Any, v: Any, _: Any) -> Any:
    return u * v


def transport(u: Any, v: Any, w: Any) -> Any:
    return EPS * dot(grad(u), grad(v)) + (-w.x[1] * grad(u)[0] + w.x[0] * grad(u)[1]) * v


def advanced(mesh: voronaut.Mesh, u: Any, steps: int) -> Any:
    """The solution after so many steps of Crank and Nicolson."""
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTriP1())
    weight, change = (skfem.BilinearForm(form).assemble(basis) for form in (mass, transport))
    for _ in range(steps):
        right = (weight - HALF_STEP * change) @ u
        u = skfem.solve(*skfem.condense(weight + HALF_STEP * change, right, D=basis.get_dofs()))
    return u


def adaptive(n: int) -> tuple[voronaut.Mesh, Any]:
    """Solves in parts: the mesh of each is fine where the front is at its beginning and at its end."""
    mesh = voronaut.mesh("rect:-1,-1,1,1", "uniform", n=2 * n)
    u = start(mesh.points)
    for part in range(PARTS):
        later = advanced(mesh, u, STEPS // PARTS)
        metrics = [voronaut.Metric.from_hessian(values, mesh) for values in (u, later)]
        new = voronaut.adapt(mesh, *metrics, n=n, gradation=1.5)
        u = start(new.points) if part == 0 else voronaut.transfer(mesh, new, u, conservative=True)
        mesh, u = new, advanced(new, u, STEPS // PARTS)
    return mesh, u


def uniform(n: int) -> tuple[voronaut.Mesh, Any]:
    mesh = voronaut.mesh("rect:-1,-1,1,1", "uniform", n=n)
    return mesh, advanced(mesh, start(mesh.points), STEPS)


def main(out: str) -> None:
    n = 2000
    reference, exact = uniform(10 * n)
    weight = skfem.BilinearForm(mass).assemble(skfem.Basis(reference.to_skfem(), skfem.ElementTriP1()))
    figure, axes = plt.subplots(1, 2, figsize=(11, 5))
    for ax, (name, (mesh, u)) in zip(axes, {"uniform": uniform(n), "adapted": adaptive(n)}.items()):
        away = voronaut.transfer(mesh, reference, u) - exact
        title = f"{name}, {len(mesh.points):,} vertices: L2 error {np.sqrt(away @ weight @ away):.1e}"
        print(title)
        mesh.plot(u, ax=ax, cmap="viridis")
        mesh.plot(ax=ax, linewidth=0.2, color="white")
        ax.set(aspect="equal", title=title)
    figure.savefig(out, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "moving_front.png")
