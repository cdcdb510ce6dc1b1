"""The error indicator, and states carried from mesh to mesh."""

import numpy as np
import pytest

from mpi4py import MPI

from dolfinx import fem

from pantograph_fem.adapt.indicator import ErrorIndicator
from pantograph_fem.adapt.location import Locator
from pantograph_fem.adapt.transfer import transferred
from pantograph_fem.mesh import rectangle
from pantograph_fem.sheet.simulation import SheetSimulation
from pantograph_fem.stopwatch import Stopwatch

W, H = 0.068, 0.204
SCHEMES = ("hinge", "micromorphic")
STEPS = np.eye(2)[:, :, None]


@pytest.fixture
def sheet(coarse_case):
    def make(size, corner_size=None, scheme="hinge", **changes):
        case = coarse_case(discretisation={"scheme": scheme, "degree": 3}, **changes)
        mesh = rectangle(W, H, size, corner_size or size)
        return mesh, SheetSimulation(case, MPI.COMM_WORLD, Stopwatch(), mesh)

    return make


def smooth(X):
    """A quadratic displacement; both cubics and their quadratic gradients hold it exactly."""
    x, y = X[0] / W, X[1] / H
    return 0.01 * np.stack([x * y - 0.3 * y**2 + 0.2 * x, x + 0.5 * y**2 - x**2])


def wavy(X):
    return 0.003 * np.stack([np.sin(30 * X[1]) * X[0] / W, np.sin(40 * X[0] + 20 * X[1])])


def put(simulation, displacement):
    """Give the state a displacement, and an auxiliary gradient that is its gradient."""
    discretisation = simulation.equilibrium.discretisation
    state = discretisation.state.x.array
    field = discretisation.field("displacement")
    state[field.dofs] = displacement(field.coordinates.T).T
    gradient = discretisation.field("gradient")
    if gradient is not None:
        X, h = gradient.coordinates.T, 1e-4
        sides = [(displacement(X + d) - displacement(X - d)) / (2 * h) for d in STEPS * h]
        state[gradient.dofs] = np.stack(sides, axis=1).reshape(4, -1).T
    return discretisation


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_state_that_the_elements_hold_exactly_has_no_error(sheet, scheme):
    _, simulation = sheet(0.02, scheme=scheme)
    indicator = ErrorIndicator(put(simulation, smooth))
    exact = np.linalg.norm(indicator.evaluate())
    put(simulation, wavy)
    assert exact < 1e-9 * np.linalg.norm(indicator.evaluate())


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_error_of_an_interpolated_state_falls_with_the_order_of_the_scheme(sheet, scheme):
    etas = []
    for size in (0.012, 0.006):
        _, simulation = sheet(size, scheme=scheme)
        etas.append(np.linalg.norm(ErrorIndicator(put(simulation, wavy)).evaluate()))
    assert 1.7 < np.log2(etas[0] / etas[1]) < 2.6


@pytest.mark.parametrize("scheme", SCHEMES)
def test_indicator_finds_the_corners(sheet, coarse_path, scheme):
    simulation, steps = coarse_path(
        discretisation={"scheme": scheme, "degree": 3}, mesh={"corner_size": 0.005, "size": 0.015}
    )
    simulation.equilibrium.load_state(steps[-1].x, 1.0)
    eta = ErrorIndicator(simulation.equilibrium.discretisation).evaluate()
    mesh = rectangle(W, H, 0.015, 0.005)
    x, y = mesh.points[mesh.triangles].mean(axis=1).T
    r = np.hypot(np.minimum(x, W - x), np.minimum(y, H - y))
    density = eta / np.sqrt(mesh.areas)
    assert r[np.argsort(density)[-8:]].max() < 0.01
    assert (eta > 0).all()


def test_symmetric_states_have_symmetric_indicators(sheet):
    mesh, simulation = sheet(0.015)
    eta = ErrorIndicator(
        put(simulation, lambda X: np.stack([0 * X[0], 0.01 * np.sin(30 * (X[1] - H / 2))]))
    ).evaluate()
    x, y = mesh.points[mesh.triangles].mean(axis=1).T
    order = np.lexsort(np.round([x, y], 9))
    mirrored = np.lexsort(np.round([W - x, H - y], 9))
    np.testing.assert_allclose(eta[order], eta[mirrored], rtol=1e-6, atol=1e-9 * eta.max())


@pytest.mark.core
def test_values_at_points_of_another_mesh_are_exact(sheet):
    _, simulation = sheet(0.02, 0.004)
    space = simulation.equilibrium.discretisation.state.function_space
    u = fem.Function(space)
    u.interpolate(smooth)
    points = np.random.default_rng(1).uniform((0, 0), (W, H), (500, 2))
    points[:4] = [(0, 0), (W, 0), (W, H), (0.0, H / 3)]
    points[4] = (W * (1 + 1e-13), H / 3)  # outside by round-off
    values = Locator(space.mesh).values(u, points)
    np.testing.assert_allclose(values, smooth(points.T).T, atol=1e-14)


@pytest.mark.core
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_quadratic_state_is_carried_over_exactly(sheet, scheme):
    still = {"grips": {"top": {"translation": [0.0, 0.0]}}}
    _, coarse = sheet(0.02, scheme=scheme, **still)
    _, fine = sheet(0.009, 0.002, scheme=scheme, **still)

    def held(X):  # in place at both grips
        return 0.05 * X[1] * (H - X[1]) / H * np.stack([0 * X[0] + 1.0, 0 * X[0] - 0.4])

    transferred(put(coarse, held), fine.equilibrium, 1.0)
    found = fine.equilibrium.discretisation.state.x.array.copy()
    expected = put(fine, held).state.x.array
    np.testing.assert_allclose(found, expected, atol=1e-10)


@pytest.mark.core
@pytest.mark.parametrize("scheme", SCHEMES)
def test_newton_goes_on_from_the_state_of_a_coarser_mesh(sheet, coarse_path, scheme):
    coarse, steps = coarse_path(
        discretisation={"scheme": scheme, "degree": 3}, mesh={"corner_size": 0.004}
    )
    coarse.equilibrium.load_state(steps[-1].x, 1.0)
    _, fine = sheet(0.012, 0.002, scheme=scheme)
    guess = transferred(coarse.equilibrium.discretisation, fine.equilibrium, 1.0)
    found = fine.path.correct(guess, 1.0)
    assert found.converged
    assert found.iterations <= 8
    assert fine.path.linearise(found.x, 1.0).stable
