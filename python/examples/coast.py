"""The Aegean with sizes from an array: fine in straits, coarse in the open sea.

    python python/examples/coast.py OUT.png
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voronaut

COAST = Path(__file__).resolve().parents[2] / "data/aegean.geojson"


def main(out: str) -> None:
    land = json.loads(COAST.read_text())
    coarse = voronaut.mesh(land, "boundary:h0=3,growth=1.3", n=8000)
    # The distance to the coast, as a solver would have it: a field at vertices.
    shore = np.unique(coarse.edges)
    squares = ((coarse.points[:, None, :] - coarse.points[None, shore, :]) ** 2).sum(axis=2)
    size = np.clip(0.4 * np.sqrt(squares.min(axis=1)), 1.0, 20.0)
    mesh = voronaut.mesh(coarse, size, n=12000, gradation=1.2)
    lengths = mesh.report["interior_edge_length"]
    print(f"{len(mesh.points):,} vertices, {100 * lengths['unit_fraction']:.1f} % of the edges off the coast of unit length")
    figure, ax = plt.subplots(figsize=(8, 8))
    mesh.plot(ax=ax, linewidth=0.2)
    ax.set(aspect="equal", title=f"{len(mesh.points):,} vertices")
    figure.savefig(out, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "coast.png")
