"""How much of the body each unknown of the displacement stands for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dolfinx import mesh

from .. import dolfinx_api as api
from ..schemes import Discretisation


def displacement_weights(discretisation: Discretisation, domain: mesh.Mesh) -> NDArray[np.float64]:
    """Share of the body that goes with each owned unknown of the state; a collective call.

    Each node of an element has the same share of the element's size. So means over the
    displacement do not depend on where the mesh is fine. Those of each component of the
    displacement sum to one; other fields have none.
    """
    field = discretisation.field("displacement")
    assert field is not None  # every scheme has one
    cells = api.cell_dofs(field.space)[: _owned(domain)]
    sums = api.create_vector(field.space)
    sums.array[:] = 0.0
    sizes = cell_sizes(domain)
    sizes /= domain.comm.allreduce(float(sizes.sum()))
    shares = np.repeat(sizes / cells.shape[1], cells.shape[1])
    by_node = sums.array.reshape(field.dofs.shape)
    np.add.at(by_node, cells.ravel(), shares[:, None])
    api.scatter_reverse_add(sums)
    weights = np.zeros(api.local_size(discretisation.state.function_space))
    weights[field.dofs.ravel()] = sums.array
    return weights[: api.owned_size(discretisation.state.function_space)]


def cell_sizes(domain: mesh.Mesh) -> NDArray[np.float64]:
    """Length of each owned interval, m, or area of each owned triangle, m²."""
    cells = api.cell_vertices(domain)[: _owned(domain)]
    x = domain.geometry.x[cells][:, :, : domain.topology.dim]
    sides = x[:, 1:] - x[:, :1]
    return np.abs(np.linalg.det(sides)) / domain.topology.dim


def _owned(domain: mesh.Mesh) -> int:
    return int(domain.topology.index_map(domain.topology.dim).size_local)
