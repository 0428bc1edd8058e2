"""A mesh in parts by the ranks that this runs on, and what it is, into the folder that is named."""

import sys
from pathlib import Path

import numpy as np
from mpi4py import MPI

import voronaut

comm, folder = MPI.COMM_WORLD, Path(sys.argv[1])
options = {"n": 4000, "parts": 3, "effort": "fast", "comm": comm}
whole = voronaut.distributed.mesh("rect:-1,-1,1,1", "shock:phi=1,lambda=0.6", **options)
assert (whole is None) == (comm.Get_rank() > 0)
if whole is not None:
    whole.save(folder / "whole.meshb")

share = voronaut.distributed.mesh("rect:-1,-1,1,1", "shock:phi=1,lambda=0.6", gather=False, **options)
assert share.vertex_count == 4000 and (np.diff(share.vertices) > 0).all() and share.triangles.shape[1] == 3
assert np.isin(share.triangles, share.vertices).all() and len(share.triangle_labels) == len(share.triangles)
assert np.isin(share.edges, share.triangles[: share.owned_triangles]).all() and share.report["valid"]
counts = comm.allreduce(np.array([share.owned_triangles, (share.owner == comm.Get_rank()).sum()]))
assert counts.tolist() == [share.report["triangles"], 4000]
share.save(folder / "whole.pvtu", comm)

# What fails on one rank is an error on all of them.
try:
    voronaut.distributed.mesh("rect:-1,-1,1,1", lambda p: np.where(p[:, 0] > 0.9, np.nan, 1.0), **options)
except (voronaut.Error, ValueError) as error:
    assert "(0.9" in str(error), error
else:
    raise AssertionError("a metric that is none was taken")
