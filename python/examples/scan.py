"""A surface in pyvista, remeshed to a distance that it may be off by.

    python python/examples/scan.py SURFACE OUT.png
"""

import sys

import matplotlib.pyplot as plt
import pyvista

import voronaut
from voronaut.pyvista import from_pyvista


def main(surface: str, out: str) -> None:
    scan = pyvista.read(surface)
    distance = 0.002 * scan.length
    coarse = scan.voronaut.remesh(metric="curvature", hausd=distance, fit=True)
    found = voronaut.check(coarse, domain=scan)["fidelity"]
    print(f"{scan.n_points:,} vertices became {coarse.n_points:,}; asked for {distance:.2e}, off by {found['hausdorff']:.2e}")
    figure, axes = plt.subplots(1, 2, figsize=(12, 6), subplot_kw={"projection": "3d", "aspect": "equal"})
    for ax, data in zip(axes, (scan, coarse)):
        mesh = from_pyvista(data)
        mesh.plot(ax=ax)
        ax.view_init(elev=15, azim=35, vertical_axis="y")
        ax.set_axis_off()
        ax.set_box_aspect(None, zoom=1.6)
        ax.set_title(f"{len(mesh.points):,} vertices")
    figure.savefig(out, dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    main(*sys.argv[1:3])
