"""What a two-level Schwarz preconditioner of a sheet's tangent needs beside PETSc's options."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from petsc4py import PETSc

from pantograph_fem import dolfinx_api as api
from pantograph_fem.continuum.equilibrium import ContinuumEquilibrium


def whole_matrix(upper: PETSc.Mat) -> PETSc.Mat:
    """Both halves of a symmetric matrix of which one is stored; one process."""
    upper.setOption(PETSc.Mat.Option.GETROW_UPPERTRIANGULAR, True)
    starts, columns, values = upper.getValuesCSR()
    stored = sp.triu(sp.csr_matrix((values, columns, starts), shape=upper.size))
    whole = _matrix(stored + sp.triu(stored, 1).T)
    whole.setBlockSize(2)
    whole.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    whole.setOption(PETSc.Mat.Option.SPD, True)
    return whole


def interpolation_of_linears(problem: ContinuumEquilibrium) -> PETSc.Mat:
    """Values at the nodes of the displacement of functions linear in each element.

    Columns are the two components at each vertex that is not held; rows of held dofs are empty.
    """
    (field,) = problem.discretisation.fields
    domain = field.space.mesh
    nodes = api.cell_dofs(field.space)
    corners = api.cell_vertices(domain)
    place = domain.geometry.x[:, :2]
    origin = place[corners[:, 0]]
    edges = np.stack([place[corners[:, i]] - origin for i in (1, 2)], axis=2)
    offsets = field.coordinates[nodes] - origin[:, None]
    local = np.linalg.solve(edges[:, None], offsets[..., None])[..., 0]
    weights = np.concatenate([1.0 - local.sum(axis=2, keepdims=True), local], axis=2)
    rows = np.repeat(nodes, 3, axis=1).ravel()
    columns = np.repeat(corners[:, None], nodes.shape[1], axis=1).ravel()
    # A node of two elements has the same weights in both: the first ones count.
    _, first = np.unique(np.stack([rows, columns]), axis=1, return_index=True)
    shape = len(field.coordinates), len(place)
    one = sp.csr_matrix((weights.ravel()[first], (rows[first], columns[first])), shape=shape)
    free = np.ones(2 * shape[0])
    free[problem.held_dofs] = 0.0
    both = (sp.diags(free) @ sp.kron(one, sp.eye(2))).tocsr()
    both.data[np.abs(both.data) < 1e-12] = 0.0
    both.eliminate_zeros()
    used = np.flatnonzero(both.getnnz(axis=0))
    return _matrix(both[:, used])


def _matrix(entries: sp.spmatrix) -> PETSc.Mat:
    entries = entries.tocsr()
    entries.sort_indices()
    indices = (entries.indptr.astype(np.int32), entries.indices.astype(np.int32), entries.data)
    return PETSc.Mat().createAIJ(entries.shape, csr=indices)
