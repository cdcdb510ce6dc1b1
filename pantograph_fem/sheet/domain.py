"""A triangulation as a distributed dolfinx mesh, with the edges that the grips hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI

from dolfinx import mesh

from .. import dolfinx_api as api
from ..mesh import Triangulation

#: Order of the grips everywhere: the top grip is the one whose reaction is reported.
GRIPS = ("bottom", "top")


@dataclass(frozen=True)
class Domain:
    """The reference configuration.

    Attributes
    ----------
    mesh
        Distributed mesh of straight triangles.
    tags
        The edges of the grips, numbered as in :data:`GRIPS`.
    ends
        Leftmost and rightmost reference point of each grip, shape (2, 2), m; the centre of the
        grip is midway.
    extent
        Diagonal of the bounding box, m.
    """

    mesh: mesh.Mesh
    tags: mesh.MeshTags
    ends: dict[str, NDArray[np.float64]]
    extent: float


def distribute(comm: MPI.Comm, triangulation: Triangulation | None) -> Domain:
    """Make the mesh on all processes from rank 0's triangulation; a collective call."""
    shared = None
    points: NDArray[np.float64] = np.empty((0, 2))
    triangles: NDArray[np.int64] = np.empty((0, 3), dtype=np.int64)
    edges: NDArray[np.int64] = np.empty((0, 2), dtype=np.int64)
    tags: NDArray[np.int32] = np.empty(0, dtype=np.int32)
    if triangulation is not None:
        points, triangles = triangulation.points, triangulation.triangles
        by_grip = [triangulation.edges[name] for name in GRIPS]
        edges = np.concatenate(by_grip)
        tags = np.repeat(np.arange(len(GRIPS), dtype=np.int32), [len(pairs) for pairs in by_grip])
        ends = {
            name: _ends(points[np.unique(pairs)])
            for name, pairs in zip(GRIPS, by_grip, strict=True)
        }
        shared = (ends, float(np.hypot(*np.ptp(points, axis=0))))
    ends, extent = comm.bcast(shared, root=0)
    domain = api.create_simplex_mesh(comm, 2, points, triangles)
    return Domain(domain, api.tagged_facets(domain, edges, tags), ends, extent)


def _ends(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Leftmost and rightmost of some points; the lower one first where a grip runs along y."""
    order = np.lexsort((points[:, 1], points[:, 0]))
    return points[order[[0, -1]]]
