"""The axis of a beam as a distributed dolfinx mesh, with its two ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mpi4py import MPI

from dolfinx import fem, mesh

from .. import dolfinx_api as api

Array = NDArray[np.float64]

#: Order of the ends everywhere: the right end is the one whose reaction is reported.
ENDS = ("left", "right")


@dataclass(frozen=True)
class Axis:
    """The reference configuration.

    Attributes
    ----------
    mesh
        Distributed mesh of intervals.
    tags
        The two end points, numbered as in :data:`ENDS`.
    length
        m.
    """

    mesh: mesh.Mesh
    tags: mesh.MeshTags
    length: float


def nodes(length: float, size: float, breaks: Sequence[float] = ()) -> Array:
    """Abscissae of the ends of elements no longer than `size`, with a node at every break.

    Elements between two breaks are equal.
    """
    marks = np.unique([0.0, *breaks, length])
    marks = marks[(marks >= 0.0) & (marks <= length)]
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / size - 1e-9))) + 1)[:-1]
        for a, b in pairwise(marks)
    ]
    return np.concatenate([*parts, [length]])


def distribute(comm: MPI.Comm, S: Array) -> Axis:
    """Make the mesh on all processes from the nodes' abscissae; a collective call."""
    numbers = np.arange(len(S), dtype=np.int64)
    domain = api.create_simplex_mesh(
        comm, 1, S[:, None], np.column_stack([numbers[:-1], numbers[1:]])
    )
    ends = numbers[[0, -1]][:, None]
    tags = api.tagged_facets(domain, ends, np.arange(len(ENDS), dtype=np.int32))
    return Axis(domain, tags, float(S[-1]))


def piecewise(axis: Axis, pieces: Sequence[tuple[float, float]]) -> fem.Function:
    """A function that is constant on pieces (end abscissa, value) from left to right."""
    space = api.functionspace(axis.mesh, api.piecewise_constant(axis.mesh))
    function = fem.Function(space)
    middles = space.tabulate_dof_coordinates()[:, 0]
    ends, values = np.array(pieces, dtype=float).T
    function.x.array[:] = values[np.minimum(np.searchsorted(ends, middles), len(ends) - 1)]
    return function
