"""The only module that knows which dolfinx is installed.

Everything else calls the functions here, which carry the names of newer releases. The branches on
``_OLD`` are for 0.5 (Debian 12), those on ``_NEW`` for 0.11 (a wheel on PyPI); without them this
is the module for 0.9 (Debian 13).
"""

from __future__ import annotations

import itertools
import logging
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import basix
import numpy as np
import ufl
from numpy.typing import NDArray

from mpi4py import MPI
from petsc4py import PETSc

import dolfinx
import dolfinx.fem.petsc
from dolfinx import fem, geometry, graph, io, la, mesh

_VERSION = tuple(int(part) for part in dolfinx.__version__.split(".")[:2])
_OLD, _NEW = _VERSION < (0, 6), _VERSION >= (0, 11)
if not _OLD:
    import basix.ufl
if TYPE_CHECKING:
    from dolfinx.fem import Form
    from dolfinx.la import Vector
    from dolfinx.mesh import MeshTags

#: The kernels are long straight-line code: the compiler's vectoriser takes a third off their time.
#: No -ffast-math, which would hide a NaN from the line search.
_COMPILER_FLAGS = ["-O3", "-g0", "-march=native", "-fno-math-errno"]
#: Seconds that one process waits for another that compiles the same form.
_COMPILER_TIMEOUT = 120
_OPTIONS = {"cffi_extra_compile_args": _COMPILER_FLAGS, "timeout": _COMPILER_TIMEOUT}
_JIT = {"jit_params" if _OLD else "jit_options": _OPTIONS}

#: Number of the first constant; beyond ten times as many their order in forms could change.
_FIRST_CONSTANT = 10**6

#: Cells by their dimension.
_CELLS = {1: "interval", 2: "triangle"}

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


def atan2(y: Any, x: Any) -> Any:
    """Angle of the point (x, y), in (-π, π]."""
    return ufl.atan_2(y, x) if _OLD else ufl.atan2(y, x)


@_compiles
def create_simplex_mesh(
    comm: MPI.Comm, dimension: int, points: NDArray[np.float64], cells: NDArray[np.int64]
) -> mesh.Mesh:
    """Distribute a mesh of straight intervals (1) or triangles (2); only rank 0's arrays count.

    Each process also has the cells across the facets of its own, for integrals over facets.
    """
    if comm.rank != 0:
        points, cells = np.empty((0, dimension)), np.empty((0, dimension + 1), dtype=np.int64)
    cells = np.ascontiguousarray(cells, dtype=np.int64)
    _keep_constants_in_order()
    domain = ufl.Mesh(_coordinate_element(dimension))
    if _OLD:
        return mesh.create_mesh(comm, cells, points, domain)
    links = (2,) if _NEW else ()  # cells at a facet, at most
    neighbours = mesh.create_cell_partitioner(mesh.GhostMode.shared_facet, *links)
    # By name: the order of the two changed in 0.10.
    return mesh.create_mesh(comm, cells, x=points, e=domain, partitioner=neighbours)


def _coordinate_element(dimension: int) -> Any:
    """Element of the positions in straight cells.

    With the variant spelled out, which the compiler of 0.5 would otherwise write into the mesh of
    the first form that it compiles: the later forms of that mesh would be cached by other names
    than they are looked up by once the first one is found in the cache.
    """
    if not _OLD:
        return _lagrange(1, (dimension,), _CELLS[dimension])
    return _equispaced(1, dimension, _CELLS[dimension])


def _keep_constants_in_order() -> None:
    """Give constants numbers of equally many digits.

    UFL sorts the constants of a form by their numbers as text, so that of two equal forms one with
    the constants 9 and 10 has another name in the cache than one with the constants 8 and 9.
    """
    if _OLD:
        ufl.Constant._globalcount = max(ufl.Constant._globalcount, _FIRST_CONSTANT)
    else:
        used = next(ufl.Constant._counter or itertools.count())
        ufl.Constant._counter = itertools.count(max(used, _FIRST_CONSTANT))


def tagged_facets(
    domain: mesh.Mesh, facets: NDArray[np.int64], tags: NDArray[np.int32]
) -> MeshTags:
    """Facet tags from facets given by input vertex numbers; only rank 0's arrays count.

    A facet is an edge of a triangle, shape (n, 2), or an end of an interval, shape (n, 1).
    """
    dim = domain.topology.dim - 1
    if domain.comm.rank != 0:
        facets, tags = np.empty((0, dim + 1), dtype=np.int64), np.empty(0, dtype=np.int32)
    domain.topology.create_entities(dim)
    domain.topology.create_connectivity(dim, 0)
    domain.topology.create_connectivity(dim, dim + 1)
    entities, values = io.distribute_entity_data(
        domain._mesh if _OLD else domain, dim, np.ascontiguousarray(facets, dtype=np.int64), tags
    )
    adjacency = (graph.create_adjacencylist if _OLD else graph.adjacencylist)(entities)
    return mesh.meshtags_from_entities(domain, dim, adjacency, values.astype(np.int32))


def lagrange(degree: int, shape: tuple[int, ...], domain: mesh.Mesh) -> Any:
    """Continuous Lagrange element on a mesh: scalar (), vector (n,) or tensor (n, m)."""
    return _lagrange(degree, shape, _CELLS[domain.topology.dim])


def _lagrange(degree: int, shape: tuple[int, ...], cell: str) -> Any:
    if not _OLD:
        return basix.ufl.element("Lagrange", cell, degree, shape=shape)
    if not shape:
        return ufl.FiniteElement("Lagrange", cell, degree)
    if len(shape) == 1:
        return ufl.VectorElement("Lagrange", cell, degree, dim=shape[0])
    return ufl.TensorElement("Lagrange", cell, degree, shape=shape)


def equispaced_lagrange(degree: int, components: int, domain: mesh.Mesh) -> Any:
    """Element of vectors with equispaced nodes, as VTK has them; else they crowd at corners."""
    return _equispaced(degree, components, _CELLS[domain.topology.dim])


def _equispaced(degree: int, components: int, cell: str) -> Any:
    if _OLD:
        element = ufl.FiniteElement("Lagrange", cell, degree, variant="equispaced")
        return ufl.VectorElement(element, dim=components)
    variant = basix.LagrangeVariant.equispaced
    return basix.ufl.element(
        "Lagrange", cell, degree, lagrange_variant=variant, shape=(components,)
    )


def piecewise_constant(domain: mesh.Mesh) -> Any:
    """Element of scalars that are constant on each cell."""
    cell = _CELLS[domain.topology.dim]
    if _OLD:
        return ufl.FiniteElement("DG", cell, 0)
    return basix.ufl.element("DG", cell, 0)


def cell_size(domain: mesh.Mesh) -> Any:
    """Length of an interval, longest side of a triangle, m."""
    if domain.topology.dim == 1:  # 0.5 cannot evaluate the diameter of an interval
        return abs(ufl.Jacobian(domain)[0, 0])
    return ufl.CellDiameter(domain)


def mixed(elements: Sequence[Any]) -> Any:
    """Several elements side by side."""
    return ufl.MixedElement(*elements) if _OLD else basix.ufl.mixed_element(list(elements))


@_compiles
def functionspace(domain: mesh.Mesh, element: Any) -> fem.FunctionSpace:
    """Finite element space of `element` on `domain`."""
    return fem.FunctionSpace(domain, element) if _OLD else fem.functionspace(domain, element)


def local_size(space: fem.FunctionSpace) -> int:
    """Number of dofs on this process, ghosts included."""
    dofmap = space.dofmap
    return (dofmap.index_map.size_local + dofmap.index_map.num_ghosts) * dofmap.index_map_bs


def owned_size(space: fem.FunctionSpace) -> int:
    """Number of dofs that this process owns; they come first in every local array."""
    return space.dofmap.index_map.size_local * space.dofmap.index_map_bs


def cell_dofs(space: fem.FunctionSpace) -> NDArray[np.int32]:
    """Block numbers of each local cell, shape (cells, dofs per cell)."""
    return _rows(space.dofmap.list, space.dofmap.dof_layout.num_dofs)


def cell_vertices(domain: mesh.Mesh) -> NDArray[np.int32]:
    """Geometry nodes of each local cell, shape (cells, vertices)."""
    cells = domain.geometry.dofmaps[0] if _NEW else domain.geometry.dofmap
    return _rows(cells, domain.topology.dim + 1)


def _rows(cell_nodes: Any, width: int) -> NDArray[np.int32]:
    if _OLD:  # an adjacency list, each cell having as many nodes; a process may have no cells
        return cell_nodes.array.reshape(-1, width)
    return cell_nodes


def interpolation_points(space: fem.FunctionSpace) -> NDArray[np.float64]:
    """Reference coordinates of the nodes of a Lagrange cell, shape (nodes, 2)."""
    points = space.element.interpolation_points
    return points() if callable(points) else points  # a property from 0.10 on


def quadrature_points(domain: mesh.Mesh, degree: int) -> NDArray[np.float64]:
    """Reference coordinates of the points where forms of a degree are evaluated in a cell."""
    cell = getattr(basix.CellType, _CELLS[domain.topology.dim])
    points, _ = basix.make_quadrature(cell, degree)
    return points


@_compiles
def form(expression: ufl.Form) -> Form:
    """Compile a form, or take it from the cache."""
    return fem.form(expression, **_JIT)


@_compiles
def expression(value: Any, points: NDArray[np.float64]) -> fem.Expression:
    """Compile the evaluation of a UFL expression at reference points of a cell."""
    return fem.Expression(value, points, **_JIT)


def evaluate(
    compiled: fem.Expression, domain: mesh.Mesh, cells: NDArray[np.int32]
) -> NDArray[np.float64]:
    """Values of an expression in cells, shape (cells, points * components)."""
    return compiled.eval(cells) if _OLD else compiled.eval(domain, cells)


def write_vtk(path: Path, function: fem.Function) -> None:
    """Write a Lagrange function of any degree to a .pvd file and those that it lists."""
    with io.VTKFile(function.function_space.mesh.comm, path, "w") as file:
        file.write_function(function)


def assemble_matrix(A: PETSc.Mat, a: Form, bcs: Sequence[Any]) -> None:
    """Assemble into an existing matrix; constrained rows and columns become the identity's."""
    A.zeroEntries()
    fem.petsc.assemble_matrix(A, a, list(bcs))
    A.assemble()


def assemble_vector(b: Vector, L: Form) -> None:
    """Assemble a linear form into a vector with ghosts; the owned part is complete."""
    b.array[:] = 0.0
    fem.assemble_vector(b.array, L)
    scatter_reverse_add(b)


def lift(b: Vector, a: Form, bcs: Sequence[Any]) -> None:
    """Subtract from b the columns of constrained dofs times their prescribed values."""
    fem.apply_lifting(b.array, [a], [list(bcs)])
    scatter_reverse_add(b)


def create_vector(space: fem.FunctionSpace) -> Vector:
    """Zero vector with ghosts over the dofs of a space."""
    return la.vector(space.dofmap.index_map, space.dofmap.index_map_bs)


def scatter_reverse_add(vector: Vector) -> None:
    """Add ghost contributions to their owners."""
    vector.scatter_reverse(la.ScatterMode.add if _OLD else la.InsertMode.add)


def containing_cells(domain: mesh.Mesh, points: NDArray[np.float64]) -> NDArray[np.int32]:
    """A local cell that holds each point of shape (n, d), or -1."""
    padded = np.zeros((len(points), 3))
    padded[:, : points.shape[1]] = points
    if _OLD:
        tree = geometry.BoundingBoxTree(domain, domain.topology.dim)
        candidates = geometry.compute_collisions(tree, padded)
    else:
        tree = geometry.bb_tree(domain, domain.topology.dim)
        candidates = geometry.compute_collisions_points(tree, padded)
    colliding = geometry.compute_colliding_cells(domain, candidates, padded)
    owned = domain.topology.index_map(domain.topology.dim).size_local
    found = np.full(len(points), -1, dtype=np.int32)
    for i in range(len(points)):
        cells = [cell for cell in colliding.links(i) if cell < owned]
        found[i] = min(cells, default=-1)
    return found
