"""Advection and diffusion with two boundary layers, in scikit-fem, on meshes adapted to the solution and on uniform ones.

    python python/examples/boundary_layer.py OUT.png
-eps lap u + u_x + u_y = f with u = g(x) g(y), g(t) = t - (exp((t - 1)/eps) - exp(-1/eps)) / (1 - exp(-1/eps)), and streamline diffusion.
"""

import sys
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import skfem
from skfem.helpers import dot, grad

import voronaut

EPS = 0.01


def g(t: Any) -> Any:
    return t - (np.exp((t - 1) / EPS) - np.exp(-1 / EPS)) / (1 - np.exp(-1 / EPS))


def force(x: Any, y: Any) -> Any:
    layers = [np.exp((t - 1) / EPS) / EPS / (1 - np.exp(-1 / EPS)) for t in (x, y)]
    return layers[0] * g(y) + g(x) * layers[1] + (1 - layers[0]) * g(y) + g(x) * (1 - layers[1])


def transport(u: Any, v: Any, w: Any) -> Any:
    return EPS * dot(grad(u), grad(v)) + (grad(u)[0] + grad(u)[1]) * (v + w["tau"] * (grad(v)[0] + grad(v)[1]))


def load(v: Any, w: Any) -> Any:
    return force(*w.x) * (v + w["tau"] * (grad(v)[0] + grad(v)[1]))


def square_of_error(w: Any) -> Any:
    return (w["u"] - g(w.x[0]) * g(w.x[1])) ** 2


def upwind(mesh: voronaut.Mesh) -> Any:
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    widths = sum(np.abs((q - p) @ [-1, 1]) for p, q in ((b, c), (c, a), (a, b)))
    length = 2 * np.sqrt(2) * np.linalg.det(np.stack([b - a, c - a], axis=1)) / widths
    peclet = length * np.sqrt(2) / (2 * EPS)
    return length / (2 * np.sqrt(2)) * (1 / np.tanh(peclet) - 1 / peclet)


def solve(mesh: voronaut.Mesh) -> tuple[Any, float]:
    """The solution at the vertices, and its L2 error."""
    basis = skfem.Basis(mesh.to_skfem(), skfem.ElementTriP1(), intorder=8)
    tau = basis.with_element(skfem.ElementTriP0()).interpolate(upwind(mesh))
    forms = skfem.BilinearForm(transport).assemble(basis, tau=tau), skfem.LinearForm(load).assemble(basis, tau=tau)
    u = skfem.solve(*skfem.condense(*forms, D=basis.get_dofs()))
    return u, np.sqrt(skfem.Functional(square_of_error).assemble(basis, u=basis.interpolate(u)))


def main(out: str) -> tuple[list[float], list[float], float]:
    counts, errors, uniform = [500, 1000, 2000, 4000, 8000], [], []
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 5))
    for n in counts:
        mesh = voronaut.mesh("rect:0,0,1,1", "uniform", n=n)
        uniform.append(solve(mesh)[1])
        for _ in range(2):
            mesh = voronaut.adapt(mesh, voronaut.Metric.from_hessian(solve(mesh)[0], mesh), n=n)
        errors.append(solve(mesh)[1])
        print(f"{n:6} unknowns: L2 error {uniform[-1]:.3e} uniform, {errors[-1]:.3e} adapted")
    order = -2 * float(np.polyfit(np.log(counts), np.log(errors), 1)[0])
    mesh.plot(ax=left, linewidth=0.2)
    left.set(aspect="equal", title=f"{n:,} vertices")
    right.loglog(counts, uniform, "o-", label="uniform")
    right.loglog(counts, errors, "s-", label=f"adapted, order {order:.2f}")
    right.set(xlabel="unknowns", ylabel="L2 error", title="advection and diffusion, eps = 0.01")
    right.legend()
    figure.savefig(out, dpi=110, bbox_inches="tight")
    return uniform, errors, order


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "boundary_layer.png")
