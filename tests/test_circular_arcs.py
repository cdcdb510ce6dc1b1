"""Patch test: sheets that are rolled up into circular arcs, by a moment alone."""

import numpy as np
import pytest

from mpi4py import MPI

from dolfinx import fem

from pantograph_fem.continuum.equilibrium import ContinuumEquilibrium
from pantograph_fem.mesh import rectangle
from pantograph_fem.physics.energy import sheet_energy
from pantograph_fem.physics.rigid_motion import RigidMotion
from pantograph_fem.schemes import Scales, discretise
from pantograph_fem.sheet.domain import distribute
from pantograph_fem.sheet.grip import Grip, GripSupport

WIDTH, HEIGHT, K_B = 1.0, 1.5, 0.3


def arc(X, radius):
    """Displacement (n, 2) and placement gradient (n, 2, 2) of upright fibres on circles.

    The horizontal fibres stay straight: nothing is stretched, and there are no pivots.
    """
    x, y = X.T
    turn = y / radius
    u = np.stack([x + radius * (1 - np.cos(turn)), radius * np.sin(turn)], axis=1) - X
    F = np.zeros((len(X), 2, 2))
    F[:, 0, 0] = 1.0
    F[:, 0, 1], F[:, 1, 1] = np.sin(turn), np.cos(turn)
    return u, F


def rolled_up(radius, size, scheme, degree):
    """Stored energy of arcs as the space of a scheme interpolates them, J."""
    domain = distribute(MPI.COMM_SELF, rectangle(WIDTH, HEIGHT, size, size))
    energy = sheet_energy(
        constant=lambda value: fem.Constant(domain.mesh, float(value)),
        fibre_angle=0.0,
        stretch=(50.0, 50.0),
        bending=(K_B, K_B),
    )
    d = discretise(
        domain.mesh,
        energy,
        Scales(1.0, 1.0, 2),
        scheme=scheme,
        degree=degree,
        auxiliary_degree=degree - 1 if scheme == "micromorphic" else None,
        quadrature_degree=2 * degree + 2,
    )
    grips = [
        Grip(domain.tags, tag, RigidMotion(), clamp=False, centre=(0.0, 0.0)) for tag in range(2)
    ]
    problem = ContinuumEquilibrium(d, [GripSupport(grip, d) for grip in grips])
    state = np.zeros(len(d.state.x.array))
    for name, values in zip(("displacement", "gradient"), _values(d, radius), strict=False):
        field = d.field(name)
        if field is not None:
            state[field.dofs] = values(field.coordinates)
    return sum(problem.energies(state, 0.0).values())


def _values(d, radius):
    return (
        lambda X: arc(X, radius)[0],
        lambda X: (arc(X, radius)[1] - np.eye(2)).reshape(-1, 4),
    )


@pytest.mark.parametrize("radius", [1.0, 0.3])
@pytest.mark.parametrize(
    ("scheme", "degree", "order"),
    [
        # Curvatures of interpolated arcs are of the order degree - 1, their squares of twice that.
        ("micromorphic", 2, 2),
        ("micromorphic", 3, 4),
        ("micromorphic", 4, 6),
        # The moment works on the angles of interpolated hinges, which have one order less.
        ("hinge", 2, 1),
        ("hinge", 3, 3),
        ("hinge", 4, 5),
    ],
)
def test_energy_of_rolled_up_sheets_is_that_of_circular_arcs(scheme, degree, order, radius):
    exact = 0.5 * K_B / radius**2 * WIDTH * HEIGHT
    size = 0.125 * min(1.0, radius / 0.6)
    errors = [abs(rolled_up(radius, h, scheme, degree) / exact - 1.0) for h in (size, size / 2)]
    assert errors[0] < 0.1
    assert np.log2(errors[0] / errors[1]) > order - 0.6, errors
