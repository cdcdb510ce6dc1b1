"""Taylor tests of the energies (1) and (19): gradient, second derivatives and rate of load."""

import numpy as np
import pytest

from pantograph_fem.lattice import couples, energy
from pantograph_fem.lattice.chain import chain, winkler
from pantograph_fem.lattice.cut import cut
from pantograph_fem.lattice.end_load import EndLoad
from pantograph_fem.lattice.equilibrium import LatticeEquilibrium
from pantograph_fem.physics.rigid_motion import RigidMotion

W, H = 0.06, 0.09
TURNED = RigidMotion(translation=(0.004, 0.006), angle=0.4, pivot=(0.02, 0.08))


def lattice(fibre_angle=45.0, spacing=0.015, **changes):
    constants = {
        "stretch": (1.34e3, 2.1e3),  # softer than paper's, so that no effect hides another
        "bending": (1.92e-2, 1.1e-2),
        "shear": 1.59e2,
        "exponent": 1.36,
        "regularisation": 0.05,
        "clamped": ("bottom", "top"),
    }
    net = cut(W, H, fibre_angle, spacing, **(constants | changes))
    return LatticeEquilibrium(net, {"top": TURNED}), 0.1 * spacing


def loaded_chain(supports, **changes):
    foundation = winkler(1.0, 0.1, ((0.5, 3e6), (1.0, 4e5)))
    constants = {"stretch": 4e3, "bending": 70.0, "ground": foundation}
    net = chain(1.0, 0.1, supports=supports, **(constants | changes))
    motions = {"left": RigidMotion(translation=(0.1, 0.0), angle=1.0)}
    loads = [EndLoad(end="right", node=10, link=9, force=(30.0, 20.0), moment=15.0)]
    return LatticeEquilibrium(net, motions, loads), 0.01


PROBLEMS = {
    "45 degrees": lambda: lattice(),
    "45 degrees, literal pivots": lambda: lattice(pivots="literal"),
    "45 degrees, spacing that fits": lambda: lattice(spacing=0.03 / np.sqrt(2)),
    "0 degrees, linear pivots": lambda: lattice(0.0, exponent=2.0),
    "30 degrees": lambda: lattice(30.0),
    "30 degrees, literal linear pivots": lambda: lattice(30.0, pivots="literal", exponent=2.0),
    "one family bends": lambda: lattice(bending=(1e-2, 0.0), shear=None),
    "cantilever": lambda: loaded_chain({"left": "clamped"}),
    "roller": lambda: loaded_chain({"left": "pinned", "right": "roller"}, ground=None),
}


@pytest.fixture(params=PROBLEMS, ids=PROBLEMS.keys())
def problem(request):
    """An equilibrium problem, and how far its nodes may go without links turning around."""
    return PROBLEMS[request.param]()


def potential(equilibrium, x, load):
    """Stored energy and the potential of dead loads, up to whole turns of a loaded link."""
    u = x.reshape(-1, 2)
    value = sum(equilibrium.energies(x, load).values())
    for dead in equilibrium.loads:
        first, second = equilibrium.net.links[dead.link]
        span = (equilibrium.net.nodes + u)[second] - (equilibrium.net.nodes + u)[first]
        value -= load * (np.dot(dead.force, u[dead.node]) + dead.moment * np.arctan2(*span[::-1]))
    return value


def residual(equilibrium, x, load):
    r = equilibrium.matrix().createVecLeft()
    equilibrium.residual(x, load, r)
    return r.array.copy()


def tangent(equilibrium, x, load):
    A = equilibrium.matrix()
    equilibrium.tangent(x, load, A)
    return A


def some_state(equilibrium, size, load, seed=7):
    """A state with held nodes in place, and a direction in which they stay there."""
    rng = np.random.default_rng(seed)
    shape = equilibrium.undeformed().shape
    x = equilibrium.impose(rng.uniform(-size, size, shape), load)
    direction = np.where(equilibrium.net.held.ravel(), 0.0, rng.uniform(-size, size, shape))
    return x, direction


def observed_order(remainder, h=0.1, halvings=3):
    """Exponent with which a remainder falls as the step is halved."""
    errors = [abs(remainder(h / 2**i)) for i in range(halvings + 1)]
    return np.log2(errors[-2] / errors[-1])


def gradient_order(equilibrium, size):
    """2 where the residual is the gradient of the potential, else 1."""
    x, d = some_state(equilibrium, size, 0.7)
    d /= 100  # small enough for a first-order error of 1 % to stand out
    slope = residual(equilibrium, x, 0.7) @ d
    start = potential(equilibrium, x, 0.7)
    return observed_order(lambda h: potential(equilibrium, x + h * d, 0.7) - start - h * slope)


def tangent_order(equilibrium, size):
    """2 where the tangent is the derivative of the residual, else 1."""
    x, d = some_state(equilibrium, size, 0.7)
    d /= 100
    A = tangent(equilibrium, x, 0.7)
    slope, direction = A.createVecs()
    direction.array[:] = d
    A.mult(direction, slope)
    start = residual(equilibrium, x, 0.7)
    return observed_order(
        lambda h: np.linalg.norm(residual(equilibrium, x + h * d, 0.7) - start - h * slope.array)
    )


def test_the_residual_is_the_gradient_of_the_potential(problem):
    assert gradient_order(*problem) > 1.9


def test_the_tangent_is_the_derivative_of_the_residual(problem):
    assert tangent_order(*problem) > 1.9


SPRINGS = [
    ("extension", energy, lattice),
    ("turn", couples, lattice),
    ("pivot", couples, lattice),
    ("quadratic_pivot", couples, lambda: lattice(exponent=2.0)),
    ("ground", energy, lambda: loaded_chain({"left": "clamped"})),
]


@pytest.mark.parametrize(("name", "module", "build"), SPRINGS, ids=[name for name, *_ in SPRINGS])
def test_a_derivative_that_is_wrong_by_one_per_cent_is_found(name, module, build, monkeypatch):
    right = getattr(module, name)

    def wrong_first(*arguments):
        response = right(*arguments)
        return response._replace(first=1.01 * response.first)

    def wrong_second(*arguments):
        response = right(*arguments)
        return response._replace(second=1.01 * response.second)

    monkeypatch.setattr(module, name, wrong_first)
    assert gradient_order(*build()) < 1.6
    monkeypatch.setattr(module, name, wrong_second)
    assert tangent_order(*build()) < 1.6


def test_the_tangent_is_symmetric_and_the_identity_at_held_unknowns(problem):
    equilibrium, size = problem
    x, _ = some_state(equilibrium, size, 0.7)
    # the array is that of the matrix, and gone with it
    dense = tangent(equilibrium, x, 0.7).convert("dense")
    A = dense.getDenseArray()
    np.testing.assert_allclose(A, A.T, atol=1e-12 * np.abs(A).max())
    held = equilibrium.net.held.ravel()
    np.testing.assert_array_equal(A[held], np.eye(len(A))[held])


def test_a_matrix_is_filled_again_without_a_trace_of_what_it_held(problem):
    """Newton's method scales the matrix that it is given."""
    equilibrium, size = problem
    x, d = some_state(equilibrium, size, 0.7)
    A = tangent(equilibrium, x, 0.7)
    A.scale(3.0)
    equilibrium.tangent(x + d, 0.7, A)
    assert A.equal(tangent(equilibrium, x + d, 0.7))


def test_the_load_rate_is_the_derivative_along_the_path(problem):
    """Where held unknowns follow the load, residual(x(t), t) changes by A dx/dt minus the rate."""
    equilibrium, size = problem
    load, h = 0.7, 1e-5
    x, _ = some_state(equilibrium, size, load)
    after, before = (equilibrium.impose(x, load + step) for step in (h, -h))
    change = residual(equilibrium, after, load + h) - residual(equilibrium, before, load - h)
    held = equilibrium.net.held.ravel()
    expected = np.where(held, after - before, -change) / (2 * h)
    rate = equilibrium.load_rate(x, load)
    np.testing.assert_allclose(rate, expected, atol=1e-6 * np.abs(rate).max())
    assert np.abs(rate[~held]).max() > 0


def test_a_shift_of_what_is_held_is_followed_along_the_tangent(problem):
    """Held unknowns that are shifted change the other forces by minus what is lifted."""
    equilibrium, size = problem
    load, h = 0.7, 1e-5
    x, _ = some_state(equilibrium, size, load)
    shift = np.random.default_rng(11).uniform(-size, size, x.shape)
    held = equilibrium.net.held.ravel()
    moved = np.where(held, shift, 0.0)
    change = residual(equilibrium, x + h * moved, load) - residual(equilibrium, x - h * moved, load)
    expected = np.where(held, shift, -change / (2 * h))
    lifted = equilibrium.lift(x, load, shift)
    np.testing.assert_allclose(lifted, expected, atol=1e-6 * np.abs(lifted).max())
    assert np.abs(lifted[~held]).max() > 0
