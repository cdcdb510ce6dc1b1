"""Fields of a state on the nodes of a fine output grid, gathered on rank 0."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import ufl
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from dolfinx import mesh

from .. import dolfinx_api as api
from ..physics.kinematics import Expr
from ..schemes import Discretisation

Array = NDArray[np.float64]

#: Nodes along a side of a cell, less one, for displacements of low degree. From 4 on, where cells
#: are few and large, as many as the degree.
_FEWEST = 2
#: Area, over that of the largest, below which a triangle is round-off between nodes of a side.
_FLAT = 1e-6


class FieldSampler:
    """Evaluates a discretisation's displacement and observables.

    The output grid has more nodes than the mesh, joined by straight cells of half the size or
    less, so that curved fields look curved. Fields with jumps between elements are averaged at the
    nodes, each element weighing as its size.
    """

    def __init__(
        self,
        discretisation: Discretisation,
        domain: mesh.Mesh,
        observables: Mapping[str, Expr],
    ) -> None:
        self._domain = domain
        self._comm = domain.comm
        self._names = tuple(observables)
        self._dimension = domain.topology.dim
        values = [discretisation.displacement[0], discretisation.displacement[1]]
        values += observables.values()
        order = _FEWEST if discretisation.degree < 4 else discretisation.degree
        self._nodes = api.functionspace(domain, api.lagrange(order, (len(values),), domain))
        nodes = api.interpolation_points(self._nodes)
        self._straight = _straight_cells(nodes)
        self._expression = api.expression(ufl.as_vector(values), nodes)
        owned = domain.topology.index_map(self._dimension).size_local
        self._cells = np.arange(owned, dtype=np.int32)
        self._dofs = api.cell_dofs(self._nodes)[self._cells]
        self._sizes = self._cell_sizes()
        self._sum = api.create_vector(self._nodes)
        self._weights = self._accumulate(np.ones((*self._dofs.shape, len(values))))

    def grid(self) -> tuple[Array, NDArray[np.int64]] | None:
        """Points (n, 2) and cells (m, 2 or 3) on rank 0, None elsewhere; a collective call."""
        index_map = self._nodes.dofmap.index_map
        numbers = index_map.local_to_global(self._dofs.ravel().astype(np.int32))
        cells = np.asarray(numbers).reshape(self._dofs.shape)
        straight = cells[:, self._straight].reshape(-1, self._dimension + 1)
        gathered = self._comm.gather(straight, root=0)
        owned = self._nodes.dofmap.index_map.size_local
        points = self._gather(self._nodes.tabulate_dof_coordinates()[:owned, :2])
        if gathered is None or points is None:
            return None
        merged = np.concatenate(gathered)
        return points, merged if self._dimension == 1 else _anticlockwise(points, merged)

    def sample(self) -> dict[str, Array] | None:
        """Fields of the discretisation's present state on rank 0, None elsewhere; collective."""
        raw = api.evaluate(self._expression, self._domain, self._cells)
        values = raw.reshape(*self._dofs.shape, 2 + len(self._names))
        gathered = self._gather(self._accumulate(values) / self._weights)
        if gathered is None:
            return None
        fields = {"displacement": gathered[:, :2]}
        fields.update({name: gathered[:, 2 + i] for i, name in enumerate(self._names)})
        return fields

    def _accumulate(self, values: Array) -> Array:
        """Sums at the owned nodes of values (cells, nodes, components), weighted by size."""
        components = values.shape[2]
        sums = self._sum.array.reshape(-1, components)
        sums[:] = 0.0
        np.add.at(sums, self._dofs, values * self._sizes[:, None, None])
        api.scatter_reverse_add(self._sum)
        return sums[: self._nodes.dofmap.index_map.size_local].copy()

    def _gather(self, owned: Array) -> Array | None:
        """Rows of the owned nodes of every process, in global order, on rank 0."""
        parts = self._comm.gather(owned, root=0)
        return None if parts is None else np.concatenate(parts)

    def _cell_sizes(self) -> Array:
        vertices = api.cell_vertices(self._domain)[self._cells]
        x = self._domain.geometry.x[vertices][:, :, :2]
        sides = x[:, 1:] - x[:, :1]
        if self._dimension == 1:
            return np.abs(sides[:, 0, 0])
        return 0.5 * np.abs(np.linalg.det(sides))


def _straight_cells(nodes: Array) -> NDArray[np.int64]:
    """Straight cells between the nodes (n, d) of the reference interval or triangle."""
    if nodes.shape[1] == 1:
        along = np.argsort(nodes[:, 0])
        return np.column_stack([along[:-1], along[1:]])
    # On the equilateral triangle, where the lattice of nodes has one triangulation.
    equilateral = np.array([[1.0, 0.0], [0.5, np.sqrt(0.75)]])
    triangles = Delaunay(nodes @ equilateral).simplices
    corners = nodes[triangles]
    area = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    return triangles[area > _FLAT * area.max()].astype(np.int64)


def _anticlockwise(points: Array, triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles[area < 0] = triangles[area < 0][:, ::-1]
    return triangles
