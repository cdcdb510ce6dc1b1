"""The judge of hard cases: it accepts a true history and refuses every doctored one."""

import json
from dataclasses import replace

import numpy as np
import pytest

from pantograph_fem.case import load_case
from pantograph_fem.errors import CaseError
from pantograph_fem.results.progress import Progress
from pantograph_fem.running import run
from pantograph_fem.stress import run_suite, select
from pantograph_fem.stress.critical_loads import CriticalLoad
from pantograph_fem.stress.evidence import read_evidence
from pantograph_fem.stress.expectation import NoLessThan, SameAs, Value, Without
from pantograph_fem.stress.hard_case import CASES, HardCase
from pantograph_fem.stress.judge import judge
from pantograph_fem.stress.meshes import shaken, slivers
from pantograph_fem.stress.report import BEGIN, END, paste, row, write
from pantograph_fem.stress.work import balance
from pantograph_fem.study.process import Ended

OVERRIDES = (
    "lattice.spacing=0.0096",
    "grips.top.translation=[0.0,0.05]",
    "grips.top.rotation=20.0",
    "grips.bottom.rotation=-15.0",
    "grips.bottom.pivot='left'",
    "continuation.max_step=0.02",
    "output.eigenvalues=true",
    'output.fields="none"',
    "output.figures=false",
)
HARD = HardCase("lattice", "both grips of a lattice turn", "lattice_bias_extension", OVERRIDES)


@pytest.fixture(scope="module")
def true(tmp_path_factory):
    folder = tmp_path_factory.mktemp("true")
    case = load_case(CASES / f"{HARD.base}.toml", HARD.overrides)
    run(case, folder, quiet=True)
    return read_evidence(case, Ended(0, 1.0), folder)


def doctored(evidence, **columns):
    """A copy with columns replaced by what a function makes of them."""
    history = {name: np.array(values) for name, values in evidence.history.items()}
    for name, change in columns.items():
        history[name] = change(history[name])
    return replace(evidence, history=history)


def with_entry(index, value):
    def change(values):
        values[index] = value
        return values

    return change


def test_a_true_history_is_accepted(true):
    verdict = judge(HARD, true)
    assert verdict.failures == ()
    assert verdict.outcome == "done"


def test_the_summary_counts_the_steps_that_were_rejected(true, tmp_path, monkeypatch):
    assert true.summary["cutbacks"] == 0
    seen = []
    monkeypatch.setattr(Progress, "rejected", lambda *told: seen.append(told))
    steps = ["continuation.stops=[1.0]", "continuation.max_step=1.0"]
    steps += ["continuation.initial_step=1.0", "continuation.max_iterations=3"]
    run(load_case(CASES / f"{HARD.base}.toml", [*OVERRIDES, *steps]), tmp_path, quiet=True)
    assert json.loads((tmp_path / "summary.json").read_text())["cutbacks"] == len(seen) > 0


def test_energy_is_the_work_of_both_turning_grips_to_one_per_mille(true):
    assert balance(true).defect < 1e-3


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"force_y": lambda f: 1.05 * f}, "energy and work"),
        ({"force_x": lambda f: f + 0.2}, "energy and work"),
        ({"moment": lambda m: -m}, "energy and work"),
        ({"moment": lambda m: 0.0 * m}, "energy and work"),
        ({"force_y": lambda f: with_entry(-3, 1.3 * f[-3])(f)}, "energy and work"),
        ({"energy": lambda e: e + 1e-3}, "add up"),
        ({"energy_bending": lambda e: -e}, "negative"),
        ({"force_y": with_entry(4, np.nan)}, "force_y is not finite"),
        ({"load": with_entry(-1, 0.99)}, "done at load 0.99"),
        ({"load": with_entry(0, 0.001)}, "does not begin"),
        ({"load": lambda t: with_entry(5, t[3])(t)}, "load falls"),
        ({"load": lambda t: np.where(t == 0.4091710758377425, 0.41, t)}, "no state at the stop"),
        ({"negative_pivots": with_entry(-1, 1)}, "called stable"),
        ({"negative_pivots": with_entry(3, -1)}, "fewer negative pivots"),
        ({"stable": with_entry(-2, False)}, "called unstable"),
        ({"lowest_eigenvalue": lambda mu: with_entry(-1, -mu[-1])(mu)}, "disagree"),
        (
            {"negative_pivots": with_entry(-1, 1), "stable": with_entry(-1, False)},
            "disagree",
        ),
        (
            {
                "negative_pivots": with_entry(-1, 1),
                "stable": with_entry(-1, False),
                "lowest_eigenvalue": with_entry(-1, -0.1),
            },
            "at no critical point",
        ),
    ],
)
def test_a_doctored_history_is_refused(true, change, complaint):
    failures = judge(HARD, doctored(true, **change)).failures
    assert any(complaint in failure for failure in failures), failures


@pytest.mark.parametrize(
    ("ended", "complaint"),
    [
        (Ended(1, 1.0, "Traceback (most recent call last):\nValueError: no"), "ValueError: no"),
        (Ended(-11, 1.0), "signal 11"),
        (Ended(2, 1.0, "unknown key"), "exit code 2"),
        (Ended(3, 1.0), "without a message"),
        (Ended(3, 1.0, "The path ends."), "it stopped: The path ends."),
        (Ended(0, 1.0, "Traceback\nlate"), "crashed"),
    ],
)
def test_a_run_that_ends_badly_is_refused(true, ended, complaint):
    (failure,) = judge(HARD, replace(true, ended=ended)).failures
    assert complaint in failure


def test_a_run_may_stop_where_that_is_an_answer_but_not_be_called_done(true):
    stopped = replace(true, ended=Ended(3, 1.0, "The path ends."))
    assert judge(replace(HARD, may_stop=True), stopped).passed
    wrong = replace(true, summary={**true.summary, "status": "stopped: The path ends."})
    assert "exit code 0" in judge(HARD, wrong).failures[0]


def test_a_run_that_hangs_or_leaves_nothing_is_refused(true):
    assert "within" in judge(HARD, replace(true, timed_out=True)).failures[0]
    assert judge(HARD, replace(true, history={})).failures == ("there is no state",)


def test_expectations_see_what_differs(true):
    energy, force = true.last("energy"), true.last("force")
    other = {"other": doctored(true, energy=lambda e: 1.01 * e)}
    good = [
        Value("energy", 1.0001 * energy, relative=1e-3),
        Value("force", force, absolute=1e-9),
        SameAs("other", "force", relative=1e-9),
        SameAs("other", "energy", relative=1e-9, factor=1 / 1.01),
        Without("cut-backs"),
    ]
    bad = [
        Value("energy", 1.01 * energy, relative=1e-3),
        Value("force", -force, relative=1e-3),
        SameAs("other", "energy", relative=1e-3),
        NoLessThan("other"),
        CriticalLoad(0.5, 0.1, "bifurcation"),
    ]
    assert all(not expectation.objection(true, other) for expectation in good)
    assert all(expectation.objection(true, other) for expectation in bad)
    cut = replace(true, summary={**true.summary, "cutbacks": 2})
    assert Without("cut-backs").objection(cut, {}) == "2 cut-backs"


def test_a_runner_that_hangs_or_crashes_fails_its_case_and_not_the_others(tmp_path):
    hard = select(["chain_arc"])[0]

    def hangs(case, directory):
        while True:
            pass

    (result,) = run_suite([replace(hard, limit=0.2)], tmp_path, runner=hangs)
    assert result.verdict.failures == ("it did not end within 0.2 s",)
    (result,) = run_suite([hard], tmp_path, runner=lambda *_: Ended(-11, 0.1))
    assert "signal 11" in result.verdict.failures[0]
    write([result], tmp_path)
    assert "FAIL" in (tmp_path / "stress.csv").read_text()
    assert row(result)["steps"] is None
    document = tmp_path / "doc.md"
    document.write_text(f"Before.\n{BEGIN}\nold\n{END}\nAfter.\n")
    paste([result], document)
    text = document.read_text()
    assert text.startswith("Before.")
    assert text.endswith("After.\n")
    assert "old" not in text
    assert "| chain_arc |" in text


def test_selection_brings_along_what_a_case_is_compared_with():
    names = [hard.name for hard in select(["a_in_one_step"])]
    assert names == ["a_in_steps", "a_in_one_step"]
    assert "huge" not in [hard.name for hard in select()]
    assert "huge" in [hard.name for hard in select(["huge"], huge=True)]
    with pytest.raises(CaseError, match="no such hard case"):
        select(["nothing_*"])


def test_every_hard_case_is_a_case_and_names_are_unique(tmp_path):
    chosen = select(huge=True)
    assert len({hard.name for hard in chosen}) == len(chosen)
    known = {hard.name for hard in chosen}
    for hard in chosen:
        hard.load(tmp_path / hard.name)
        assert all(set(expectation.others) <= known for expectation in hard.expect)


@pytest.mark.parametrize(("write_mesh", "worst"), [(slivers, 5.5), (shaken, 5.5)])
def test_bad_meshes_are_bad_and_cover_the_sheet(tmp_path, write_mesh, worst):
    from pantograph_fem.mesh import read_mesh
    from pantograph_fem.mesh.triangulation import edge_lengths, signed_areas

    write_mesh(tmp_path / "bad.msh")
    mesh = read_mesh(tmp_path / "bad.msh")
    areas = signed_areas(mesh.points, mesh.triangles)
    assert areas.sum() == pytest.approx(0.068 * 0.204, rel=1e-12)
    # 1 for two equal sides at a right angle
    aspect = edge_lengths(mesh.points, mesh.triangles).max(axis=1) ** 2 / (4 * areas)
    assert aspect.max() > worst
