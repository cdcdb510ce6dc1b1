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
    facets
        Local edge numbers of each grip.
    ends
        Leftmost and rightmost reference point of each grip, shape (2, 2), m; the centre of the
        grip is midway.
    extent
        Diagonal of the bounding box, m.
    """

    mesh: mesh.Mesh
    facets: dict[str, NDArray[np.int32]]
    ends: dict[str, NDArray[np.float64]]
    extent: float


def distribute(comm: MPI.Comm, triangulation: Triangulation | None) -> Domain:
    """Make the mesh on all processes from rank 0's triangulation; a collective call."""
    if triangulation is not None:
        points = triangulation.points
        edges = [triangulation.edges[name] for name in GRIPS]
        held = [points[np.unique(pairs)] for pairs in edges]
        ends = {
            # Sorted by x, then y: "left" and "right" are meant of an edge that runs along x.
            name: np.array([min(map(tuple, p)), max(map(tuple, p))])
            for name, p in zip(GRIPS, held, strict=True)
        }
        extent = float(np.hypot(*np.ptp(points, axis=0)))
        tags = np.repeat(np.arange(len(GRIPS), dtype=np.int32), [len(pairs) for pairs in edges])
        data = (points, triangulation.triangles, np.concatenate(edges), tags)
        shared = (ends, extent)
    else:
        data = (np.empty((0, 2)), np.empty((0, 3)), np.empty((0, 2)), np.empty(0, np.int32))
        shared = None
    ends, extent = comm.bcast(shared, root=0)
    points, triangles, edges_of_all, tags = data
    domain = api.create_triangle_mesh(comm, points, triangles)
    facet_tags = api.tagged_facets(domain, edges_of_all, tags)
    facets = {name: facet_tags.find(tag) for tag, name in enumerate(GRIPS)}
    return Domain(domain, facets, ends, extent)
