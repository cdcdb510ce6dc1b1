"""The error that is left, from known sequences; and the loop that it steers."""

import math

import numpy as np
import pytest

from pantograph_fem.adapt.accuracy import Accuracy, FullLoad
from pantograph_fem.adapt.adaptive import MAX_DOFS, MAX_MESHES, adapt
from pantograph_fem.adapt.estimate import next_growth, remaining_error
from pantograph_fem.errors import PathError

ORDER = 2.0
FIRST_DOFS = 5000


def sequence(rate, growth, number, limit=(3.0, -4.0), error=(0.1, 0.02)):
    dofs = [round(FIRST_DOFS * growth**k) for k in range(number)]
    values = [
        [q + e * (n / FIRST_DOFS) ** -rate for q, e in zip(limit, error, strict=True)] for n in dofs
    ]
    return dofs, values, math.hypot(*error) * (dofs[-1] / FIRST_DOFS) ** -rate


@pytest.mark.parametrize("rate", [1.0, 1.4, 2.0])
@pytest.mark.parametrize("growth", [2.2, 4.0])
@pytest.mark.parametrize("number", [2, 3, 4])
def test_estimate_is_neither_far_below_nor_far_above_the_error(rate, growth, number):
    dofs, values, error = sequence(rate, growth, number)
    assert 0.5 < remaining_error(dofs, values, ORDER) / error < 5


@pytest.mark.parametrize("order", [3.0, 4.0, 5.0])
@pytest.mark.parametrize("rate", [0.8, 1.0, 1.5])
def test_a_high_order_promises_nothing_where_two_meshes_are_all_there_is(order, rate):
    dofs, values, error = sequence(rate, 2.5, 2)
    assert 0.5 < remaining_error(dofs, values, order) / error < 5


@pytest.mark.parametrize("rate", [0.6, 1.0, 1.3])
def test_three_meshes_tell_the_rate(rate):
    dofs, values, error = sequence(rate, 2.5, 3)
    assert remaining_error(dofs, values, ORDER) == pytest.approx(error, rel=1e-6)


def test_one_mesh_tells_nothing():
    assert remaining_error([100], [[1.0]], ORDER) == math.inf


def test_a_number_that_has_settled_has_no_error():
    assert remaining_error([100, 200, 400], [[1.0], [1.0], [1.0]], ORDER) == 0.0


def test_a_difference_that_is_small_by_chance_is_not_believed():
    dofs, values, error = sequence(1.4, 2.2, 3)
    values[2] = values[1]
    assert remaining_error(dofs, values, ORDER) > 0.5 * error


def test_differences_that_grow_are_taken_as_they_are():
    found = remaining_error([100, 220, 480], [[1.0], [1.01], [0.98]], ORDER)
    assert found > 0.03


def test_next_mesh_grows_with_what_is_wanted_between_bounds():
    bounds = (2.0, 4.0)
    growths = [next_growth(e, 1e-4, ORDER, bounds) for e in (1e-5, 3e-4, 4e-4, 1.0, math.inf)]
    assert growths[0] == 2.0
    assert 2.0 < growths[1] < growths[2] < 4.0
    assert growths[3] == 4.0
    assert growths[4] == 2.0  # nothing is known yet
    assert next_growth(1.0, 0.0, ORDER, bounds) == 4.0


class FakeLevel:
    """A mesh whose force and energy are known functions of the number of its unknowns."""

    order = ORDER

    def __init__(self, log, cells=1000, rate=1.0, stops_below=0, jumps=False, transfers=True):
        self.cells, self.unknowns = round(cells), round(9 * cells)
        self.settings = dict(rate=rate, stops_below=stops_below, jumps=jumps, transfers=transfers)
        self.log = log

    def state(self):
        error = 0.1 * (self.cells / 1000) ** -self.settings["rate"]
        return FullLoad((0.0, 2.0 * (1 + error)), 1.0 + error, True)

    def solve_from(self, coarser):
        assert coarser.cells < self.cells
        self.log.append("solve")
        if self.settings["jumps"]:
            return FullLoad((0.0, 9.0), 5.0, True)
        return self.state() if self.settings["transfers"] else None

    def follow(self):
        self.log.append("follow")
        if self.cells < self.settings["stops_below"]:
            raise PathError("too coarse")
        return self.state()

    def refined(self, growth):
        return FakeLevel(self.log, self.cells * growth, **self.settings)


def adapted(accuracy=1e-2, **settings):
    log, lines = [], []
    level, found = adapt(FakeLevel(log, **settings), "force", accuracy, lines.append)
    assert len(lines) == len(found.meshes)
    return level, found, log


def test_loop_ends_when_the_error_is_small_enough():
    level, found, log = adapted(1e-2)
    assert found.reached
    true = 0.1 * (level.cells / 1000) ** -1
    assert true < 1e-2
    assert 0.5 < found.error / true < 5
    assert found.last.cells == level.cells
    # Only the first path is followed: the others go on from where it was.
    assert log == ["follow", *["solve"] * (len(found.meshes) - 1)]


@pytest.mark.parametrize("trouble", [{"transfers": False}, {"jumps": True}])
def test_path_is_followed_again_where_the_old_state_leads_nowhere(trouble):
    _, found, log = adapted(1e-2, **trouble)
    assert found.reached
    assert log == ["follow", *["solve", "follow"] * (len(found.meshes) - 1)]


def test_a_first_mesh_that_is_too_coarse_is_refined():
    _, found, log = adapted(2e-2, stops_below=1500)
    assert found.reached
    assert log[:2] == ["follow", "follow"]
    assert found.meshes[0].state is None
    assert found.meshes[1].error_force == math.inf


def test_a_path_that_stops_on_two_meshes_ends_the_loop():
    _, found, log = adapted(1e-2, stops_below=math.inf)
    assert not found.reached
    assert log == ["follow"] * 2
    assert "NOT reached" in found.sentence()


def test_limits_end_the_loop_and_are_told():
    level, found, _ = adapted(1e-6)
    assert not found.reached
    assert level.unknowns <= MAX_DOFS
    assert len(found.meshes) <= MAX_MESHES
    assert "NOT reached" in found.sentence()
    assert found.as_dict()["reached"] is False


def series():
    found = Accuracy("energy", 1e-2)
    for cells, energy in ((1000, 1.05), (2200, 1.02), (4840, 1.012)):
        found = found.with_mesh(cells, 9 * cells, FullLoad((0.0, 2.0), energy, True), ORDER)
    return found


def test_accuracy_survives_the_way_through_a_file():
    found = series()
    assert Accuracy.from_dict(found.as_dict()) == found


def test_another_end_of_the_recorded_path_is_part_of_the_error():
    found = series()
    assert found.at_end(((0.0, 2.0), 1.012)) == found
    other = found.at_end(((0.0, 2.0), 1.1))
    assert other.last.error_energy > 0.08
    assert not other.reached
    assert not found.at_end(None).reached


def test_a_force_that_vanishes_has_no_relative_error():
    found = Accuracy("force", 1e-2)
    for cells, force in ((1000, 1e-9), (2200, 0.0)):
        found = found.with_mesh(cells, cells, FullLoad((force, 0.0), 1.0, True), ORDER)
    assert found.last.error_force == math.inf
    assert found.last.error_energy == 0.0
    assert not np.isnan(found.error)
