"""Small sheets that tests share."""

import copy
import itertools
import json
import os
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

# How long a test takes says nothing of the program.
settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT", "1")
os.environ.setdefault("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "1")
# Two processes also where there is one core, by Open MPI 4 and 5.
os.environ.setdefault("OMPI_MCA_rmaps_base_oversubscribe", "1")
os.environ.setdefault("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe")

# PETSc of a wheel finds the MPI that comes beside it once that is loaded.
from mpi4py import MPI  # noqa: E402

pytest_plugins = ("tests.processes",)

#: Two processes of the MPI that the interpreter has: a wheel brings its own.
_BESIDE = Path(sys.executable).with_name("mpiexec")
MPIRUN = (str(_BESIDE) if _BESIDE.exists() else "mpirun", "-n", "2")

#: Case a on a mesh that is too coarse to be accurate and fine enough to be exact mechanics.
COARSE = {
    "name": "coarse",
    "kind": "sheet",
    "sheet": {"width": 0.068, "height": 0.204},
    "material": {
        "stretch": 1.34e5,
        "bending": 1.92e-2,
        "shear": 1.59e2,
        "shear_exponent": 1.36,
    },
    "grips": {"top": {"translation": [0.0, 0.03]}},
    "mesh": {"size": 0.02, "corner_size": 0.01},
}


@pytest.fixture(scope="session")
def tmp_path_factory(tmp_path_factory):
    """Makes folders, also those of `tmp_path`, that are the same for all processes."""
    from .processes import WORLD

    make = tmp_path_factory.mktemp
    tmp_path_factory.mktemp = lambda *args, **options: WORLD.bcast(make(*args, **options))
    return tmp_path_factory


def run(case, directory=None, **options):
    """Run a case as the program does, and have its rows on every process."""
    from pantograph_fem.running import run

    from .processes import WORLD

    result = run(case, directory, **options)
    return replace(result, rows=WORLD.bcast(result.rows))


def merged(base, changes):
    """A copy of nested tables with some values replaced; None removes a key."""
    result = copy.deepcopy(base)
    for key, value in changes.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        else:
            result[key] = value
    return result


@pytest.fixture
def coarse_case():
    """Make a variant of the coarse case from nested changes."""
    from pantograph_fem.case import case_from_dict

    return lambda **changes: case_from_dict(merged(COARSE, changes))


@pytest.fixture
def coarse_path(coarse_case):
    """Follow the path of a variant; returns the equilibrium and its accepted steps."""
    from pantograph_fem.sheet.simulation import SheetSimulation
    from pantograph_fem.solve.continuation import follow, start_at
    from pantograph_fem.solve.step_size import StepSettings
    from pantograph_fem.stopwatch import Stopwatch

    def path(stops=(1.0,), max_step=0.25, **changes):
        simulation = SheetSimulation(coarse_case(**changes), MPI.COMM_WORLD, Stopwatch())
        settings = StepSettings(stops=stops, max_step=max_step)
        return simulation, list(follow(simulation.path, start_at(simulation.start), settings))

    return path


@dataclass(frozen=True)
class Solved:
    """What a run left: its rows, and the last state's fields on the nodes X of the output grid."""

    directory: Path
    rows: tuple[Any, ...]
    X: Any
    fields: dict[str, Any]

    @property
    def last(self):
        return self.rows[-1]

    @property
    def displacement(self):
        return self.fields["displacement"]

    @property
    def summary(self):
        return json.loads((self.directory / "summary.json").read_text())


@pytest.fixture(scope="session")
def solve(tmp_path_factory):
    """Run a variant of the coarse case with quadratic displacements, from case to results."""
    from pantograph_fem.case import case_from_dict
    from pantograph_fem.results.fields import read_fields

    base = merged(
        COARSE,
        {"discretisation": {"degree": 2}, "output": {"figures": False, "fields": "stops"}},
    )
    folder, numbers = tmp_path_factory.mktemp("solved"), itertools.count()

    def solved(**changes):
        case = case_from_dict(merged(base, changes))
        result = run(case, folder / str(next(numbers)), quiet=True)
        states = read_fields(result.directory)
        return Solved(result.directory, result.rows, states.grid.points, states.fields(-1))

    return solved
