"""Stability, critical points and branches of problems that are known in closed form."""

from collections import deque

import numpy as np
import pytest

from pantograph_fem.errors import PathError
from pantograph_fem.solve.arc_length import follow_arc_length
from pantograph_fem.solve.continuation import follow, start_at
from pantograph_fem.solve.step_size import StepSettings

from .stability_problems import Toy, Truss, constrained_pitchfork, pitchfork


def steps_of(problem, path=None, stops=(1.0,), size=2, on_instability="follow", arc=False, **more):
    path = path or problem.path()
    start = start_at(np.zeros(size))
    settings = StepSettings(stops=stops, **more)
    if arc:
        return list(
            follow_arc_length(
                path, start, settings, np.zeros(size), 400, on_instability=on_instability
            )
        )
    return list(follow(path, start, settings, watch=path, on_instability=on_instability))


def critical_of(steps):
    return [step for step in steps if step.critical is not None]


@pytest.mark.parametrize("arc", [False, True])
@pytest.mark.parametrize("constrained", [False, True])
def test_a_bifurcation_is_located_and_the_path_goes_on(arc, constrained):
    toy, weights = constrained_pitchfork() if constrained else (pitchfork(), None)
    size = 4 if constrained else 2
    steps = steps_of(toy, toy.path(weights), size=size, arc=arc, stops=(0.3, 1.0))
    (found,) = critical_of(steps)
    assert found.load == pytest.approx(0.5, rel=2e-6)
    assert found.critical.kind == "bifurcation"
    assert found.linearisation.stable
    mode = found.critical.mode
    assert abs(mode.eigenvalue) < 1e-5
    unit = mode.shape / np.abs(mode.shape).max()
    np.testing.assert_allclose(unit, [0, 1, 1, 0] if constrained else [0, 1], atol=1e-5)
    for step in steps:
        assert step.x[0] == pytest.approx(step.load, abs=1e-8)
        assert step.x[1] == pytest.approx(0.0, abs=1e-8)
        assert step.linearisation.stable == (step.load < 0.5)
    assert [step.load for step in steps if step.is_stop] == [0.3, 1.0]
    assert [step.number for step in steps] == list(range(len(steps)))


@pytest.mark.parametrize("arc", [False, True])
def test_a_path_stops_at_its_critical_load_when_asked_to(arc):
    steps = steps_of(pitchfork(), on_instability="stop", arc=arc)
    assert steps[-1].critical is not None
    assert steps[-1].load == pytest.approx(0.5, rel=2e-6)
    assert len(critical_of(steps)) == 1


@pytest.mark.parametrize("arc", [False, True])
@pytest.mark.parametrize("stops", [(1.0,), (0.5005, 0.8, 1.0), (0.5, 1.0)])
def test_the_stable_branch_is_followed_when_asked_for(arc, stops):
    steps = steps_of(pitchfork(), on_instability="branch", arc=arc, stops=stops)
    (found,) = critical_of(steps)
    for step in steps[found.number + 1 :]:
        assert step.linearisation.stable
        assert step.x[1] == pytest.approx(np.sqrt((2 * step.load - 1) / 2), rel=1e-6)
        assert step.x[0] == pytest.approx(step.load + step.x[1] ** 2, rel=1e-6)
    assert [step.load for step in steps if step.is_stop] == list(stops)


def test_a_branch_that_falls_is_no_way_up():
    with pytest.raises(PathError, match=r"load factor 0\.(5|4999).* no stable branch") as error:
        steps_of(pitchfork(quartic=1.0), on_instability="branch")
    assert "arc_length" in str(error.value)


def test_a_branch_that_falls_is_followed_along_its_arc():
    """y² = (2 t - 1)/(q - 2) with q < 2 never comes back, so the steps run out."""
    path, found = pitchfork(quartic=1.0).path(), []
    steps = follow_arc_length(
        path, start_at(np.zeros(2)), StepSettings(), np.zeros(2), 40, on_instability="branch"
    )
    with pytest.raises(PathError, match=r"continuation\.max_steps"):
        deque(map(found.append, steps))
    branch = found[critical_of(found)[0].number + 1 :]
    assert branch[-1].load < 0.0
    for step in branch:
        assert step.x[1] ** 2 == pytest.approx(1 - 2 * step.load, rel=1e-5)
        assert not step.linearisation.stable


def test_an_imperfection_leaves_no_critical_point():
    steps = steps_of(pitchfork(slope=0.01))
    assert not critical_of(steps)
    assert all(step.linearisation.stable for step in steps)


@pytest.mark.parametrize("arc", [False, True])
def test_inertia_and_the_lowest_eigenvalue_agree_all_along(arc):
    """A chain of pitchforks at t = ½, ⅔, ¾ ...: stability goes one mode after the other."""
    n = 6
    c = 0.5 + 0.1 * np.arange(n)
    toy = Toy(
        n + 1,
        lambda z, t: [z[0] - t, *((c - z[0]) * z[1:] + 4 * z[1:] ** 3)],
        lambda z, t: np.block(
            [
                [np.ones((1, 1)), np.zeros((1, n))],
                [-z[1:, None], np.diag(c - z[0] + 12 * z[1:] ** 2)],
            ]
        ),
        lambda z, t: [1.0, *z[1:]],
    )
    path = toy.path(eigenvalues=True)
    steps = steps_of(toy, path, size=n + 1, arc=arc, max_step=0.07)
    counts = set()
    for step in steps:
        lowest = step.linearisation.lowest.eigenvalue
        # weights are 1/(n + 1)
        assert lowest == pytest.approx((n + 1) * min(1.0, c[0] - step.load), abs=1e-6)
        excess = step.linearisation.negative_pivots
        counts.add(excess)
        assert excess == (c < step.load).sum()
        assert (lowest > 0) == step.linearisation.stable
    assert counts == set(range(n))


def test_units_change_no_eigenvalue():
    plain = pitchfork().path(eigenvalues=True).linearise(np.array([0.3, 0.0]), 0.3)
    toy = pitchfork()
    length, energy = 1e-3, 50.0
    scaled = Toy(
        2,
        lambda z, t: np.array(toy.gradient(z / length, t)) * energy / length,
        lambda z, t: np.array(toy.hessian(z / length, t)) * energy / length**2,
        lambda z, t: np.array(toy.pull(z, t)) * energy / length,
    )
    scaled.typical_sizes, scaled.typical_energy = np.full(2, length), energy
    other = scaled.path(eigenvalues=True).linearise(np.array([0.3e-3, 0.0]), 0.3)
    assert plain.lowest.eigenvalue == pytest.approx(2 * 0.4, rel=1e-9)
    assert other.lowest.eigenvalue == pytest.approx(2 * 0.4, rel=1e-9)
    np.testing.assert_allclose(other.lowest.shape, length * plain.lowest.shape, atol=1e-12)
    np.testing.assert_allclose(np.abs(plain.lowest.shape), [0.0, np.sqrt(2)], atol=1e-9)


def test_a_truss_snaps_through_both_limit_points():
    truss = Truss(height=0.3, force=0.01)
    z = truss.limits()
    assert len(z) == 2
    # the closed form: l³ = l₀ a²
    assert z[0] == pytest.approx(np.sqrt((1 + 0.09) ** (1 / 3) - 1), abs=1e-6)
    assert 0 < truss.load(z[0]) < 1
    steps = steps_of(truss, size=6, arc=True)
    first, second = critical_of(steps)
    for step, place in ((first, z[0]), (second, z[1])):
        assert step.critical.kind == "limit point"
        assert step.load == pytest.approx(truss.load(place), rel=1e-7)
        assert truss.apex(step.x) == pytest.approx(place, abs=1e-5)
    for step in steps:
        place = truss.apex(step.x)
        assert step.load == pytest.approx(truss.load(place), abs=1e-8)
        assert step.x[2] == pytest.approx(0.0, abs=1e-9)
        assert step.linearisation.stable == (not z[1] < place < z[0])
    assert steps[-1].load == 1.0
    assert truss.apex(steps[-1].x) < -0.3


def test_a_driven_truss_snaps_back():
    """Through a soft spring, the driven end itself must go back for the path to go on."""
    truss = Truss(height=0.3, spring=0.01, way=1.5)
    z = truss.limits()
    assert len(z) == 2
    assert truss.load(z[1]) < truss.load(z[0]) < 1
    stop = 0.5 * (truss.load(z[1]) + truss.load(z[0]))
    steps = steps_of(truss, size=8, arc=True, stops=(stop, 1.0))
    first, second = critical_of(steps)
    for step, place in ((first, z[0]), (second, z[1])):
        assert step.critical.kind == "limit point"
        assert step.load == pytest.approx(truss.load(place), rel=1e-6)
    for step in steps:
        assert step.load == pytest.approx(truss.load(truss.apex(step.x)), abs=1e-8)
    # The stop is met on the way up, before and after the snap, not on the way back.
    assert [step.load for step in steps if step.is_stop] == [stop, stop, 1.0]


def test_a_path_along_its_arc_that_is_taken_up_again_is_the_same_path():
    truss = Truss(height=0.3, force=0.01)
    whole = steps_of(truss, size=6, arc=True)
    for step in whole[:: len(whole) // 5]:
        if step.critical is not None:
            continue
        rest = list(
            follow_arc_length(
                truss.path(), step.checkpoint, StepSettings(), np.zeros(6), max_steps=400
            )
        )
        np.testing.assert_allclose(
            [s.load for s in rest], [s.load for s in whole[step.number :]], atol=1e-12
        )


def test_load_steps_end_where_the_truss_snaps_and_say_what_goes_on():
    """In the neighbourhood of the limit point: a jump to the state that has snapped is refused."""
    truss, found = Truss(height=0.3, force=0.01), []
    truss.equilibrium.objection = lambda x, load: "it snapped" if truss.apex(x) < 0 else ""
    path = truss.path()
    steps = follow(path, start_at(np.zeros(6)), StepSettings(), watch=path)
    with pytest.raises(PathError, match="arc_length"):
        deque(map(found.append, steps))
    limit = truss.load(truss.limits()[0])
    assert limit - 2e-5 < found[-1].load <= limit


def test_a_steep_truss_sways_before_it_snaps():
    """Bars of slope > 1 or so: the apex moves sideways at a bifurcation below the limit load."""
    truss = Truss(height=2.5, force=2.0)
    steps = steps_of(truss, size=6, arc=True, on_instability="stop")
    last = steps[-1]
    assert last.critical.kind == "bifurcation"
    z = truss.apex(last.x)
    # what resists the sway vanishes: (l₀/l) / l² + 1 - l₀/l = 0
    rest, now = np.sqrt(1 + 2.5**2), np.sqrt(1 + z**2)
    sideways = rest / now**3 + 1 - rest / now
    assert sideways == pytest.approx(0.0, abs=1e-5)
    assert z > truss.limits()[0]
    shape = last.critical.mode.shape
    assert abs(shape[2]) > 1e3 * abs(shape[3])
