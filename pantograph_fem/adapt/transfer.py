r"""A state on a new mesh, from that of the old one.

Where an edge of the old mesh crosses a new element, the gradient of the old displacement jumps
within it. Interpolated, it would bend the fibres of that element out of all proportion, and
Newton's method would not recover. So the new displacement is the one whose gradient is nearest to
the old gradient made continuous, G:

.. math:: \min_{\mathbf v} \int_\Omega \|\nabla\mathbf v - \mathbf G\|^2\,d\Omega

with the grips in place. The other fields are continuous as they are and are interpolated.
"""

from __future__ import annotations

import numpy as np
import ufl
from numpy.typing import NDArray

from petsc4py import PETSc

from dolfinx import fem
from dolfinx.fem import petsc

from .. import dolfinx_api as api
from ..continuum.equilibrium import ContinuumEquilibrium
from ..schemes import Discretisation, integration
from .location import Locator
from .recovery import Recovery

Array = NDArray[np.float64]


def transferred(old: Discretisation, new: ContinuumEquilibrium, load: float) -> Array:
    """Owned dofs of a state of `new`, near that which `old` holds; a collective call."""
    domain = old.state.function_space.mesh
    locate = Locator(domain)
    state = new.discretisation.state
    for field in new.discretisation.fields:
        source = old.field(field.name)
        assert source is not None  # both are of one scheme
        function = fem.Function(source.space)
        _components(function)[:] = old.state.x.array[source.dofs]
        state.x.array[field.dofs] = locate.values(function, field.coordinates)
    owned = api.owned_size(state.function_space)
    new.load_state(new.impose(state.x.array[:owned], load), load)

    gradient = ufl.grad(old.displacement)
    recovery = Recovery(domain, [gradient[i, j] for i in range(2) for j in range(2)])
    recovery.evaluate()
    _smooth(new, locate, recovery.mean)
    return state.x.array[:owned].copy()


def _smooth(new: ContinuumEquilibrium, locate: Locator, old_gradient: fem.Function) -> None:
    """Give the state the displacement with the gradient nearest to the old one."""
    state = new.discretisation.state
    domain = state.function_space.mesh
    field = new.discretisation.field("displacement")
    assert field is not None  # every scheme has one
    G = fem.Function(api.functionspace(domain, api.lagrange(2, (4,), domain)))
    places = G.function_space.tabulate_dof_coordinates()[:, :2]
    _components(G)[:] = locate.values(old_gradient, places)
    u = fem.Function(field.space)
    _components(u)[:] = state.x.array[field.dofs]
    held = np.isin(field.dofs[:, 0], np.concatenate([s.dofs for s in new.supports]))

    v, w = ufl.TestFunction(u.function_space), ufl.TrialFunction(u.function_space)
    dx = integration("dx", new.discretisation.quadrature_degree)
    gap = ufl.as_matrix(((G[0], G[1]), (G[2], G[3]))) - ufl.grad(u)
    correction = _solved(
        api.form(ufl.inner(ufl.grad(w), ufl.grad(v)) * dx),
        api.form(ufl.inner(gap, ufl.grad(v)) * dx),
        u.function_space,
        np.flatnonzero(held).astype(np.int32),
    )
    state.x.array[field.dofs] = _components(u) + _components(correction)


def _solved(
    a: fem.Form, L: fem.Form, space: fem.FunctionSpace, held: NDArray[np.int32]
) -> fem.Function:
    """Solution of a definite problem that vanishes at the held nodes."""
    solution = fem.Function(space)
    A = petsc.assemble_matrix(a, bcs=[fem.dirichletbc(fem.Function(space), held)])
    A.assemble()
    b = api.create_vector(space)
    api.assemble_vector(b, L)
    b.array.reshape(-1, 2)[held] = 0.0
    owned = api.owned_size(space)
    right, x = A.createVecRight(), A.createVecLeft()
    right.array[:] = b.array[:owned]
    solver = PETSc.KSP().create(space.mesh.comm)
    solver.setType(PETSc.KSP.Type.PREONLY)
    solver.setOperators(A)
    solver.getPC().setType(PETSc.PC.Type.CHOLESKY)
    solver.getPC().setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
    solver.solve(right, x)
    solution.x.array[:owned] = x.array
    solution.x.scatter_forward()
    for thing in (solver, A, right, x):
        thing.destroy()
    return solution


def _components(function: fem.Function) -> Array:
    """A view of the values by node, shape (nodes, components)."""
    return function.x.array.reshape(-1, function.function_space.dofmap.index_map_bs)
