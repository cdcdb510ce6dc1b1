"""One run in a process of its own, whose CPU time is that of the run and of nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..case import Case, case_to_toml
from ..errors import CaseError
from ..results.atomic import replace_text


@dataclass(frozen=True)
class Ended:
    """How a run ended.

    Attributes
    ----------
    code
        Exit code of ``pantograph run``: 0, 2 or 3 as in `pantograph_fem.errors`, and anything
        else for a crash; negative for a signal.
    cpu_seconds
        User and system time of the process and of those that it started.
    message
        What it wrote to standard error.
    """

    code: int
    cpu_seconds: float
    message: str = ""


#: Simulates a case, leaves its results in a folder, and says how it ended.
Runner = Callable[[Case, Path], Ended]


def run_in_process(case: Case, directory: Path) -> Ended:
    """Run ``pantograph run`` on a case; it is left as ``case.toml`` beside the results.

    Raises
    ------
    CaseError
        If the folder cannot be written to.
    """
    command = command_of(case, directory)
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            command,
            # Python's view of it: MPI, where it is loaded, has added to what C sees.
            env=dict(os.environ),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=errors,
        )
        try:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        except BaseException:
            process.kill()
            process.wait()
            raise
        errors.seek(0)
        message = errors.read().decode(errors="replace").strip()
    return Ended(process.returncode, usage.ru_utime + usage.ru_stime, message)


def command_of(case: Case, directory: Path) -> list[str]:
    """The command that runs a case, which is left as ``case.toml`` beside the results.

    Raises
    ------
    CaseError
        If the folder cannot be written to.
    """
    case_file = directory / "case.toml"
    try:
        directory.mkdir(parents=True, exist_ok=True)
        replace_text(case_file, case_to_toml(case))
    except OSError as error:
        raise CaseError(
            f"--output: {directory} cannot hold results: {error.strerror}; give another folder"
        ) from None
    program = [sys.executable, "-m", "pantograph_fem", "run", str(case_file)]
    return [*program, "--output", str(directory), "--quiet"]
