"""Geodesic distances and Voronoi cells in a metric of one's own.

    python python/examples/cells.py OUT.png
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import voronaut


def river(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Across a winding river a step counts eight times."""
    x, y = points.T
    slope = 0.6 * np.cos(2 * x)
    across = np.stack([-slope, np.ones_like(x)], axis=1) / np.sqrt(1 + slope**2)[:, None]
    weight = 63 * np.exp(-(((y - 0.3 * np.sin(2 * x)) / 0.15) ** 2))
    tensors: NDArray[np.float64] = np.eye(2) + weight[:, None, None] * across[:, :, None] * across[:, None, :]
    return tensors


def main(out: str) -> None:
    domain, town = "rect:-2,-1,2,1", (-1.4, -0.6)
    distance = voronaut.distance(domain, river, town, to=(1.2, 0.7))
    seeds = np.random.default_rng(3).uniform((-1.9, -0.9), (1.9, 0.9), (40, 2))
    cells = voronaut.dual(domain, river, seeds).diagram
    assert cells is not None
    print(f"from {town} to (1.2, 0.7): {distance.report['distance']:.3f} in the metric")
    figure, (left, right) = plt.subplots(2, 1, figsize=(8, 9))
    left.tricontourf(*distance.points.T, distance.triangles, distance.fields["distance"], levels=25)
    path = distance.points[distance.edges]
    left.plot(path[..., 0].T, path[..., 1].T, color="white", linewidth=2)
    right.tripcolor(*cells.points.T, cells.triangles, cells.fields["colour"], shading="gouraud", cmap="tab20")
    right.plot(*seeds.T, "k.")
    for ax, title in ((left, "distance from a town, and the way to another"), (right, "cells of 40 towns")):
        ax.set(aspect="equal", title=title)
    figure.savefig(out, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "cells.png")
