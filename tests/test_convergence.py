"""A manufactured solution: every field converges at the rate of its space."""

import numpy as np
import pytest
import ufl
from ufl.algorithms import expand_derivatives

from mpi4py import MPI

from dolfinx import fem

from pantograph_fem import dolfinx_api as api
from pantograph_fem.continuum.equilibrium import ContinuumEquilibrium
from pantograph_fem.mesh import rectangle
from pantograph_fem.physics.energy import sheet_energy
from pantograph_fem.physics.rigid_motion import RigidMotion
from pantograph_fem.schemes import Scales, discretise
from pantograph_fem.sheet.domain import distribute
from pantograph_fem.sheet.grip import Grip, GripSupport
from pantograph_fem.solve.newton import NewtonSolver
from pantograph_fem.solve.newton_settings import NewtonSettings

WIDTH, HEIGHT = 1.0, 2.0


def exact_fields(domain):
    """A smooth state that vanishes on the grips, as UFL: u, H = ∇u and any smooth Λ."""
    x, y = ufl.SpatialCoordinate(domain)
    bump = ufl.sin(ufl.pi * y / HEIGHT)
    u = ufl.as_vector((0.05 * bump * ufl.cos(2 * x), 0.08 * bump * ufl.sin(x + 0.5)))
    Lambda = 0.1 * ufl.as_matrix(((ufl.cos(x), x * y), (ufl.sin(y), ufl.cos(x + y))))
    return u, ufl.grad(u), Lambda


def errors(size, degree, auxiliary_degree):
    """L2 errors of u and ∇u, and of H and Λ where there are any.

    The load is that which makes the exact fields an equilibrium; without an auxiliary degree it is
    the hinge scheme that has to find them.
    """
    domain = distribute(MPI.COMM_SELF, rectangle(WIDTH, HEIGHT, size, size))
    energy = sheet_energy(
        constant=lambda value: fem.Constant(domain.mesh, float(value)),
        fibre_angle=np.pi / 4,
        stretch=(1.0, 2.0),
        bending=(0.1, 0.05),
        shear=0.3,
        exponent=1.5,
        regularisation=0.1,
    )
    d = discretise(
        domain.mesh,
        energy,
        Scales(1.0, 1.0, 2),
        scheme="micromorphic" if auxiliary_degree else "hinge",
        degree=degree,
        auxiliary_degree=auxiliary_degree,
        quadrature_degree=2 * degree + 2,
    )
    u, H, Lambda = exact_fields(domain.mesh)
    flat = [u[0], u[1]]
    if auxiliary_degree:
        flat += [T[i, j] for T in (H, Lambda) for i in range(2) for j in range(2)]
    load = ufl.replace(
        expand_derivatives(ufl.derivative(d.functional, d.state)), {d.state: ufl.as_vector(flat)}
    )
    load_vector = api.create_vector(d.state.function_space)
    api.assemble_vector(load_vector, api.form(load))

    grips = [
        Grip(domain.tags, tag, RigidMotion(), clamp=False, centre=(0.0, 0.0)) for tag in range(2)
    ]
    problem = ContinuumEquilibrium(d, [GripSupport(grip, d) for grip in grips])
    free = np.ones(len(load_vector.array))
    free[problem._owned_dofs] = 0.0

    def residual(x, r):
        problem.residual(x, 0.0, r)
        r.array[:] -= free * load_vector.array

    def tangent(x, A, origin):
        problem.tangent(x, 0.0, A, origin)

    solver = NewtonSolver(
        residual,
        tangent,
        problem.matrix(),
        problem.typical_sizes,
        1.0,
        NewtonSettings(tolerance=1e-13),
    )
    result = solver.solve(problem.undeformed())
    assert result.converged, result.reason
    problem.load_state(result.x, 0.0)
    differences = [d.displacement - u, ufl.grad(d.displacement) - H]
    if auxiliary_degree:
        _, Hh, Lh = ufl.split(d.state)
        differences += [Hh - H, Lh - Lambda]
    dx = ufl.dx(metadata={"quadrature_degree": 2 * degree + 4})
    return [np.sqrt(fem.assemble_scalar(api.form(ufl.inner(e, e) * dx))) for e in differences]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("degree", "auxiliary_degree", "sizes", "limits"),
    [
        # (lowest, highest) observed order of u, ∇u, H, Λ in L2, between meshes that are not
        # nested. The curvature ∂H is of order 1 and 2; u in P2 gains nothing beyond twice that.
        (2, 1, (0.2, 0.1), [(1.6, 2.3), (1.7, 2.3), (1.7, 2.3), (1.2, 2.3)]),
        (3, 2, (0.2, 0.1), [(3.5, 4.3), (2.5, 3.3), (2.5, 3.3), (1.4, 2.3)]),
        (5, 4, (0.2, 0.1), [(5.5, 6.6), (4.5, 5.6), (4.5, 5.6), (3.3, 4.6)]),
        # the hinge scheme: twice the order of the curvature bounds that of u
        (2, None, (0.2, 0.1), [(1.6, 2.4), (1.6, 2.4)]),
        (3, None, (0.1, 0.05), [(3.5, 4.4), (2.5, 3.4)]),
        (4, None, (0.2, 0.1), [(4.4, 5.5), (3.4, 4.5)]),
        (5, None, (0.2, 0.1), [(5.5, 6.6), (4.5, 5.6)]),
        (6, None, (0.2, 0.1), [(6.4, 7.8), (5.5, 6.8)]),
    ],
)
def test_every_field_converges_at_its_rate(degree, auxiliary_degree, sizes, limits):
    coarse, fine = (errors(size, degree, auxiliary_degree) for size in sizes)
    rates = np.log2(np.array(coarse) / fine)
    for rate, (lowest, highest) in zip(rates, limits, strict=True):
        assert lowest < rate < highest, rates
