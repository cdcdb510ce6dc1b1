"""Where a path ends: what is refused, what is tried before, and what is said about it."""

import ast
import collections
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mpi4py import MPI

import pantograph_fem.solve
from pantograph_fem.case import case_from_dict
from pantograph_fem.errors import PathError
from pantograph_fem.results.strict_json import to_json
from pantograph_fem.running import run
from pantograph_fem.solve.advice import advise
from pantograph_fem.solve.arc_length import follow_arc_length
from pantograph_fem.solve.cause import Cause
from pantograph_fem.solve.continuation import Correction, Linearisation, follow, start_at
from pantograph_fem.solve.factorisation import SingularTangentError
from pantograph_fem.solve.failure import Diagnosis, FailureReport, Remedies
from pantograph_fem.solve.ladder import rescue
from pantograph_fem.solve.predictor import PathPoint
from pantograph_fem.solve.step_size import StepSettings, StepSize

from .distributed import own_blocks
from .stability_problems import Toy, Truss, falling, pitchfork

REMEDIES = Remedies("a finer mesh (a smaller mesh.corner_size)", ("material.shear",))


def reported(**known):
    usual = {
        "last_load": 0.3,
        "load": 0.30001,
        "step": 1e-5,
        "cause": Cause.STALLED,
        "reason": "the error does not fall any more",
    }
    return FailureReport(**(usual | known))


@pytest.mark.parametrize(
    ("known", "advice"),
    [
        ({"turns_back_at": 0.30002}, "arc_length"),
        ({"cause": Cause.SINGULAR}, "material.shear"),
        ({"diagnosis": Diagnosis(zero_pivots=2)}, "material.shear"),
        ({"cause": Cause.ITERATIONS, "residuals": (1.0, 0.1, 1e-4)}, "max_iterations"),
        ({"cause": Cause.ITERATIONS, "residuals": (1.0, 0.9, 0.8)}, "mesh.corner_size"),
        ({"cause": Cause.STALLED, "step": 0.1}, "min_step"),
        ({"cause": Cause.OBJECTION, "step": 0.1}, "a motion that ends before that load"),
        ({"cause": Cause.STALLED}, "mesh.corner_size"),
        ({"cause": Cause.STEPS}, "max_steps"),
        # a critical state may have a zero pivot, for which there is no other advice
        ({"cause": Cause.NO_BRANCH, "diagnosis": Diagnosis(zero_pivots=1)}, "on_instability"),
        ({"cause": Cause.NO_MODE, "diagnosis": Diagnosis(zero_pivots=1)}, "mesh.corner_size"),
    ],
)
def test_each_cause_has_its_own_advice(known, advice):
    every = {"arc_length", "material.shear", "max_iterations", "min_step", "motion", "max_steps"}
    given = advise(reported(**known), REMEDIES)
    assert advice in given
    assert not [other for other in every if other in given and other not in advice]


def test_a_message_tells_load_reason_place_and_advice_and_the_file_the_rest():
    found = Diagnosis(0.5, "displacement at (0, 0.1) m", None, float("nan"), 3, 2, 0)
    report = reported(residuals=(1.0, 0.5), diagnosis=found, advice="a finer mesh")
    for part in ("0.3:", "to 0.30001", report.reason, "(0, 0.1) m", "Try a finer mesh."):
        assert part in report.message
    written = json.loads(to_json(report.as_dict()))
    assert written["cause"] == "stalled"
    assert written["residuals"] == [1.0, 0.5]
    assert written["lowest_eigenvalue"] is None
    assert written["negative_pivots"] == 3
    objected = replace(report, cause=Cause.OBJECTION)
    assert "(0, 0.1) m" not in objected.message  # forces were in balance


def truss_that_may_not_snap():
    truss = Truss(height=0.3, force=0.01)
    truss.equilibrium.objection = lambda x, load: "it snapped" if truss.apex(x) < 0 else ""
    return truss


def end_of(steps):
    found = []
    with pytest.raises(PathError) as caught:
        collections.deque(map(found.append, steps))
    report = caught.value.report
    assert report.message == str(caught.value)
    assert str(caught.value).endswith(f"Try {report.advice}.")
    assert report.reason
    return found, report


def test_a_load_that_turns_back_is_predicted_from_the_rates_before_it():
    truss = truss_that_may_not_snap()
    path = truss.path()
    found, report = end_of(follow(path, start_at(np.zeros(6)), StepSettings(), watch=path))
    limit = truss.load(truss.limits()[0])
    assert found[-1].load <= limit
    assert report.turns_back_at == pytest.approx(limit, abs=1e-6)
    assert report.advice == 'continuation.method = "arc_length"'
    assert report.last_load == found[-1].load
    assert report.diagnosis.expected_negative_pivots == report.diagnosis.negative_pivots == 0
    # near a limit point, and only there, the tangent is nearly singular
    assert report.diagnosis.lowest_eigenvalue > 0
    rest = path.diagnose(np.zeros(6), 0.0, path.correct(np.zeros(6), 0.1))
    assert report.diagnosis.lowest_eigenvalue < 0.1 * rest.lowest_eigenvalue


def test_a_path_along_its_arc_is_not_told_to_be_one():
    truss = truss_that_may_not_snap()
    path = truss.path()
    steps = follow_arc_length(
        path, start_at(np.zeros(6)), StepSettings(min_step=1e-3), np.zeros(6), 400
    )
    _, report = end_of(steps)
    assert report.cause is Cause.OBJECTION
    assert report.turns_back_at is None
    assert "arc_length" not in report.advice


def followed(path, arc=False, size=2, on_instability="follow", max_steps=400, **settings):
    start, settings = start_at(np.zeros(size)), StepSettings(**settings)
    if not arc:
        return follow(path, start, settings, watch=path, on_instability=on_instability)
    return follow_arc_length(
        path, start, settings, np.zeros(size), max_steps, on_instability=on_instability
    )


@pytest.mark.core
def test_a_path_that_has_taken_all_its_steps_says_so():
    found, report = end_of(followed(pitchfork().path(), arc=True, max_steps=7, max_step=0.1))
    assert found[-1].number == 7
    assert report.cause is Cause.STEPS
    assert report.last_load == report.load == found[-1].load
    assert 0.0 < report.step <= 0.1
    for said in (report.message, report.reason):
        assert "7 steps" in said
        assert "continuation.max_steps is 7" in said
    # what can be told of the last state
    excess = report.diagnosis.negative_pivots - report.diagnosis.expected_negative_pivots
    assert excess == found[-1].linearisation.unstable_modes
    assert report.diagnosis.worst_residual is None


@pytest.mark.parametrize("arc", [False, True])
@pytest.mark.parametrize("on_instability", ["branch", "stop"])
def test_a_path_that_cannot_do_at_a_critical_point_what_it_is_asked_for_says_so(
    arc, on_instability
):
    """No mode is found, by which it could be located."""
    path = pitchfork().path()
    analyse = path.analyse
    path.analyse = lambda x, load, number=1: (analyse(x, load, number)[0], None)
    found, report = end_of(followed(path, arc, on_instability=on_instability))
    assert report.cause is Cause.NO_MODE
    assert report.last_load == found[-1].load < 0.5 < report.load
    assert report.step == report.load - report.last_load
    assert "no mode" in report.reason
    assert 'continuation.on_instability = "follow"' in report.advice
    # and without being asked for anything goes on
    assert collections.deque(followed(path, arc), maxlen=1)[0].load == 1.0


@pytest.mark.parametrize(
    ("arc", "advice"),
    [(False, '"stop", or continuation.method = "arc_length"'), (True, '"follow" or "stop"')],
)
def test_a_path_that_finds_no_branch_says_so(arc, advice):
    """By load, where it falls; along the arc, where there is none, as y is held at a constant."""
    toy = pitchfork(quartic=1.0) if not arc else falling(0.5)
    if arc:
        toy.gradient = lambda z, t: [z[0] - t, (0.5 - z[0]) * z[1] + 1e9 * abs(z[1]) * z[1]]
        toy.hessian = lambda z, t: [[1.0, 0.0], [-z[1], 0.5 - z[0] + 2e9 * abs(z[1])]]
    found, report = end_of(followed(toy.path(), arc, on_instability="branch"))
    assert report.cause is Cause.NO_BRANCH
    assert report.last_load == report.load == found[-1].load == pytest.approx(0.5, rel=1e-5)
    assert found[-1].critical is not None
    assert "branch" in report.reason
    assert report.advice.endswith(advice)
    assert abs(report.diagnosis.lowest_eigenvalue) < 1e-4


@pytest.mark.parametrize("arc", [False, True])
@pytest.mark.parametrize("first", [True, False])
def test_a_tangent_without_a_factor_ends_a_path_with_a_report(arc, first):
    """At load 0, and beyond load 0.5."""
    path = pitchfork().path()
    linearise = path.linearise

    def failing(x, load):
        if first or load > 0.4:
            raise SingularTangentError("The tangent could not be factorised.")
        return linearise(x, load)

    path.linearise = failing
    found, report = end_of(followed(path, arc, min_step=1e-3))
    assert report.cause is Cause.SINGULAR
    assert "no factor" in report.reason
    assert bool(found) != first
    assert report.last_load == (0.0 if first else pytest.approx(0.4, abs=2e-3))


def test_every_error_with_which_a_path_ends_carries_a_report():
    """Those that carry none are caught on the way: jumps, and tangents without a factor."""
    folder = Path(pantograph_fem.solve.__file__).parent
    calls = [
        (module.name, call)
        for module in folder.glob("*.py")
        for call in ast.walk(ast.parse(module.read_text()))
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "PathError"
    ]
    assert calls
    assert not [module for module, call in calls if len(call.args) + len(call.keywords) < 2]


def test_a_path_that_has_taken_all_its_steps_leaves_a_file(tmp_path):
    case = case_from_dict(
        {
            "name": "bent",
            "kind": "beam",
            "beam": {"length": 1.0},
            "material": {"stretch": 1e4, "bending": 1.0},
            "ends": {"right": {"support": "free", "force": [0.0, 1.0]}},
            "mesh": {"size": 0.25},
            "continuation": {"method": "arc_length", "max_steps": 3},
            "output": {"figures": False, "fields": "none"},
        }
    )
    with pytest.raises(PathError) as caught:
        run(case, tmp_path, quiet=True)
    written = json.loads((tmp_path / "failure.json").read_text())
    assert written["message"] == str(caught.value)
    assert written["cause"] == "steps"
    assert "continuation.max_steps" in written["advice"]
    assert "sentence" not in written
    assert written["negative_pivots"] == written["expected_negative_pivots"]


def test_the_worst_unknown_is_named():
    """A spring that is pulled harder than it can bear: unknown 1 of x = t, y² + y = -t."""
    toy = Toy(
        2,
        lambda z, t: [z[0] - t, z[1] + z[1] ** 2 + t],
        lambda z, t: [[1.0, 0.0], [0.0, 1.0 + 2 * z[1]]],
        lambda z, t: [1.0, -1.0],
    )
    path = toy.path()
    _, report = end_of(follow(path, start_at(np.zeros(2)), StepSettings(min_step=1e-3), watch=path))
    assert report.diagnosis.worst_at == "unknown 1"
    assert report.diagnosis.worst_residual > 0
    assert report.turns_back_at == pytest.approx(0.25, abs=1e-3)
    assert len(report.residuals) > 1


def hard_bump(easy=1.0):
    """An unknown held by arctan(k x) = t, k = 20 at level 0: plain Newton steps overshoot."""
    toy = Toy(
        1,
        lambda z, t: [np.arctan(toy.k * z[0]) - t],
        lambda z, t: [[toy.k / (1 + (toy.k * z[0]) ** 2)]],
        lambda z, t: [1.0],
    )
    toy.k, toy.softest, toy.levels = 20.0, 1, []

    def soften(level):
        toy.levels.append(level)
        toy.k = easy if level else 20.0

    toy.soften = soften
    return toy


def test_the_way_by_an_easier_problem_ends_at_the_problem_itself():
    toy = hard_bump()
    path = toy.path()
    found = path.correct_softly(np.zeros(1), 1.3, 1)
    assert found.converged
    assert np.arctan(20.0 * found.x[0]) == pytest.approx(1.3)
    assert toy.levels == [1, 0, 0]


def test_a_problem_is_itself_again_after_an_easier_one_failed():
    toy = hard_bump()
    found = toy.path().correct_softly(np.zeros(1), 2.0, 1)  # beyond π/2: no state at any level
    assert not found.converged
    assert toy.levels[-1] == 0
    assert toy.k == 20.0


class Rungs:
    """A problem whose rungs lead to what a test says; 1-D, with the rate 1."""

    softest = 2

    def __init__(self, **states):
        self.states, self.tried = states, []

    def _found(self, rung, load):
        self.tried.append(rung)
        x = self.states.get(rung)
        if x is None:
            return Correction(load, np.zeros(1), False, 9, "nothing", Cause.STALLED)
        return Correction(load, np.array([x]), True, 3, "converged")

    def correct(self, guess, load):
        return self._found("tangent", load)

    def correct_exactly(self, guess, load):
        return self._found("exactly", load)

    def correct_softly(self, guess, load, level):
        return self._found(f"softly{level}", load)

    def inner(self, a, b):
        return float(a @ b)

    def linearise(self, x, load):
        return Linearisation(x, np.ones(1), int(x[0] < 0), 0, 0)


@pytest.mark.parametrize(
    ("states", "predictor", "tried"),
    [
        ({"exactly": 0.2}, "tangent", ["exactly"]),
        ({"tangent": 0.2}, "none", ["tangent"]),
        ({"softly1": 0.2}, "none", ["tangent", "exactly", "softly1"]),
        # too far away, and unstable: states of other paths
        ({"exactly": 7.0, "softly1": -0.2, "softly2": 0.2}, "tangent", None),
    ],
)
def test_the_first_rung_that_leads_on_the_path_is_taken(states, predictor, tried):
    problem = Rungs(**states)
    here = (PathPoint(0.0, np.zeros(1), np.ones(1)),)
    found, linearisation = rescue(problem, predictor, here, 0.1, True)
    assert found.x[0] == linearisation.x[0] == 0.2
    assert problem.tried == (tried or ["exactly", "softly1", "softly2"])
    assert rescue(Rungs(), predictor, here, 0.1, True) is None


def test_a_smallest_step_above_the_critical_one_ends_the_cut_backs():
    """Else an unstable state would be refused for ever."""
    size = StepSize(StepSettings(initial_step=0.5, min_step=0.5, max_step=0.5))
    assert not size.rejected(0.5, smallest=1e-3)


@pytest.fixture
def sheet(coarse_case):
    def make(**changes):
        from pantograph_fem.sheet.simulation import SheetSimulation
        from pantograph_fem.stopwatch import Stopwatch

        return SheetSimulation(coarse_case(**changes), MPI.COMM_WORLD, Stopwatch())

    return make


def displaced(simulation, motion):
    """The state with a displacement u(X), shape (n, 2) of both."""
    dofs, places = own_blocks(simulation.equilibrium, "displacement")
    x = simulation.start
    x[dofs] = motion(places)
    return x


HINGE = {"discretisation": {"scheme": "hinge", "degree": 2}}


@pytest.mark.core
@pytest.mark.parametrize(
    ("stretch", "shear", "objection"),
    [
        (1.0, 0.0, ""),
        (0.1, 0.0, ""),
        (1.0, 0.99, ""),  # ψ = π/2 at 1
        (0.04, 0.0, "shortened to 0.04 of its length"),
        (1.0, 1.01, "cross at"),
        (-1.0, 0.0, ""),  # turned by half a turn: as good as new
    ],
)
def test_folded_sheets_are_objected_to(sheet, stretch, shear, objection):
    """Fibres at 45°, stretched alike; x changed by a factor 1 - shear turns them together."""
    simulation = sheet(**HINGE)
    factors = stretch * np.array([1.0 - shear, 1.0]) - 1.0
    said = simulation.equilibrium.objection(displaced(simulation, lambda X: X * factors), 0.0)
    assert objection in said
    assert bool(said) == bool(objection)


@pytest.mark.core
def test_an_objection_names_the_place(sheet):
    """Only near the middle of the left edge is the sheet turned over."""
    simulation = sheet(**HINGE)

    def dent(X):
        depth = np.exp(-(((X - [0.0, 0.1]) / 0.02) ** 2).sum(axis=1))
        return np.column_stack([0.1 * depth, 0.0 * depth])

    said = simulation.equilibrium.objection(displaced(simulation, dent), 0.0)
    x, y = (float(part) for part in said.split("at (")[1].split(")")[0].split(", "))
    assert x < 0.03
    assert abs(y - 0.1) < 0.02


@pytest.mark.core
def test_a_sheet_that_is_pressed_together_ends_in_a_fold_and_says_so(tmp_path, coarse_case):
    """The top grip is pushed through the bottom one: no sheet follows."""
    case = coarse_case(
        **HINGE,
        grips={"top": {"translation": [0.0, -0.3]}},
        continuation={"initial_step": 0.25, "min_step": 0.02, "max_iterations": 8},
        output={"figures": False, "fields": "none"},
    )
    with pytest.raises(PathError) as caught:
        run(case, tmp_path, quiet=True)
    written = json.loads((tmp_path / "failure.json").read_text())
    assert written["message"] == str(caught.value)
    assert written["last_load"] < 0.7
    assert written["advice"] in written["message"]
    assert written["cause"] == "objection"
    assert "cross at (0.03" in written["reason"]  # in the middle of the sheet
    # a clean run in the same folder leaves none
    run(
        coarse_case(
            **HINGE, grips={"top": {"translation": [0.0, 0.001]}}, output={"figures": False}
        ),
        tmp_path,
        quiet=True,
    )
    assert not (tmp_path / "failure.json").exists()


def test_what_nothing_resists_is_said():
    """Unknown 1 is pulled, and nothing holds it."""
    toy = Toy(
        2,
        lambda z, t: [z[0] - t, -t],
        lambda z, t: [[1.0, 0.0], [0.0, 0.0]],
        lambda z, t: [1.0, 1.0],
    )
    toy.remedies = REMEDIES
    path = toy.path()
    _, report = end_of(follow(path, start_at(np.zeros(2)), StepSettings(), watch=path))
    assert report.diagnosis.zero_pivots == 1
    assert "material.shear" in report.advice


def test_the_condition_of_a_matrix_that_is_nearly_singular_is_large():
    conditions = []
    for gap in (1.0, 1e-3, 1e-6):
        toy = Toy(
            2,
            lambda z, t: [0.0, 0.0],
            lambda z, t, gap=gap: [[1.0, 1.0 - gap], [1.0 - gap, 1.0]],
            lambda z, t: [1.0, 0.0],
        )
        found = toy.path().diagnose(np.zeros(2), 0.0, toy.path().correct(np.zeros(2), 0.0))
        conditions.append(found.condition)
    assert conditions[0] < 10
    assert conditions[1] > 1e3
    assert conditions[2] > 1e6


@pytest.mark.core
@pytest.mark.parametrize("predictor", ["tangent", "none"])
def test_a_single_long_step_is_rescued(sheet, predictor):
    """Half of the turn of case c at once, which Newton's method does not find by itself."""
    simulation = sheet(
        **HINGE,
        grips={"top": {"translation": [0.0, 0.017], "rotation": 22.5}},
    )
    path = simulation.path
    settings = StepSettings(initial_step=1.0, min_step=1.0, max_step=1.0)
    one = list(follow(path, start_at(simulation.start), settings, predictor, watch=path))
    assert [step.load for step in one] == [0.0, 1.0]
    many = list(follow(path, start_at(simulation.start), StepSettings(), watch=path))
    np.testing.assert_allclose(one[-1].x, many[-1].x, atol=1e-8)
