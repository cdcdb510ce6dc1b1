"""Newton's method on saddle points small enough to solve by hand."""

import numpy as np
import pytest

from petsc4py import PETSc

from pantograph_fem.solve.newton import NewtonSolver
from pantograph_fem.solve.newton_settings import NewtonSettings


class Saddle:
    """Stationary point of ¼k x⁴ + ½ k l² y² - f x + λ (x - y): x and y in m, λ in N."""

    def __init__(self, length=1.0, force=1.0, **settings):
        self.k, self.l, self.f = force / length**3, length, force
        self.tangents = 0
        A = PETSc.Mat().createAIJ((3, 3), nnz=3, comm=PETSc.COMM_SELF)
        A.setUp()
        typical = np.array([length, length, force])
        self.solver = NewtonSolver(
            self.residual, self.tangent, A, typical, force * length, NewtonSettings(**settings)
        )

    def residual(self, z, r):
        x, y, multiplier = z
        r.array[:] = [
            self.k * x**3 - self.f + multiplier,
            self.k * self.l**2 * y - multiplier,
            x - y,
        ]

    def tangent(self, z, A, origin=None):
        self.tangents += 1
        stiffness = self.k * self.l**2
        values = [[3 * self.k * z[0] ** 2, 0, 1], [0, stiffness, -1], [1, -1, 0]]
        A.setValues(range(3), range(3), np.array(values, dtype=float).ravel())
        A.assemble()

    def exact(self):
        """With x = l s: s³ + s = 1."""
        s = np.real(np.roots([1, 0, 1, -1])[-1])
        return np.array([self.l * s, self.l * s, self.f * s])


def test_a_saddle_point_is_found_with_the_inertia_of_its_constraint():
    problem = Saddle()
    result = problem.solver.solve(np.array([1.0, 1.0, 0.0]))
    assert result.converged, result.reason
    np.testing.assert_allclose(result.x, problem.exact(), rtol=1e-9)
    inertia = problem.solver.factorise(result.x).inertia
    assert (inertia.negative, inertia.zero) == (1, 0)


@pytest.mark.parametrize(("length", "force"), [(1e-3, 1.0), (1e3, 1e-3), (0.2, 1e5)])
def test_units_change_neither_the_iterations_nor_the_residuals(length, force):
    reference = Saddle().solver.solve(np.array([3.0, 3.0, 0.0]))
    scaled = Saddle(length, force).solver.solve(length * np.array([3.0, 3.0, 0.0]))
    np.testing.assert_allclose(scaled.residuals, reference.residuals, rtol=1e-6, atol=1e-15)
    np.testing.assert_allclose(scaled.x, reference.x * [length, length, force], rtol=1e-9)


def test_an_old_factor_saves_tangents_and_costs_no_accuracy():
    start = np.array([0.75, 0.75, 0.5])
    full, thrifty = Saddle(contraction=0.0), Saddle(contraction=0.3)
    exact = full.solver.solve(start).x
    result = thrifty.solver.solve(start)
    np.testing.assert_allclose(result.x, exact, atol=1e-8)
    assert result.iterations == thrifty.tangents < full.tangents


def test_the_error_left_is_below_the_tolerance():
    for tolerance in (1e-4, 1e-6, 1e-10):
        problem = Saddle(tolerance=tolerance)
        result = problem.solver.solve(np.array([2.0, 2.0, 0.0]))
        assert np.abs(result.x - problem.exact()).max() < tolerance


def test_back_substitution_is_in_physical_units():
    problem = Saddle(length=0.1, force=50.0)
    x = problem.exact()
    problem.solver.factorise(x)
    A = PETSc.Mat().createDense((3, 3), comm=PETSc.COMM_SELF)
    A.setUp()
    problem.tangent(x, A)
    load = np.array([1.0, -2.0, 0.3])
    dense = A.getDenseArray()
    np.testing.assert_allclose(
        problem.solver.back_substitute(load), np.linalg.solve(dense, load), rtol=1e-9
    )


def test_failure_says_why_and_leaves_the_guess_alone():
    problem = Saddle(max_iterations=1)
    guess = np.array([50.0, 50.0, 0.0])
    kept = guess.copy()
    result = problem.solver.solve(guess)
    assert not result.converged
    assert result.reason == "no convergence within max_iterations"
    np.testing.assert_array_equal(guess, kept)


def test_a_residual_that_is_not_a_number_is_a_failure():
    problem = Saddle()
    result = problem.solver.solve(np.array([np.nan, 0.0, 0.0]))
    assert not result.converged
    assert result.reason == "the residual is not a number"
