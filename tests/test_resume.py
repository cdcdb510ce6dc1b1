"""A run that was interrupted goes on as if nothing had happened."""

import itertools

import numpy as np
import pytest

from pantograph_fem import checkpoint
from pantograph_fem.case import case_from_dict
from pantograph_fem.errors import CaseError, PathError
from pantograph_fem.parallel import at_root
from pantograph_fem.recorder import Recorder
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import read_history

from .conftest import COARSE, merged, run
from .processes import WORLD

pytestmark = pytest.mark.core

BASE = merged(
    COARSE,
    {
        "grips": {"top": {"translation": [0.01, 0.02], "rotation": 10.0}},
        "discretisation": {"degree": 2},
        "continuation": {"stops": [0.4, 1.0], "max_step": 0.15},
        "output": {"probes": [[0.034, 0.102]], "figures": False},
    },
)


def variant(**changes):
    return case_from_dict(merged(BASE, changes))


class PowerCut(BaseException):
    """What no part of a run is prepared for."""


def mortal(function, survived):
    """The function, which can be called so many times; then the power is cut."""
    calls = itertools.count()

    def call_or_die(*arguments):
        if next(calls) == survived:
            raise PowerCut
        return function(*arguments)

    return call_or_die


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The same run without an interruption."""
    return run(variant(), tmp_path_factory.mktemp("whole"), quiet=True)


@pytest.fixture
def interrupted(monkeypatch):
    """Run a case that dies at its sixth state: before it is recorded, or half way through."""

    def die(directory, moment, case=None):
        owner, name = {
            "before the state is recorded": (Recorder, "accepted"),
            "before it is the checkpoint": (checkpoint, "save"),
        }[moment]
        with monkeypatch.context() as patch:
            patch.setattr(owner, name, mortal(getattr(owner, name), survived=5))
            with pytest.raises(PowerCut):
                run(case or variant(), directory, quiet=True)

    return die


def assert_same_results(directory, expected):
    one, other = read_history(directory / "history.csv"), read_history(expected / "history.csv")
    assert one.keys() == other.keys()
    for name, values in other.items():
        scale = np.abs(values.astype(float)).max()
        np.testing.assert_allclose(
            one[name].astype(float), values.astype(float), rtol=0, atol=1e-8 * scale, err_msg=name
        )
    found, wanted = read_fields(directory), read_fields(expected)
    assert found.loads.tolist() == wanted.loads.tolist()
    for index in range(len(wanted.loads)):
        for name, values in wanted.fields(index).items():
            atol = 1e-8 * max(np.abs(values).max(), 1e-6)
            np.testing.assert_allclose(found.fields(index)[name], values, rtol=0, atol=atol)


@pytest.mark.parametrize("moment", ["before the state is recorded", "before it is the checkpoint"])
def test_a_resumed_run_ends_as_one_that_was_never_interrupted(tmp_path, whole, interrupted, moment):
    interrupted(tmp_path, moment)
    assert not (tmp_path / "summary.json").exists()
    reached = read_history(tmp_path / "history.csv")["step"][-1]
    result = run(variant(), tmp_path, resume=True, quiet=True)
    assert result.rows[0].step >= reached - 1 > 2
    assert_same_results(tmp_path, whole.directory)
    assert (tmp_path / "summary.json").is_file()


def test_without_resume_an_interrupted_run_starts_anew(tmp_path, whole, interrupted):
    interrupted(tmp_path, "before the state is recorded")
    result = run(variant(), tmp_path, quiet=True)
    assert result.rows[0].step == 0
    assert_same_results(tmp_path, whole.directory)


def test_with_nothing_to_resume_a_run_starts_anew(tmp_path, whole):
    result = run(variant(), tmp_path / "new", resume=True, quiet=True)
    assert result.rows[0].step == 0
    assert_same_results(tmp_path / "new", whole.directory)


def test_a_finished_run_that_is_resumed_stays_as_it_is(tmp_path, whole):
    run(variant(), tmp_path, quiet=True)
    result = run(variant(), tmp_path, resume=True, quiet=True)
    assert [row.load for row in result.rows] == [1.0]
    assert_same_results(tmp_path, whole.directory)


def test_a_path_that_ended_early_goes_on_with_other_settings(tmp_path, whole):
    hard = {"stops": [0.02, 1.0], "initial_step": 0.5, "min_step": 0.5, "max_step": 0.5}
    with pytest.raises(PathError):
        run(variant(continuation=hard | {"max_iterations": 2}), tmp_path, quiet=True)
    assert read_history(tmp_path / "history.csv")["load"].tolist() == [0.0, 0.02]
    result = run(variant(title="another"), tmp_path, resume=True, quiet=True)
    assert result.rows[-1].load == 1.0
    assert result.rows[-1].force == pytest.approx(whole.rows[-1].force, rel=1e-8, abs=1e-8)
    loads = read_history(tmp_path / "history.csv")["load"]
    assert loads[:2].tolist() == [0.0, 0.02]
    assert 0.4 in loads


@pytest.mark.parametrize(
    "changes",
    [
        {"material": {"shear": 160.0}},
        {"grips": {"top": {"translation": [0.01, 0.021]}}},
        {"mesh": {"size": 0.019}},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_another_case_is_not_taken_for_the_interrupted_one(tmp_path, interrupted, changes):
    interrupted(tmp_path, "before the state is recorded")
    before = (tmp_path / "history.csv").read_text()
    with pytest.raises(CaseError, match=r"belongs to another case.*without --resume"):
        run(variant(**changes), tmp_path, resume=True, quiet=True)
    assert (tmp_path / "history.csv").read_text() == before


def test_another_mesh_of_the_same_case_is_not_taken_for_the_first(tmp_path, interrupted):
    """As another version of the mesher would make."""
    interrupted(tmp_path, "before the state is recorded")

    def move_a_node(arrays):
        arrays["unknowns"][0, 1] += 1e-3

    change_checkpoint(tmp_path, move_a_node)
    with pytest.raises(CaseError, match=r"belongs to another mesh.*without --resume"):
        run(variant(), tmp_path, resume=True, quiet=True)


def test_a_checkpoint_that_does_not_say_what_its_numbers_are_is_refused(tmp_path, interrupted):
    interrupted(tmp_path, "before the state is recorded")
    change_checkpoint(tmp_path, lambda arrays: arrays.pop("unknowns"))
    before = (tmp_path / "history.csv").read_text()
    with pytest.raises(CaseError, match=r"earlier version.*without --resume"):
        run(variant(), tmp_path, resume=True, quiet=True)
    assert (tmp_path / "history.csv").read_text() == before


def change_checkpoint(directory, change):
    """Change its arrays, given by name."""

    def rewrite():
        path = directory / checkpoint.NAME
        with np.load(path) as file:
            arrays = dict(file)
        change(arrays)
        np.savez(path, **arrays)

    at_root(WORLD, rewrite)


def test_other_probes_do_not_fit_the_table(tmp_path, interrupted):
    interrupted(tmp_path, "before the state is recorded")
    with pytest.raises(CaseError, match="other columns"):
        run(variant(output={"probes": []}), tmp_path, resume=True, quiet=True)
