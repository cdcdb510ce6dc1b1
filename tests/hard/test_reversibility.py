"""Energy is a function of state: what is loaded and unloaded comes back to rest."""

from dataclasses import replace

import numpy as np
import pytest

from pantograph_fem.case import case_from_dict
from pantograph_fem.lattice.simulation import LatticeSimulation
from pantograph_fem.running import run
from pantograph_fem.sheet.simulation import SheetSimulation
from pantograph_fem.solve.continuation import follow, start_at
from pantograph_fem.solve.step_size import StepSettings
from pantograph_fem.stopwatch import Stopwatch

from ..conftest import COARSE, merged

MOTION = {"top": {"translation": [0.02, 0.03], "rotation": 30.0}, "bottom": {"rotation": -20.0}}


class Unloading:
    """A path from its full load back to rest: fraction s of the way is load 1 - s."""

    def __init__(self, path):
        self.path = path

    def correct(self, guess, way):
        return replace(self.path.correct(guess, 1.0 - way), load=way)

    def linearise(self, x, way):
        state = self.path.linearise(x, 1.0 - way)
        return replace(state, rate=-state.rate)


@pytest.mark.slow
@pytest.mark.parametrize("scheme", ["hinge", "micromorphic"])
def test_a_sheet_comes_back_to_rest_through_the_same_states(scheme):
    from mpi4py import MPI

    case = case_from_dict(
        merged(COARSE, {"grips": MOTION, "discretisation": {"scheme": scheme, "degree": 2}})
    )
    simulation = SheetSimulation(case, MPI.COMM_SELF, Stopwatch())
    comes_back(simulation, lambda x, t: simulation.equilibrium.energies(x, t))


def test_a_lattice_comes_back_to_rest_through_the_same_states():
    from mpi4py import MPI

    changes = {
        "kind": "lattice",
        "grips": MOTION,
        "lattice": {"spacing": 0.0096},
        "mesh": None,
    }
    simulation = LatticeSimulation(
        case_from_dict(merged(COARSE, changes)), MPI.COMM_SELF, Stopwatch()
    )
    comes_back(simulation, lambda x, t: simulation._equilibrium.energies(x, t))


def comes_back(simulation, energies):
    """Energies at the same loads on both ways, and the state at the end of the way back."""

    def energy(x, load):
        return sum(energies(x, load).values())

    loads = (0.2, 0.4, 0.6, 0.8, 1.0)
    there = list(follow(simulation.path, start_at(simulation.start), StepSettings(loads)))
    full = there[-1].linearisation.x
    back = list(follow(Unloading(simulation.path), start_at(full), StepSettings(loads)))
    assert all(step.linearisation.stable for step in (*there, *back))
    peak = energy(full, 1.0)
    on_the_way = {round(1.0 - step.load, 9): step for step in back if step.is_stop}
    for step in there:
        if step.load in loads[:-1]:
            again = on_the_way[step.load].linearisation.x
            assert energy(again, step.load) == pytest.approx(
                energy(step.linearisation.x, step.load), abs=1e-8 * peak
            )
    assert back[-1].load == 1.0
    assert energy(back[-1].linearisation.x, 0.0) < 1e-8 * peak
    assert np.abs(back[-1].linearisation.x - simulation.start).max() < 1e-8 * np.abs(full).max()


@pytest.mark.parametrize("kind", ["beam", "chain"])
def test_a_beam_whose_tip_runs_round_a_circle_comes_back_to_rest(tmp_path, kind):
    """Loading and unloading in one case file: the tip is back where it began."""
    data = {
        "name": "loop",
        "kind": kind,
        "beam": {"length": 1.0},
        "material": {"stretch": 4.05e8, "bending": 7.59e5},
        "ends": {"right": {"support": "pinned", "rotation": -360.0, "pivot": [0.85, 0.0]}},
        "output": {"figures": False, "fields": "none"},
    }
    data |= {"chain": {"spacing": 0.05}} if kind == "chain" else {"mesh": {"size": 0.1}}
    rows = run(case_from_dict(data), tmp_path, quiet=True).rows
    assert all(row.stable for row in rows)
    peak = max(row.energy for row in rows)
    assert peak > 1e4
    assert rows[-1].energy < 1e-8 * peak
    assert np.hypot(*rows[-1].force) < 1e-6 * max(np.hypot(*row.force) for row in rows)
