"""Probes read the displacement of a material point, whatever the scheme and its degree."""

import numpy as np
import pytest

pytestmark = pytest.mark.core

GRADIENT = np.array([[0.1, -0.2], [0.3, 0.05]])
POINTS = [[0.013, 0.071], [0.034, 0.102], [0.061, 0.187], [0.0, 0.2]]


@pytest.mark.parametrize(
    ("scheme", "degree"),
    [(scheme, degree) for scheme in ("hinge", "micromorphic") for degree in (2, 3, 4, 5, 6)],
)
def test_probes_are_exact_for_a_linear_displacement(coarse_case, scheme, degree):
    from mpi4py import MPI

    from pantograph_fem.sheet.simulation import SheetSimulation
    from pantograph_fem.stopwatch import Stopwatch

    case = coarse_case(
        discretisation={"scheme": scheme, "degree": degree}, output={"probes": POINTS}
    )
    simulation = SheetSimulation(case, MPI.COMM_WORLD, Stopwatch())
    discretisation = simulation.equilibrium.discretisation
    field = discretisation.field("displacement")
    discretisation.state.x.array[field.dofs] = field.coordinates @ GRADIENT.T
    np.testing.assert_allclose(
        simulation._probes.displacements(), np.array(POINTS) @ GRADIENT.T, atol=1e-15
    )
