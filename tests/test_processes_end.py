"""Commands on several processes end together, with one exit code, whatever goes wrong where."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import tomli_w

from .conftest import COARSE, MPIRUN, merged

pytestmark = pytest.mark.slow

SMALL = merged(
    COARSE,
    {
        "discretisation": {"scheme": "hinge", "degree": 2},
        "output": {"figures": False, "fields": "none"},
    },
)
#: The command, in which one function fails in one process when it is called for the third time.
DRIVER = """
import importlib, itertools, sys
from mpi4py import MPI
from pantograph_fem import errors
from pantograph_fem.cli import main

rank, place, error, *sys.argv[1:] = sys.argv[1:]
module, owner, name = place.split(":")
owner = getattr(importlib.import_module(module), owner)
whole, calls = getattr(owner, name), itertools.count(1)

def broken(*arguments, **options):
    if MPI.COMM_WORLD.rank == int(rank) and next(calls) == 3:
        raise eval(error)
    return whole(*arguments, **options)

setattr(owner, name, broken)
main()
"""
ASSEMBLY = "pantograph_fem.continuum.equilibrium:ContinuumEquilibrium:residual"
HISTORY = "pantograph_fem.results.history:HistoryWriter:write"


def on_two(*arguments, cwd, timeout=120):
    """Python on two processes, which have to end in seconds."""
    return subprocess.run(
        [*MPIRUN, sys.executable, *map(str, arguments)],
        cwd=cwd,
        env=dict(os.environ),
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )


def ended(folder, *arguments):
    """The command on two processes; forms are compiled before."""
    (folder / "case.toml").write_text(tomli_w.dumps(SMALL))
    return on_two("-c", DRIVER, *arguments, "run", "case.toml", "--quiet", cwd=folder)


@pytest.mark.parametrize(
    ("rank", "place", "error", "code", "said"),
    [
        (0, ASSEMBLY, "MemoryError('too large')", 1, "too large"),
        (1, ASSEMBLY, "MemoryError('too large')", 1, "too large"),
        (1, ASSEMBLY, "errors.CaseError('too odd')", 2, "Process 1 alone: too odd"),
        (0, HISTORY, "OSError(28, 'No space left on device')", 1, "No space left on device"),
    ],
)
def test_an_error_in_one_process_ends_both(tmp_path, rank, place, error, code, said):
    done = ended(tmp_path, rank, place, error)
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    assert done.stderr.count(said) == 1
    assert not (tmp_path / "results" / "coarse" / "summary.json").exists()


def test_without_an_error_both_come_to_the_end(tmp_path):
    done = ended(tmp_path, 2, ASSEMBLY, "None")
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    files = {path.name for path in (tmp_path / "results" / "coarse").iterdir()}
    assert files == {"case.resolved.toml", "checkpoint.npz", "history.csv", "summary.json"}


@pytest.mark.parametrize("command", ["identify", "sweep", "study", "stress"])
def test_commands_that_start_processes_themselves_refuse_mpirun(tmp_path, command):
    (tmp_path / "case.toml").write_text(tomli_w.dumps(SMALL))
    arguments = [] if command == "stress" else ["case.toml"]
    done = on_two("-m", "pantograph_fem", command, *arguments, cwd=tmp_path, timeout=60)
    assert done.returncode == 2
    assert done.stderr.count("leave mpirun out") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]


def test_a_test_that_fails_in_one_process_fails_in_both(tmp_path):
    """What tests/processes.py is for."""
    (tmp_path / "test_here.py").write_text(
        "import pytest\n"
        "from mpi4py import MPI\n"
        "pytestmark = pytest.mark.core\n"
        "def test_in_one():\n"
        "    assert MPI.COMM_WORLD.rank == 0, 'not this one'\n"
        "def test_in_both():\n"
        "    assert MPI.COMM_WORLD.allreduce(1) == 2\n"
        "def test_for_one_process(capsys):\n"
        "    assert False\n"
    )
    options = ("-p", "tests.processes", "--color=no")
    done = on_two("-m", "pytest", *options, tmp_path, cwd=Path(__file__).parents[1])
    assert done.returncode == 1
    assert done.stdout.count("1 failed, 1 passed, 1 deselected") == 1, done.stdout + done.stderr
    assert "process 1" in done.stdout
    assert "not this one" in done.stdout
