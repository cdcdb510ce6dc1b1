"""Every critical point of a path: among unstable states, several in a step, at once, regained."""

from dataclasses import replace

import numpy as np
import pytest

from pantograph_fem.errors import PathError
from pantograph_fem.solve.cause import Cause
from pantograph_fem.solve.critical import Change, locate
from pantograph_fem.solve.equilibrium import Correction

from .stability_problems import Toy, falling, stiffnesses
from .test_stability_toys import critical_of, steps_of

BOTH = pytest.mark.parametrize("arc", [False, True])


def unit(shape):
    return np.abs(shape) / np.abs(shape).max()


@BOTH
@pytest.mark.parametrize("longest", [0.03, 0.5])
def test_all_modes_that_are_lost_are_located_one_after_the_other(arc, longest):
    """With long steps several are lost in one."""
    loads = np.array([0.3, 0.41, 0.45, 0.8])
    toy = falling(*loads)
    path = toy.path(eigenvalues=True)
    steps = steps_of(toy, path, size=5, arc=arc, max_step=longest)
    found = critical_of(steps)
    np.testing.assert_allclose([step.load for step in found], loads, rtol=1e-6)
    for i, step in enumerate(found):
        point = step.critical
        assert (point.kind, point.modes) == ("bifurcation", 1)
        assert point.loses_stability == (i == 0)
        np.testing.assert_allclose(unit(point.mode.shape), np.eye(5)[i + 1], atol=1e-6)
        assert abs(point.mode.eigenvalue) < 5e-5
        # what is lowest is lowest all the same; weights are 1/5
        lowest = step.linearisation.lowest.eigenvalue
        assert lowest == pytest.approx(5 * (loads[0] - step.load), abs=1e-6)
        assert step.linearisation.unstable_modes == i
    assert [step.number for step in steps] == list(range(len(steps)))
    assert (np.diff([step.load for step in steps]) > 0.0).all()
    between = np.diff([step.number for step in found]) - 1
    assert (between.min() == 0) == (longest == 0.5)


@BOTH
@pytest.mark.parametrize(
    ("loads", "modes"),
    [((0.5, 0.6, 0.6, 0.8), [1, 2, 1]), ((0.5, 0.5), [2]), ((0.4, 0.7, 0.7, 0.7), [1, 3])],
)
def test_modes_that_are_lost_at_once_are_one_point(arc, loads, modes):
    found = critical_of(steps_of(falling(*loads), size=len(loads) + 1, arc=arc, max_step=0.5))
    assert [step.critical.modes for step in found] == modes
    np.testing.assert_allclose([step.load for step in found], np.unique(loads), rtol=1e-6)


@BOTH
def test_a_mode_that_is_regained_among_unstable_states_is_located(arc):
    toy = stiffnesses(
        lambda x: np.array([0.25 - x, 10 * (x - 0.5) * (x - 0.7)]),
        lambda x: np.array([-1.0, 20 * x - 12.0]),
        size=2,
    )
    found = critical_of(steps_of(toy, size=3, arc=arc, max_step=0.1))
    np.testing.assert_allclose([step.load for step in found], [0.25, 0.5, 0.7], rtol=1e-6)
    assert [step.critical.loses_stability for step in found] == [True, False, False]
    # the state is on the side of fewer unstable modes
    assert [step.linearisation.unstable_modes for step in found] == [0, 1, 1]
    assert found[2].load > 0.7


def test_limit_points_among_unstable_states_are_located_and_known_as_such():
    """p = 4 x³ - 6 x² + 2.6 x turns back at x = (12 ∓ √19.2)/24, behind a mode lost at x = 0.2."""

    def pull(x):
        return (4 * x**3 - 6 * x**2 + 2.6 * x) / 0.6

    toy = stiffnesses(
        lambda x: np.array([0.2 - x]),
        lambda x: np.array([-1.0]),
        pull,
        lambda x: (12 * x**2 - 12 * x + 2.6) / 0.6,
    )
    steps = steps_of(toy, arc=True)
    places = np.array([0.2, (12 - np.sqrt(19.2)) / 24, (12 + np.sqrt(19.2)) / 24])
    found = critical_of(steps)
    np.testing.assert_allclose([step.load for step in found], pull(places), rtol=1e-6)
    kinds = ["bifurcation", "limit point", "limit point"]
    assert [step.critical.kind for step in found] == kinds
    np.testing.assert_allclose(unit(found[1].critical.mode.shape), [1, 0], atol=1e-5)
    counts = [step.linearisation.unstable_modes for step in steps if step.critical is None]
    assert set(counts) == {0, 1, 2}
    assert counts[-1] == 1
    assert steps[-1].load == 1.0


@BOTH
def test_an_unstable_mode_that_comes_without_an_eigenvalue_at_zero_is_a_jump(arc):
    """Beyond x = 0.5 a stiffness of 1 is -1: no path leads there."""
    toy = stiffnesses(
        lambda x: np.array([0.2 - x, 1.0 if x < 0.5 else -1.0]),
        lambda x: np.array([-1.0, 0.0]),
        size=2,
    )
    with pytest.raises(PathError, match=r"eigenvalue 2 of the tangent jumps") as caught:
        steps_of(toy, size=3, arc=arc)
    assert caught.value.report.cause is Cause.ELSEWHERE
    assert caught.value.report.last_load == pytest.approx(0.5, abs=2e-5)


@BOTH
def test_what_nothing_resists_all_along_hides_no_critical_point(arc):
    """An unknown without stiffness: a zero pivot at every state, but no change."""
    toy = falling(0.3, 0.6)
    gradient, hessian = toy.gradient, toy.hessian
    idle = Toy(
        4,
        lambda z, t: [*gradient(z[:3], t), 0.0],
        lambda z, t: np.pad(hessian(z[:3], t), (0, 1)),
        lambda z, t: [1.0, 0.0, 0.0, 0.0],
    )
    steps = steps_of(idle, size=4, arc=arc)
    assert {step.linearisation.zero_pivots for step in steps} == {1}
    found = critical_of(steps)
    np.testing.assert_allclose([step.load for step in found], [0.3, 0.6], rtol=1e-6)
    for i, step in enumerate(found):
        assert not step.critical.loses_stability  # which there never was
        np.testing.assert_allclose(unit(step.critical.mode.shape), np.eye(4)[i + 1], atol=1e-6)


def test_a_rescued_state_that_is_none_of_the_path_ends_it():
    """Beyond x = 0.5 as before, where only the line search that tries harder finds anything."""
    toy = stiffnesses(
        lambda x: np.array([0.2 - x, 1.0 if x < 0.5 else -1.0]),
        lambda x: np.array([-1.0, 0.0]),
        size=2,
    )
    path = toy.path()
    correct = path.correct

    def lost(guess, load, origin=None):
        found = correct(guess, load, origin)
        return replace(found, converged=False, reason="lost") if load > 0.5 else found

    path.correct = lost
    with pytest.raises(PathError, match=r"eigenvalue 2 of the tangent jumps") as caught:
        steps_of(toy, path, size=3)
    assert caught.value.report.cause is Cause.ELSEWHERE
    assert caught.value.report.last_load == pytest.approx(0.5, abs=2e-5)


@BOTH
def test_a_path_that_stays_as_it_is_is_not_analysed(arc):
    """As stable as it was, or as unstable: no tangent is factorised but those of the steps."""
    toy = falling(0.3, 2.0)
    path = toy.path()
    analysed, analyse = [], path.analyse

    def counting(x, load, number=1):
        analysed.append(load)
        return analyse(x, load, number)

    path.analyse = counting
    steps_of(toy, path, size=3, arc=arc, stops=(0.2, 1.0))
    assert analysed
    assert max(analysed) < 0.4  # around the one critical point
    assert len(analysed) < 12
    assert min(analysed) > 0.19


@pytest.mark.parametrize("state", [0.0, 0.35, 0.9])
def test_each_mode_is_found_by_its_number(state):
    loads = np.array([0.3, 0.5, 0.8])
    path = falling(*loads).path()
    x = np.array([state, 0.0, 0.0, 0.0])
    for number, stiffness in enumerate(loads - state, 1):
        linearisation, mode = path.analyse(x, state, number)
        assert mode.eigenvalue == pytest.approx(4 * stiffness, rel=1e-7)
        assert (mode.eigenvalue < 0.0) == (number <= linearisation.unstable_modes)


def test_a_critical_point_is_found_within_a_step_of_any_length():
    """So short a step that its whole length is within the tolerance of the load."""
    path = falling(0.5).path()

    def at(load):
        return path.linearise(np.array([load, 0.0]), load)

    for length in (1e-2, 1e-5, 1e-7, 1e-9):
        loads = 0.5 - 0.3 * length, 0.5 + 0.7 * length
        change = Change(loads[0], at(loads[0]), loads[1], at(loads[1]))

        def between(way, loads=loads):
            load = loads[0] + way * (loads[1] - loads[0])
            return Correction(load, np.array([load, 0.0]), True, 1, "converged")

        (point,) = locate(path, change, between)
        assert point.load == pytest.approx(0.5, rel=1e-6)
