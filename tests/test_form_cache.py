"""Forms are compiled once: neither other numbers nor other cases before give them other names."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pantograph_fem.case import case_from_dict, case_to_toml

from .conftest import COARSE, merged

#: As little as there is to solve: what is compiled does not depend on it.
SHORT = {
    "continuation": {"stops": [1e-3], "initial_step": 1e-3},
    "output": {"figures": False, "fields": "none", "probes": [[0.0, 0.0]]},
}
#: A case of each kind, by the numbers in it and by others in all places.
SHEET = merged(COARSE, SHORT) | {
    "sheet": {"width": 0.068, "height": 0.204, "fibre_angle": 45.0},
    # So few elements bear no more: their fibres would cross.
    "grips": {"top": {"translation": [0.0, 0.01]}},
    "mesh": {"size": 0.05, "corner_size": 0.05},
    "discretisation": {"degree": 2, "shear_regularisation": 1e-3},
}
OTHER_SHEET = {
    "sheet": {"width": 0.05, "height": 0.1, "fibre_angle": 30.0},
    "material": {
        "stretch": [1.0e5, 2.0e5],
        "bending": [1.0e-2, 2.0e-2],
        "shear": 2.0e2,
        "shear_exponent": 1.5,
    },
    "grips": {
        "bottom": {"translation": [0.0, -0.004]},
        "top": {"translation": [0.004, 0.008], "pivot": [0.01, 0.02]},
    },
    "mesh": {"size": 0.04, "corner_size": 0.03},
    "discretisation": {"shear_regularisation": 2e-3},
    "continuation": {"stops": [2e-3], "tolerance": 1e-5},
    "output": {"probes": [[0.01, 0.02], [0.03, 0.04]]},
}
CLAMPED = merged(
    SHEET,
    {
        "discretisation": {"scheme": "hinge"},
        "grips": {"bottom": {"hold": "clamp"}, "top": {"hold": "clamp", "rotation": 20.0}},
    },
)
OTHER_CLAMPED = merged(OTHER_SHEET, {"grips": {"top": {"rotation": -30.0}}})
BEAM = SHORT | {
    "name": "beam",
    "kind": "beam",
    "beam": {"length": 1.0},
    "material": {
        "stretch": 4.0e8,
        "bending": 7.0e5,
        "foundation": [{"to": 0.5, "stiffness": 2.0e6}, {"to": 1.0, "stiffness": 1.0e6}],
    },
    "ends": {
        "left": {"support": "clamped", "rotation": 10.0},
        "right": {"support": "free", "force": [1.0e3, 2.0e3], "moment": 1.0e3},
    },
    "mesh": {"size": 0.5},
    "discretisation": {"scheme": "hinge", "degree": 2},
}
OTHER_BEAM = {
    "beam": {"length": 2.0},
    "material": {"stretch": 3.0e8, "bending": 6.0e5, "foundation": 3.0e6},
    "ends": {
        "left": {"translation": [0.01, 0.02], "rotation": -20.0, "pivot": [0.1, 0.2]},
        "right": {"force": [0.0, 3.0e3], "moment": -2.0e3},
    },
    "mesh": {"size": 0.4},
    "continuation": {"stops": [2e-3], "tolerance": 1e-5},
    "output": {"probes": [[1.5, 0.0]]},
}

#: Build the simulations of the cases that are given, one after the other as a study may.
BUILD = """
import sys
from pathlib import Path
from mpi4py import MPI
from pantograph_fem.case import load_case
from pantograph_fem.simulation import build_simulation
from pantograph_fem.stopwatch import Stopwatch
for path in sys.argv[1:]:
    build_simulation(load_case(Path(path)), MPI.COMM_SELF, Stopwatch())
"""


@pytest.fixture
def cache(tmp_path):
    """Count what is compiled in new processes whose cache is empty at first."""
    return Cache(tmp_path)


class Cache:
    def __init__(self, folder: Path):
        self.folder = folder

    def compiled_by_run(self, case):
        (path,) = self._written(case)
        return self._compiled_by("-m", "pantograph_fem", "run", path, "--quiet")

    def compiled_by_building(self, *cases):
        return self._compiled_by("-c", BUILD, *self._written(*cases))

    def _written(self, *cases):
        paths = [self.folder / f"case_{i}.toml" for i in range(len(cases))]
        for path, case in zip(paths, cases, strict=True):
            path.write_text(case_to_toml(case_from_dict(case)))
        return paths

    def _compiled_by(self, *arguments):
        before = self._modules()
        done = subprocess.run(
            [sys.executable, *map(str, arguments)],
            cwd=self.folder,
            env={
                **os.environ,
                "XDG_CACHE_HOME": str(self.folder / "cache"),
                "PYTHONPATH": str(Path(__file__).parents[1]),
            },
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert done.returncode == 0, done.stderr
        return len(self._modules() - before)

    def _modules(self):
        return {path.name for path in (self.folder / "cache" / "fenics").glob("*.so")}


@pytest.mark.parametrize(
    ("case", "others"),
    [
        pytest.param(BEAM, OTHER_BEAM, id="beam"),
        pytest.param(SHEET, OTHER_SHEET, id="sheet", marks=pytest.mark.slow),
        pytest.param(CLAMPED, OTHER_CLAMPED, id="clamped", marks=pytest.mark.slow),
    ],
)
def test_what_one_run_has_compiled_serves_the_next_whatever_its_numbers(cache, case, others):
    assert cache.compiled_by_run(case) > 0
    assert cache.compiled_by_run(case) == 0
    assert cache.compiled_by_run(merged(case, others)) == 0


def test_what_is_compiled_does_not_depend_on_what_the_process_did_before(cache):
    shear = merged(SHEET, {"material": None}) | {"material": {"shear": 1.59e2}}
    stretch = merged(SHEET, {"material": None}) | {"material": {"stretch": 1.34e5}}
    assert cache.compiled_by_building(shear, stretch) > 0
    # Three constants each; cosine and sine of the last have the numbers 9 and 10 of the process.
    assert cache.compiled_by_building(shear, shear, shear, stretch) == 0
