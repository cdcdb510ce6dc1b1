"""Beams against exact solutions: boundary value problems, closed forms, critical loads."""

from pathlib import Path

import numpy as np
import pytest

from mpi4py import MPI

from pantograph_fem.beam.simulation import BeamSimulation
from pantograph_fem.case import case_from_dict, load_case
from pantograph_fem.errors import PathError
from pantograph_fem.results.fields import read_fields
from pantograph_fem.solve.continuation import follow, start_at
from pantograph_fem.solve.step_size import StepSettings
from pantograph_fem.stopwatch import Stopwatch

from .conftest import merged, run
from .exact_beam import cantilever_along_an_arc, cantilever_with_dead_load
from .processes import SEVERAL

pytestmark = pytest.mark.core

CASES = Path(__file__).parents[1] / "cases"
K_E, K_B = 4.05e8, 7.59e5

#: The beam of Fig. 5.
BEAM = {
    "name": "beam",
    "kind": "beam",
    "beam": {"length": 1.0},
    "material": {"stretch": K_E, "bending": K_B},
    "output": {"figures": False, "fields": "stops"},
}


def solved(folder, **changes):
    """Rows at the stops, and the last state's fields with their abscissae."""
    case = case_from_dict(merged(BEAM, changes))
    result = run(case, folder, quiet=True)
    states = read_fields(folder)
    rows = [row for row in result.rows if row.load in case.continuation.stops]
    return rows, states.grid.points[:, 0], states.fields(-1)


@pytest.fixture(scope="module")
def arc(tmp_path_factory):
    """The shipped case of Fig. 5."""
    folder = tmp_path_factory.mktemp("arc")
    case = load_case(CASES / "beam_arc.toml", ["output.figures=false"])
    result = run(case, folder, quiet=True)
    return case, [row for row in result.rows if row.load in case.continuation.stops], folder


def test_fig_5_is_the_exact_solution_of_the_boundary_value_problem(arc):
    case, rows, _ = arc
    angles = [np.radians(case.ends.right.rotation) * row.load for row in rows]
    assert np.degrees(angles) == pytest.approx([30, 60, 90, 120, 150])
    for row, exact in zip(rows, cantilever_along_an_arc(K_E, K_B, 1.0, angles), strict=True):
        assert row.energy == pytest.approx(exact.energy, rel=1e-6)
        np.testing.assert_allclose(row.force, exact.force, atol=1e-6 * np.hypot(*exact.force))
        assert row.extra["tip_angle"] == pytest.approx(exact.angle, abs=1e-6)
        assert row.stable


def test_fig_5_at_ninety_degrees_is_what_others_computed(arc):
    _, rows, _ = arc
    row = next(row for row in rows if row.load == 0.6)
    assert row.energy == pytest.approx(2_518_403.294, rel=1e-6)
    assert row.force == pytest.approx((-6_847_175.5, -9_348_195.9), rel=1e-6)
    assert row.extra["tip_angle"] == pytest.approx(1.985128025, abs=1e-6)


def test_the_first_integral_is_constant_along_the_beam(arc):
    """½ K_b φ'² + P·e + (P·e)²/(2 K_e), with P the force of the end."""
    _, rows, folder = arc
    fields = read_fields(folder).fields(-1)
    P = np.array(rows[-1].force)
    along = P[0] * np.cos(fields["angle"]) + P[1] * np.sin(fields["angle"])
    integral = 0.5 * K_B * fields["curvature"] ** 2 + along + along**2 / (2 * K_E)
    assert np.ptp(integral) < 1e-3 * np.abs(integral).max()
    # It is a balance of large terms.
    assert np.ptp(along) > 0.5 * np.abs(integral).max()
    np.testing.assert_allclose(fields["axial_force"], along, atol=1e-4 * np.hypot(*P))


@pytest.mark.parametrize("turns", [0.5, 1.0])
def test_an_end_moment_rolls_the_beam_up_to_an_arc(tmp_path, turns):
    moment = turns * 2 * np.pi * K_B
    rows, S, fields = solved(
        tmp_path,
        ends={"right": {"support": "free", "moment": moment}},
        continuation={"max_step": 0.1},
    )
    phi = moment / K_B
    exact = np.column_stack([np.sin(phi * S) / phi - S, (1 - np.cos(phi * S)) / phi])
    np.testing.assert_allclose(fields["displacement"], exact, atol=1e-6)
    np.testing.assert_allclose(fields["stretch"], 1.0, atol=1e-6)
    assert rows[-1].moment == pytest.approx(moment, rel=1e-12)
    assert rows[-1].energy == pytest.approx(0.5 * K_B * phi**2, rel=1e-5)
    assert rows[-1].extra["tip_angle"] == pytest.approx(phi, rel=1e-6)


def test_clamps_that_turn_bend_the_beam_to_an_arc(tmp_path):
    """Both clamps, each turned by half of the angle, at the ends of the exact arc."""
    angle = np.radians(100.0)
    radius = 1.0 / angle
    half = radius * np.sin(angle / 2)
    rows, S, fields = solved(
        tmp_path,
        ends={
            "left": {"support": "clamped", "rotation": -50.0, "translation": [0.5 - half, 0.0]},
            "right": {"support": "clamped", "rotation": 50.0, "translation": [half - 0.5, 0.0]},
        },
    )
    phi = angle * (S - 0.5)
    exact = np.column_stack(
        [0.5 + radius * np.sin(phi) - S, radius * (np.cos(angle / 2) - np.cos(phi))]
    )
    np.testing.assert_allclose(fields["displacement"], exact, atol=1e-6)
    assert rows[-1].moment == pytest.approx(K_B * angle, rel=1e-5)
    np.testing.assert_allclose(rows[-1].force, 0.0, atol=1e-4 * K_B)
    assert rows[-1].energy == pytest.approx(0.5 * K_B * angle**2, rel=1e-5)
    np.testing.assert_allclose(fields["bending_moment"], K_B * angle, rtol=1e-4)


WINKLER = {
    "a1": (1_219_530.82, 33_588_835.8),
    "a2": (1_219_530.82, 1.0124821e9),
    "b1": (11_047.3073, 408_400_603.0),
    "b2": (166_446.145, 408_400_603.0),
}


@pytest.mark.parametrize("name", WINKLER)
@pytest.mark.parametrize("direction", [0, 1])
def test_small_displacements_on_a_foundation_are_linear(tmp_path, name, direction):
    """Tip force for a unit tip displacement, from the linear equations."""
    translation = [0.0, 0.0]
    translation[direction] = 1e-6
    case = load_case(
        CASES / f"beam_winkler_{name}.toml",
        [f"ends.right.translation={translation}", "output.figures=false"],
    )
    last = run(case, tmp_path, quiet=True).rows[-1]
    # axial, then transverse, in the order of the directions
    exact = WINKLER[name][::-1][direction]
    assert last.force[direction] / 1e-6 == pytest.approx(exact, rel=2e-5)
    assert last.energy == pytest.approx(0.5 * exact * 1e-12, rel=2e-5)
    assert last.energies["foundation"] > 0


def path_of(stops=(1.0,), **changes):
    """Accepted states of a path and the problem they solve."""
    case = case_from_dict(merged(BEAM, changes))
    simulation = BeamSimulation(case, MPI.COMM_WORLD, Stopwatch())
    options = case.continuation
    settings = StepSettings(
        stops=stops, max_step=options.max_step, critical_step=options.critical_step
    )
    return simulation._equilibrium, follow(simulation.path, start_at(simulation.start), settings)


def critical_load(mu, K_e=K_E):
    """N_cr = (K_e/2)(1 - sqrt(1 - 4 K_b k²/K_e)), k = π/(μL)."""
    k = np.pi / mu
    return K_e / 2 * (1 - np.sqrt(1 - 4 * K_B * k**2 / K_e))


@pytest.mark.parametrize(
    ("left", "right", "mu", "known"),
    [("clamped", "free", 2.0, 1_881_498.264), ("pinned", "roller", 1.0, 7_634_962.204)],
)
def test_a_straight_column_loses_stability_at_the_critical_load(left, right, mu, known):
    critical = critical_load(mu)
    assert critical == pytest.approx(known, rel=1e-9)
    _, steps = path_of(
        ends={
            "left": {"support": left},
            "right": {"support": right, "force": [-2.0 * critical, 0.0]},
        },
        continuation={"critical_step": 1e-4},
    )
    stable = 0.0
    for step in steps:
        if not step.linearisation.stable:
            break
        stable = step.load
    assert step.linearisation.negative_pivots == step.linearisation.expected_negative_pivots + 1
    assert stable <= 0.5 * (1 + 1e-4)
    assert step.load >= 0.5 * (1 - 1e-4)
    assert step.load - stable <= 1e-4


def test_a_short_column_of_low_stretch_stiffness_never_buckles():
    """4 K_b k² > K_e: N_cr is not real, the straight column is stable under any pressure."""
    K_e = 3.9 * K_B * (np.pi / 2) ** 2
    _, steps = path_of(
        material={"stretch": K_e},
        ends={"right": {"support": "free", "force": [-0.9 * K_e, 0.0]}},
    )
    assert all(step.linearisation.stable for step in steps)


def test_the_imperfect_column_follows_the_buckled_branch(tmp_path):
    critical = critical_load(2.0)
    force = [-1.5 * critical, 1e-3 * 1.5 * critical]
    rows, _, _ = solved(
        tmp_path,
        ends={"right": {"support": "free", "force": force}},
        continuation={"max_step": 0.05, "stops": [0.5, 0.8, 1.0]},
    )
    assert all(row.stable for row in rows)
    for row in rows[1:]:
        guess = 4.0 if row.load == 1.0 else 3.0
        exact = cantilever_with_dead_load(K_E, K_B, 1.0, row.load * np.array(force), guess)
        assert row.energy == pytest.approx(exact.energy, rel=1e-5)
        place = [1 + row.extra["tip_ux"], row.extra["tip_uy"]]
        np.testing.assert_allclose(place, exact.place, atol=1e-5)
        assert row.force == pytest.approx(tuple(row.load * np.array(force)))


def test_the_work_of_the_driven_end_is_the_stored_energy():
    """dE/dt = f·v + m θ' for clamps that move and turn, and for a foundation that resists."""
    right = {"support": "clamped", "translation": [-0.1, 0.2], "rotation": 60.0}
    stops = (0.698, 0.699, 0.7, 0.701, 0.702, 1.0)
    equilibrium, steps = path_of(
        stops, material={"foundation": 1e6}, ends={"right": right}, mesh={"size": 0.1}
    )
    near = {round(step.load, 6): step for step in steps}
    E = [sum(equilibrium.energies(near[t].x, t).values()) for t in (0.698, 0.699, 0.701, 0.702)]
    power = (E[0] - 8 * E[1] + 8 * E[2] - E[3]) / 0.012
    reaction = equilibrium.reactions(near[0.7].x, 0.7)[1]
    work = np.dot(reaction.force, right["translation"]) + reaction.moment * np.radians(60.0)
    assert work == pytest.approx(power, rel=1e-6)
    assert abs(reaction.moment) > 1e5


def test_energy_and_force_scale_with_the_constants(tmp_path):
    """Constants times c: the same shape, force and energy times c."""
    ends = {"right": {"support": "pinned", "translation": [-0.2, 0.3]}}
    rows, _, fields = solved(tmp_path / "1", ends=ends, material={"foundation": 1e5})
    scaled, _, same = solved(
        tmp_path / "2",
        ends=ends,
        material={"stretch": 1e-3 * K_E, "bending": 1e-3 * K_B, "foundation": 1e2},
    )
    np.testing.assert_allclose(same["displacement"], fields["displacement"], atol=1e-7)
    assert scaled[-1].energy == pytest.approx(1e-3 * rows[-1].energy, rel=1e-7)
    assert scaled[-1].force == pytest.approx(tuple(1e-3 * f for f in rows[-1].force), rel=1e-6)


#: (degree, auxiliary degree): limits of the observed order of the energy and of the force.
RATES = {(2, 1): (1.8, 2.2), (3, 2): (3.8, 4.2), (4, 3): (5.7, 6.3)}


@pytest.mark.skipif(SEVERAL, reason="long")
@pytest.mark.parametrize(("degree", "auxiliary"), RATES)
def test_energy_and_force_converge_at_the_expected_rate(tmp_path, degree, auxiliary):
    (exact,) = cantilever_along_an_arc(K_E, K_B, 1.0, [np.radians(60.0)])
    errors = []
    for elements in (64, 128) if degree == 2 else (8, 16):
        rows, _, _ = solved(
            tmp_path / str(elements),
            ends={"right": {"support": "pinned", "rotation": 60.0, "pivot": [0.5, 0.0]}},
            mesh={"size": 1.0 / elements},
            discretisation={"degree": degree, "auxiliary_degree": auxiliary},
            continuation={"max_step": 0.1, "tolerance": 1e-11},
        )
        row = rows[-1]
        errors.append(
            (
                abs(row.energy / exact.energy - 1),
                np.hypot(*(np.array(row.force) - exact.force)) / np.hypot(*exact.force),
            )
        )
    orders = np.log2(np.array(errors[0]) / np.array(errors[1]))
    low, high = RATES[degree, auxiliary]
    assert low < orders.min(), (errors, orders)
    assert orders.max() < high, (errors, orders)


@pytest.mark.parametrize("elements", [64, 256])
def test_a_long_first_step_does_not_end_in_a_fold(tmp_path, elements):
    """On fine meshes Newton's method can find a beam that is folded back on itself at its tip."""
    (exact,) = cantilever_along_an_arc(K_E, K_B, 1.0, [np.radians(3.0)])
    rows, _, fields = solved(
        tmp_path,
        ends={"right": {"support": "pinned", "rotation": 3.0, "pivot": [0.5, 0.0]}},
        mesh={"size": 1.0 / elements},
        continuation={"initial_step": 1.0, "max_step": 1.0},
    )
    assert rows[-1].energy == pytest.approx(exact.energy, rel=1e-6)
    assert np.abs(fields["angle"]).max() < 0.1


def test_elements_that_are_too_long_to_turn_are_refused(tmp_path):
    with pytest.raises(PathError, match="its elements are too long") as error:
        solved(
            tmp_path,
            ends={"right": {"support": "free", "moment": 4 * np.pi * K_B}},
            mesh={"size": 1.0},
            continuation={"max_step": 0.1},
        )
    assert "a finer mesh" in str(error.value)
