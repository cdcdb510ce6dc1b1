"""The only module that knows which dolfinx is installed.

Everything else calls the functions here, which carry the names of newer releases. Written for
0.5 (Debian 12); what 0.9 (Debian 13) and later need differently is to be added here alone.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, TypeVar

import numpy as np
import ufl
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

import dolfinx
import dolfinx.fem.petsc
from dolfinx import fem, geometry, io, la, mesh

#: The kernels are long straight-line code: the compiler's vectoriser takes a third off their time.
#: No -ffast-math, which would hide a NaN from the line search.
_COMPILER_FLAGS = ["-O3", "-g0", "-march=native", "-fno-math-errno"]
#: Seconds that one process waits for another that compiles the same form.
_COMPILER_TIMEOUT = 600
_JIT = {"cffi_extra_compile_args": _COMPILER_FLAGS, "timeout": _COMPILER_TIMEOUT}

F = TypeVar("F", bound=Callable[..., Any])


def _compiles(function: F) -> F:
    """Keep the C compiler's command lines, logged by cffi at INFO, off the user's terminal."""

    @wraps(function)
    def quiet(*args: Any, **kwargs: Any) -> Any:
        root = logging.getLogger()
        disabled, level = root.manager.disable, root.level
        logging.disable(logging.INFO)
        try:
            return function(*args, **kwargs)
        finally:
            logging.disable(disabled)
            root.setLevel(level)

    return quiet  # type: ignore[return-value]


def versions() -> dict[str, str]:
    """Versions of the libraries that a result depends on."""
    return {
        "dolfinx": dolfinx.__version__,
        "petsc": ".".join(str(part) for part in PETSc.Sys.getVersion()),
    }


def atan2(y: Any, x: Any) -> Any:
    """Angle of the point (x, y), in (-π, π]."""
    return ufl.atan_2(y, x)


@_compiles
def create_triangle_mesh(
    comm: MPI.Comm, points: NDArray[np.float64], triangles: NDArray[np.int64]
) -> mesh.Mesh:
    """Distribute a mesh of straight triangles; only rank 0's arrays count."""
    if comm.rank != 0:
        points, triangles = np.empty((0, 2)), np.empty((0, 3), dtype=np.int64)
    domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.triangle, 1, dim=2))
    return mesh.create_mesh(comm, np.ascontiguousarray(triangles, dtype=np.int64), points, domain)


def tagged_facets(
    domain: mesh.Mesh, edges: NDArray[np.int64], tags: NDArray[np.int32]
) -> mesh.MeshTagsMetaClass:
    """Facet tags from edges given by input vertex numbers; only rank 0's arrays count."""
    if domain.comm.rank != 0:
        edges, tags = np.empty((0, 2), dtype=np.int64), np.empty(0, dtype=np.int32)
    domain.topology.create_entities(1)
    domain.topology.create_connectivity(1, 0)
    domain.topology.create_connectivity(1, 2)
    entities, values = io.distribute_entity_data(
        domain._mesh, 1, np.ascontiguousarray(edges, dtype=np.int64), tags
    )
    adjacency = dolfinx.cpp.graph.AdjacencyList_int32(entities)
    return mesh.meshtags_from_entities(domain, 1, adjacency, values.astype(np.int32))


def lagrange(degree: int, shape: tuple[int, ...] = ()) -> Any:
    """Continuous Lagrange element on triangles: scalar (), vector (n,) or tensor (n, m)."""
    if not shape:
        return ufl.FiniteElement("Lagrange", ufl.triangle, degree)
    if len(shape) == 1:
        return ufl.VectorElement("Lagrange", ufl.triangle, degree, dim=shape[0])
    return ufl.TensorElement("Lagrange", ufl.triangle, degree, shape=shape)


def mixed(elements: Sequence[Any]) -> Any:
    """Several elements side by side."""
    return ufl.MixedElement(*elements)


@_compiles
def functionspace(domain: mesh.Mesh, element: Any) -> fem.FunctionSpace:
    """Finite element space of `element` on `domain`."""
    return fem.FunctionSpace(domain, element)


def local_size(space: fem.FunctionSpace) -> int:
    """Number of dofs on this process, ghosts included."""
    dofmap = space.dofmap
    return (dofmap.index_map.size_local + dofmap.index_map.num_ghosts) * dofmap.index_map_bs


def owned_size(space: fem.FunctionSpace) -> int:
    """Number of dofs that this process owns; they come first in every local array."""
    return space.dofmap.index_map.size_local * space.dofmap.index_map_bs


def cell_dofs(space: fem.FunctionSpace) -> NDArray[np.int32]:
    """Block numbers of each local cell, shape (cells, dofs per cell)."""
    cells = space.mesh.topology.index_map(2)
    count = cells.size_local + cells.num_ghosts
    return np.asarray(space.dofmap.list.array).reshape(count, -1)


def cell_vertices(domain: mesh.Mesh) -> NDArray[np.int32]:
    """Geometry nodes of each local cell, shape (cells, 3)."""
    return np.asarray(domain.geometry.dofmap.array).reshape(-1, 3)


def interpolation_points(space: fem.FunctionSpace) -> NDArray[np.float64]:
    """Reference coordinates of the nodes of a Lagrange cell, shape (nodes, 2)."""
    return space.element.interpolation_points()


@_compiles
def form(expression: ufl.Form) -> fem.FormMetaClass:
    """Compile a form, or take it from the cache."""
    return fem.form(expression, jit_params=_JIT)


@_compiles
def expression(value: Any, points: NDArray[np.float64]) -> fem.Expression:
    """Compile the evaluation of a UFL expression at reference points of a cell."""
    return fem.Expression(value, points, jit_params=_JIT)


def evaluate(
    compiled: fem.Expression, domain: mesh.Mesh, cells: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Values of an expression in cells, shape (cells, points * components)."""
    return compiled.eval(cells)


def create_matrix(a: fem.FormMetaClass) -> PETSc.Mat:
    """Matrix with the sparsity of a bilinear form."""
    return fem.petsc.create_matrix(a)


def assemble_matrix(A: PETSc.Mat, a: fem.FormMetaClass, bcs: Sequence[Any]) -> None:
    """Assemble into an existing matrix; constrained rows and columns become the identity's."""
    A.zeroEntries()
    fem.petsc._assemble_matrix_mat(A, a, bcs)
    A.assemble()


def assemble_vector(b: la.VectorMetaClass, L: fem.FormMetaClass) -> None:
    """Assemble a linear form into a vector with ghosts; the owned part is complete."""
    b.array[:] = 0.0
    fem.assemble_vector(b.array, L)
    b.scatter_reverse(la.ScatterMode.add)


def lift(b: la.VectorMetaClass, a: fem.FormMetaClass, bcs: Sequence[Any]) -> None:
    """Subtract from b the columns of constrained dofs times their prescribed values."""
    fem.apply_lifting(b.array, [a], [list(bcs)])
    b.scatter_reverse(la.ScatterMode.add)


def create_vector(space: fem.FunctionSpace) -> la.VectorMetaClass:
    """Zero vector with ghosts over the dofs of a space."""
    return la.vector(space.dofmap.index_map, space.dofmap.index_map_bs)


def scatter_reverse_add(vector: la.VectorMetaClass) -> None:
    """Add ghost contributions to their owners."""
    vector.scatter_reverse(la.ScatterMode.add)


def containing_cells(domain: mesh.Mesh, points: NDArray[np.float64]) -> NDArray[np.int32]:
    """A local cell that holds each point of shape (n, 2), or -1."""
    padded = np.zeros((len(points), 3))
    padded[:, :2] = points
    tree = geometry.BoundingBoxTree(domain, domain.topology.dim)
    candidates = geometry.compute_collisions(tree, padded)
    colliding = geometry.compute_colliding_cells(domain, candidates, padded)
    owned = domain.topology.index_map(domain.topology.dim).size_local
    found = np.full(len(points), -1, dtype=np.int32)
    for i in range(len(points)):
        cells = [cell for cell in colliding.links(i) if cell < owned]
        found[i] = min(cells, default=-1)
    return found
