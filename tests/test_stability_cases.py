"""Critical loads, branches and limit points of beams, sheets and lattices, from case to results."""

import json

import numpy as np
import pytest
from scipy.optimize import minimize_scalar, root

from mpi4py import MPI

from pantograph_fem.beam.simulation import BeamSimulation
from pantograph_fem.case import case_from_dict
from pantograph_fem.results.fields import read_fields
from pantograph_fem.results.history import read_history
from pantograph_fem.results.progress import Progress
from pantograph_fem.solve.continuation import start_at
from pantograph_fem.stopwatch import Stopwatch

from .conftest import COARSE, merged, run
from .exact_beam import cantilever, cantilever_with_dead_load
from .processes import SEVERAL

pytestmark = pytest.mark.core

K_E, K_B = 4.05e8, 7.59e5

#: A cantilever under a dead load along its axis.
COLUMN = {
    "name": "column",
    "kind": "beam",
    "beam": {"length": 1.0},
    "material": {"stretch": K_E, "bending": K_B},
    "ends": {"right": {"support": "free"}},
    "output": {"figures": False},
}


def critical_load(mu, K_e=K_E):
    """N_cr = (K_e/2)(1 - sqrt(1 - 4 K_b k²/K_e)), k = π/(μL): of the extensible column."""
    return K_e / 2 * (1 - np.sqrt(1 - 4 * K_B * (np.pi / mu) ** 2 / K_e))


def solved(folder, base, **changes):
    result = run(case_from_dict(merged(base, changes)), folder, quiet=True)
    return result.rows, json.loads((folder / "summary.json").read_text())


@pytest.mark.parametrize("method", ["load", "arc_length"])
@pytest.mark.parametrize(
    ("left", "right", "mu"), [("clamped", "free", 2.0), ("pinned", "roller", 1.0)]
)
def test_a_column_stops_at_its_critical_load(tmp_path, method, left, right, mu):
    critical = critical_load(mu)
    rows, summary = solved(
        tmp_path,
        COLUMN,
        ends={
            "left": {"support": left},
            "right": {"support": right, "force": [-1.7 * critical, 0]},
        },
        continuation={"on_instability": "stop", "method": method},
        output={"eigenvalues": True},
    )
    assert summary["status"] == "stopped at a critical load"
    (found,) = summary["critical_points"]
    last = rows[-1]
    assert found == {"step": last.step, "load": last.load, "kind": "bifurcation", "modes": 1}
    assert 1.7 * rows[-1].load == pytest.approx(1.0, rel=1e-5)
    assert abs(rows[-1].extra["lowest_eigenvalue"]) < 1e-6
    # The mode is a quarter or a half of a sine wave, of which the largest displacement is 1.
    states = read_fields(tmp_path)
    mode, S = states.fields(-1)["mode"], states.grid.points[:, 0]
    shape = 1 - np.cos(np.pi * S / 2) if mu == 2.0 else np.sin(np.pi * S)
    np.testing.assert_allclose(mode[:, 0], 0.0, atol=1e-6)
    np.testing.assert_allclose(np.abs(mode[:, 1]), shape, atol=1e-5)


@pytest.mark.parametrize("method", ["load", "arc_length"])
def test_a_perfect_column_is_followed_onto_its_buckled_branch(tmp_path, method):
    force = np.array([-1.5 * critical_load(2.0), 0.0])
    rows, summary = solved(
        tmp_path,
        COLUMN,
        ends={"right": {"force": force.tolist()}},
        continuation={"stops": [0.75, 1.0], "on_instability": "branch", "method": method},
    )
    assert summary["status"] == "done"
    assert all(row.stable for row in rows)
    for row in rows:
        if row.load not in (0.75, 1.0):
            continue
        side = np.sign(row.extra["tip_uy"])
        exact = cantilever_with_dead_load(K_E, K_B, 1.0, row.load * force, 4.0 * row.load)
        assert row.energy == pytest.approx(exact.energy, rel=1e-6)
        place = [1 + row.extra["tip_ux"], side * row.extra["tip_uy"]]
        np.testing.assert_allclose(place, exact.place, atol=1e-6)


@pytest.mark.skipif(SEVERAL, reason="long")
@pytest.mark.parametrize("method", ["load", "arc_length"])
def test_a_straight_column_passes_four_critical_loads_each_with_its_mode(tmp_path, method):
    """Stiff enough that the loads are some nine tenths of Euler's even in the fourth mode."""
    K_e = 100 * K_E
    exact = np.array([critical_load(2.0 / (2 * n - 1), K_e) for n in (1, 2, 3, 4)])
    full = 60.0 * exact[0]
    rows, summary = solved(
        tmp_path,
        COLUMN,
        material={"stretch": K_e},
        ends={"right": {"force": [-full, 0.0]}},
        continuation={"method": method},
        output={"eigenvalues": True},
    )
    points = summary["critical_points"]
    assert [point["kind"] for point in points] == ["bifurcation"] * 4
    np.testing.assert_allclose([point["load"] for point in points], exact / full, rtol=2e-5)
    row_of = {row.step: row for row in rows}
    states = read_fields(tmp_path)
    S = states.grid.points[:, 0]
    for n, point in enumerate(points):
        excess = row_of[point["step"]].negative_pivots
        excess -= row_of[point["step"]].expected_negative_pivots
        assert excess == n
        mode = states.fields(point["step"])["mode"][:, 1]
        shape = 1 - np.cos((n + 0.5) * np.pi * S)
        np.testing.assert_allclose(np.abs(mode), shape / shape.max(), atol=1e-3)
    lowest = [row.extra["lowest_eigenvalue"] for row in rows]
    # the first mode resists less and less, whichever else is critical
    assert (np.diff(lowest) < 1e-12).all()


def test_inertia_and_the_lowest_eigenvalue_agree_through_the_first_two_buckling_loads():
    """A saddle point: most negative pivots belong to constraints, the eigenvalues do not."""
    case = case_from_dict(
        merged(
            COLUMN,
            {
                "ends": {"right": {"force": [-1.0, 0.0]}},
                "mesh": {"size": 0.1},
                "output": {"eigenvalues": True},
            },
        )
    )
    simulation = BeamSimulation(case, MPI.COMM_WORLD, Stopwatch())
    path, x = simulation.path, start_at(simulation.start).points[0].x
    first, second = critical_load(2.0), critical_load(2.0 / 3.0)
    for force in [*np.linspace(0.0, 1.3, 14)[1:] * first, 0.9999 * first, 1.0001 * first, second]:
        for factor in (0.999, 1.001) if force == second else (1.0,):
            found = path.correct(x, factor * force)
            assert found.converged
            state = path.linearise(found.x, factor * force)
            excess = state.negative_pivots - state.expected_negative_pivots
            assert excess == sum(factor * force > critical for critical in (first, second))
            assert (state.lowest.eigenvalue > 0) == state.stable == (excess == 0)


def test_the_eigenvalue_depends_neither_on_mesh_nor_on_units(tmp_path):
    """Without load, μ of a cantilever is (1.8751)⁴ K_b/(K_e L²), with K_e L the typical energy.

    Nodes at the ends weigh a little too much, in proportion to the size of the elements.
    """
    values = []
    for number, (size, c) in enumerate([(0.1, 1.0), (0.0125, 1.0), (0.1, 1e-6)]):
        rows, _ = solved(
            tmp_path / str(number),
            COLUMN,
            material={"stretch": c * K_E, "bending": c * K_B},
            ends={"right": {"force": [c * 1e3, 0.0]}},
            mesh={"size": size},
            output={"eigenvalues": True, "fields": "none"},
        )
        values.append(rows[0].extra["lowest_eigenvalue"])
        history = read_history(tmp_path / str(number) / "history.csv")
        assert history["lowest_eigenvalue"][0] == values[-1]
    exact = K_B / K_E * 1.8751041**4
    assert values[0] == pytest.approx(exact, rel=0.1)
    assert values[1] == pytest.approx(exact, rel=0.1 / 8)
    assert values[2] == pytest.approx(values[0], rel=1e-6)


#: Upright fibres, pressed along them.
UPRIGHT = merged(
    COARSE,
    {
        "sheet": {"fibre_angle": 0.0},
        "material": {"bending": 10.0, "shear_exponent": None},
        "discretisation": {"degree": 2},
        "output": {"figures": False, "fields": "none"},
    },
)


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["micromorphic", "hinge"])
@pytest.mark.parametrize("method", ["load", "arc_length"])
def test_upright_fibres_sway_at_their_buckling_load_and_stay_stable_beyond(
    tmp_path, scheme, method
):
    """As in test_sheet_physics: N λ = K_b k² + K_p. Beyond, the force hardly rises."""
    H, W = 0.204, 0.068
    resistance = 10.0 * (np.pi / H) ** 2 + 1.59e2
    critical = H * (1 - np.sqrt(1 - 4 * resistance / 1.34e5)) / 2
    rows, summary = solved(
        tmp_path,
        UPRIGHT,
        discretisation={"scheme": scheme},
        grips={"top": {"translation": [0.0, -1.3 * critical]}},
        continuation={"on_instability": "branch", "method": method},
    )
    (found,) = summary["critical_points"]
    assert found["kind"] == "bifurcation"
    assert 1.3 * found["load"] == pytest.approx(1.0, rel=2e-2)
    assert all(row.stable for row in rows)
    at = next(row.force[1] for row in rows if row.step == found["step"])
    assert at == pytest.approx(-W * 1.34e5 * critical / H, rel=2e-2)
    assert rows[-1].force[1] == pytest.approx(at, rel=1e-2)


def test_a_rod_with_a_turning_clamp_snaps_at_the_limit_point_of_the_elastica(tmp_path):
    """The limit load of the boundary value problem: its largest over all root curvatures."""
    turn, way = np.radians(360.0), 0.5
    rows, summary = solved(
        tmp_path,
        COLUMN,
        ends={
            "left": {"support": "clamped", "rotation": 360.0},
            "right": {"support": "pinned", "translation": [-way, 0.0]},
        },
        continuation={"on_instability": "stop", "method": "arc_length"},
    )
    (found,) = summary["critical_points"]
    assert found["kind"] == "limit point"
    unit = 20.0 * K_B
    guess = [*(turned(np.array(rows[-1].force), -turn * found["load"]) / unit), found["load"]]

    def load_with(curvature):
        def misfit(unknowns):
            end = cantilever(K_E, K_B, 1.0, unit * np.array(unknowns[:2]), curvature)
            pin = turned(np.array([1.0 - way * unknowns[2], 0.0]), -turn * unknowns[2])
            return [*(end.place - pin), end.moment / K_B]

        solution = root(misfit, guess, tol=1e-10).x
        assert np.abs(misfit(solution)).max() < 1e-8
        return solution[2]

    at = read_fields(tmp_path).fields(-1)["curvature"][0]
    best = minimize_scalar(lambda k: -load_with(k), bounds=(at - 0.2, at + 0.2), method="bounded")
    assert abs(best.x - at) < 0.1
    assert found["load"] == pytest.approx(-best.fun, rel=1e-6)


def turned(vector, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def test_a_chain_of_springs_buckles_as_a_beam_and_is_followed_beyond(tmp_path):
    critical = critical_load(2.0)
    rows, summary = solved(
        tmp_path,
        merged(COLUMN, {"kind": "chain", "beam": COLUMN["beam"], "chain": {"spacing": 0.02}}),
        ends={"right": {"force": [-1.5 * critical, 0.0]}},
        continuation={"on_instability": "branch"},
    )
    (found,) = summary["critical_points"]
    # the closed form of the chain is in test_lattice_equilibrium
    angle = np.pi / (2 * 50)
    k, b = K_E / 0.02, K_B / 0.02
    exact = k / 2 * (0.02 - np.sqrt(0.02**2 - 8 * b * (1 - np.cos(angle)) / k))
    assert 1.5 * found["load"] * critical == pytest.approx(exact, rel=1e-5)
    assert all(row.stable for row in rows)
    assert abs(rows[-1].extra["tip_uy"]) > 0.5
    assert np.isclose(np.abs(read_fields(tmp_path).fields(found["step"])["mode"]).max(), 1.0)


@pytest.mark.parametrize("method", ["load", "arc_length"])
def test_a_run_taken_up_behind_its_critical_point_is_the_same_run(tmp_path, method):
    changes = {
        "ends": {"right": {"force": [-1.5 * critical_load(2.0), 0.0]}},
        "mesh": {"size": 0.1},
        "continuation": {"on_instability": "branch", "method": method},
    }
    case = case_from_dict(merged(COLUMN, changes))
    run(case, tmp_path, quiet=True)
    whole = read_history(tmp_path / "history.csv")
    points = json.loads((tmp_path / "summary.json").read_text())["critical_points"]
    interrupt(case, tmp_path, after=int(0.7 * len(whole["load"])))
    run(case, tmp_path, resume=True, quiet=True)
    again = read_history(tmp_path / "history.csv")
    np.testing.assert_allclose(again["load"], whole["load"], rtol=1e-9)
    np.testing.assert_allclose(again["force_x"], whole["force_x"], rtol=1e-9)
    kept = json.loads((tmp_path / "summary.json").read_text())["critical_points"]
    assert kept == points
    assert len(points) == 1


#: To twelve times its critical load on the straight path: two modes are lost.
ON_AND_ON = merged(
    COLUMN,
    {
        "ends": {"right": {"force": [-12.0 * critical_load(2.0), 0.0]}},
        "mesh": {"size": 0.1},
        "output": {"fields": "none"},
    },
)


@pytest.fixture(scope="module")
def on_and_on(tmp_path_factory):
    """Critical points of the same run without an interruption."""
    return solved(tmp_path_factory.mktemp("whole"), ON_AND_ON)[1]["critical_points"]


@pytest.mark.parametrize("behind", [0, 1, 2])
def test_critical_points_found_before_an_interruption_are_kept_and_none_is_doubled(
    tmp_path, on_and_on, behind
):
    """It dies so many states behind the second point: that may have to be found again."""
    assert len(on_and_on) == 2
    case = case_from_dict(ON_AND_ON)
    interrupt(case, tmp_path, after=on_and_on[1]["step"] + behind)
    run(case, tmp_path, resume=True, quiet=True)
    points = json.loads((tmp_path / "summary.json").read_text())["critical_points"]
    assert [point["step"] for point in points] == [point["step"] for point in on_and_on]
    loads = [point["load"] for point in points]
    np.testing.assert_allclose(loads, [point["load"] for point in on_and_on], rtol=1e-6)


def interrupt(case, folder, after):
    """Run it until it has written so many states and dies at the next."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Progress, "accepted", _Interrupted(after))
        with pytest.raises(KeyboardInterrupt):
            run(case, folder, quiet=True)


class _Interrupted:
    def __init__(self, after):
        self.left = after

    def __call__(self, row, elapsed):
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt
