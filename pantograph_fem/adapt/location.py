"""Values of a function of one mesh at points of another, on any number of processes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from dolfinx import fem, mesh

from .. import dolfinx_api as api

Array = NDArray[np.float64]

#: Cells near a point that may contain it: first those with the nearest centres, then more.
_CANDIDATES = (8, 64)
#: Barycentric coordinate, below zero, of a point that is still inside.
_INSIDE = -1e-9


class Locator:
    """The owned cells of a mesh, by place."""

    def __init__(self, domain: mesh.Mesh) -> None:
        self._comm = domain.comm
        owned = domain.topology.index_map(2).size_local
        corners = domain.geometry.x[api.cell_vertices(domain)[:owned]][:, :, :2]
        self._tree = cKDTree(corners.mean(axis=1))
        self._origin = corners[:, 0]
        self._inverse = np.linalg.inv((corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1))

    def values(self, function: fem.Function, points: Array) -> Array:
        """Values of a function at the points (n, 2) of this process, shape (n, components).

        A point that is outside by round-off has the values of the nearest cell. A collective call.
        """
        start = sum(self._comm.allgather(len(points))[: self._comm.rank])
        everywhere = np.concatenate(self._comm.allgather(points))
        cells, depths = self._nearest(everywhere)
        owner = np.argmax(self._comm.allgather(depths), axis=0)
        mine = np.flatnonzero(owner == self._comm.rank)
        padded = np.zeros((len(mine), 3))
        padded[:, :2] = everywhere[mine]
        values = np.empty((len(everywhere), function.function_space.dofmap.index_map_bs))
        own = np.empty((0, values.shape[1]))
        if len(mine):
            own = function.eval(padded, cells[mine]).reshape(len(mine), -1)
        for places, part in self._comm.allgather((mine, own)):
            values[places] = part
        return values[start : start + len(points)]

    def _nearest(self, points: Array) -> tuple[NDArray[np.int32], Array]:
        """The cell that holds each point, and how deep it lies: its least barycentric coordinate.

        Below zero, the point is in none of the cells looked at, and nearest to this one.
        """
        cells = np.zeros(len(points), dtype=np.int32)
        depths = np.full(len(points), -np.inf)
        for number in _CANDIDATES if self._tree.n else ():
            open_ = np.flatnonzero(depths < _INSIDE)
            if not len(open_):
                break
            near = self._tree.query(points[open_], min(number, self._tree.n))[1]
            near = near.reshape(len(open_), -1)
            arms = points[open_, None] - self._origin[near]
            two = np.einsum("pcij,pcj->pci", self._inverse[near], arms)
            least = np.minimum(two.min(axis=2), 1.0 - two.sum(axis=2))
            best = least.argmax(axis=1)
            row = np.arange(len(open_))
            cells[open_], depths[open_] = near[row, best], least[row, best]
        return cells, depths
