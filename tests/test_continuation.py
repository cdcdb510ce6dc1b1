"""Load continuation on problems small enough to know everything about."""

import collections

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pantograph_fem.errors import PathError
from pantograph_fem.solve.continuation import Correction, Linearisation, follow, start_at
from pantograph_fem.solve.predictor import PathPoint, predict
from pantograph_fem.solve.step_size import StepSettings, StepSize


class Spring:
    """One unknown x with f(x) = load, solved by Newton; refuses steps that are too long."""

    def __init__(self, f, df, longest_step=np.inf):
        self.f, self.df = f, df
        self.longest_step = longest_step
        self.last_load = 0.0
        self.linearised = []

    def correct(self, guess, load):
        if load - self.last_load > self.longest_step:
            return Correction(load, np.full(1, np.nan), False, 3, "the step is too long")
        x = guess.copy()
        for iteration in range(1, 12):
            x = x - (self.f(x) - load) / self.df(x)
            if abs(self.f(x[0]) - load) < 1e-12:
                return Correction(load, x, True, iteration, "converged")
        return Correction(load, x, False, 11, "no convergence")

    def linearise(self, x, load):
        self.last_load = load
        self.linearised.append(load)
        slope = float(self.df(x[0]))
        return Linearisation(x, np.array([1.0 / slope]), int(slope < 0), 0, int(slope == 0))


def hardening(**options):
    return Spring(lambda x: x + x**3, lambda x: 1 + 3 * x**2, **options)


@pytest.mark.parametrize("predictor", ["tangent", "secant", "none"])
def test_every_accepted_state_is_an_equilibrium(predictor):
    problem = hardening()
    for step in follow(problem, start_at(np.zeros(1)), StepSettings(), predictor):
        assert problem.f(step.x[0]) == pytest.approx(step.load, abs=1e-11)
    assert step.load == 1.0


def test_stops_are_hit_exactly_and_marked():
    stops = (0.1 + 0.2, 0.7, 1.0)  # 0.30000000000000004
    steps = list(
        follow(hardening(), start_at(np.zeros(1)), StepSettings(stops=stops, max_step=0.2))
    )
    assert [step.load for step in steps if step.is_stop] == list(stops)
    assert [step.number for step in steps] == list(range(len(steps)))


def test_a_forced_cut_back_recovers_and_leaves_no_trace():
    rejected = []
    problem = hardening(longest_step=0.03)
    steps = list(
        follow(
            problem,
            start_at(np.zeros(1)),
            StepSettings(initial_step=0.25),
            on_rejected=lambda *report: rejected.append(report),
        )
    )
    assert rejected
    assert all(reason == "the step is too long" for _, _, reason in rejected)
    assert steps[-1].load == 1.0
    # Only accepted states were linearised, each once.
    assert problem.linearised == [step.load for step in steps]
    for step in steps:
        assert np.isfinite(step.x).all()


def test_a_limit_point_ends_the_path_with_what_was_found_before():
    # x - x³ has its maximum 2/(3√3) = 0.3849 at x = 1/√3: nothing lies beyond under load control.
    problem = Spring(lambda x: x - x**3, lambda x: 1 - 3 * x**2)
    problem.correct = _only_upwards(problem, problem.correct)
    limit = 2 / (3 * np.sqrt(3))
    found = []
    path = follow(problem, start_at(np.zeros(1)), StepSettings(min_step=1e-4))
    with pytest.raises(PathError, match=r"beyond load factor 0\.38") as caught:
        collections.deque(map(found.append, path))
    assert limit - 2e-4 < found[-1].load < limit
    assert "a finer mesh" in str(caught.value)


def _only_upwards(problem, correct):
    def checked(guess, load):
        result = correct(guess, load)
        jumped = result.converged and abs(result.x[0]) > 0.6
        return Correction(load, result.x, False, 1, "left the branch") if jumped else result

    return checked


def test_the_tangent_predictor_is_of_second_order_and_the_first_step_of_first():
    def x(t):
        return np.array([np.sin(t)])

    def error(h):
        points = [PathPoint(1 - h, x(1 - h), None), PathPoint(1.0, x(1.0), np.array([np.cos(1.0)]))]
        return abs(predict("tangent", points, 1 + h) - x(1 + h))[0]

    assert np.log2(error(0.02) / error(0.01)) == pytest.approx(3.0, abs=0.1)

    def first(h):
        return abs(predict("tangent", [PathPoint(1.0, x(1.0), np.cos([1.0]))], 1 + h) - x(1 + h))[0]

    assert np.log2(first(0.02) / first(0.01)) == pytest.approx(2.0, abs=0.1)


def test_predictors_reproduce_what_they_are_exact_for():
    line = [PathPoint(t, np.array([2 * t + 1])) for t in (0.1, 0.3)]
    assert predict("secant", line, 0.7) == pytest.approx([2.4])
    parabola = [PathPoint(t, np.array([t**2]), np.array([2 * t])) for t in (0.1, 0.3)]
    assert predict("tangent", parabola, 0.7) == pytest.approx([0.49])
    assert predict("none", line, 0.7) == pytest.approx([1.6])


def test_a_predictor_never_changes_an_accepted_state():
    point = PathPoint(0.0, np.zeros(2), np.ones(2))
    predict("none", [point], 1.0)[:] = 7.0
    predict("tangent", [point], 1.0)[:] = 7.0
    assert not point.x.any()


@given(
    st.lists(st.integers(1, 20), min_size=1, max_size=60),
    st.floats(1e-3, 0.3),
    st.lists(st.floats(0.01, 0.99), max_size=4, unique=True),
)
def test_step_sizes_stay_within_their_bounds(iterations, initial, inner):
    stops = (*sorted(inner), 1.0)
    settings = StepSettings(stops=stops, initial_step=initial, min_step=1e-3, max_step=0.3)
    size = StepSize(settings)
    load = 0.0
    for count in iterations:
        if size.finished(load):
            break
        new = size.next_load(load)
        assert load < new <= min(load + settings.max_step + 1e-12, 1.0)
        assert not any(load + 1e-9 < stop < new - 1e-9 for stop in stops)
        load = new
        size.accepted(count)


def test_steps_grow_when_easy_and_shrink_when_hard():
    size = StepSize(StepSettings(initial_step=0.01, target_iterations=4, growth=1.5, cutback=0.5))
    size.accepted(2)
    assert size.value == pytest.approx(0.015)
    size.accepted(4)
    assert size.value == pytest.approx(0.015)
    size.accepted(6)
    assert size.value == pytest.approx(0.01)
    size.accepted(20)
    assert size.value == pytest.approx(0.005)


def test_the_smallest_step_is_tried_before_giving_up():
    size = StepSize(StepSettings(initial_step=0.1, min_step=0.04))
    assert size.rejected(0.1)
    assert size.value == 0.05
    assert size.rejected(0.05)
    assert size.value == 0.04
    assert not size.rejected(0.04)


def test_a_path_taken_up_again_is_the_same_path():
    settings = StepSettings(stops=(0.4, 1.0), max_step=0.1)
    whole = list(follow(hardening(), start_at(np.zeros(1)), settings))
    for step in whole:
        rest = list(follow(hardening(), step.checkpoint, settings))
        assert [s.load for s in rest] == [s.load for s in whole[step.number :]]
        assert [s.x[0] for s in rest] == [s.x[0] for s in whole[step.number :]]
        assert [s.number for s in rest] == [s.number for s in whole[step.number :]]


def test_a_stable_path_is_left_only_by_a_small_step():
    """Beyond load 0.5 all states are unstable: that is believed once a step is small enough."""
    rejected = []
    problem = Spring(lambda x: x, lambda x: np.where(x < 0.5, 1.0, -1.0))
    problem.correct = lambda guess, load: Correction(load, np.array([load]), True, 2, "converged")
    settings = StepSettings(critical_step=1e-2)
    steps = list(
        follow(
            problem,
            start_at(np.zeros(1)),
            settings,
            on_rejected=lambda load, step, reason: rejected.append(reason),
        )
    )
    first = next(i for i, step in enumerate(steps) if not step.linearisation.stable)
    assert steps[first].load - steps[first - 1].load <= 1e-2
    assert 0.5 <= steps[first].load < 0.51
    assert set(rejected) == {"the state found is unstable"}
    assert steps[-1].load == 1.0
