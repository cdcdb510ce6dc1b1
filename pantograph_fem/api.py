"""The package as a library: run a case, read the results of one."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .case import Case, case_from_dict, load_case
from .errors import CaseError, PathError
from .results.result import Result

if TYPE_CHECKING:
    from mpi4py import MPI


def run(
    case: str | os.PathLike[str] | Mapping[str, Any] | Case,
    output: str | os.PathLike[str] | None = None,
    *,
    resume: bool = False,
    quiet: bool = True,
    set: Sequence[str] = (),
    comm: MPI.Comm | None = None,
) -> Result:
    """Simulate a case, write its results to a folder and return them; a collective call.

    It does what ``pantograph run`` does. The matrices are small: set ``OMP_NUM_THREADS=1`` before
    numpy is imported, as more threads make it slower.

    Parameters
    ----------
    case
        Path of a case file, or its tables as nested mappings, or a case.
    output
        Folder of the results, ``results/<name>`` by default. Earlier results there are replaced.
    resume
        Go on from the last state of an interrupted run in that folder, if there is one.
    quiet
        Show no progress.
    set
        Values in place of those of the case, each as ``key.path=value``, as on the command line.
    comm
        MPI communicator; all processes by default.

    Returns
    -------
    Result
        What is in the folder.

    Raises
    ------
    CaseError
        If the case is wrong, or the folder cannot be written to. The message lists every problem:
        its key, its value and what is allowed.
    PathError
        If the path could not be followed to its end. Its `result` holds what was found before.
    ResultsError
        If a file could not be written on the way, as on a full disk.
    """
    checked = _checked(case, set)
    from .commands.solver import solver  # only for a case that is right, as it takes seconds

    simulate = solver()
    directory = Path("results") / checked.name if output is None else Path(output)
    try:
        simulate(checked, directory, resume=resume, quiet=quiet, comm=comm)
    except PathError as error:
        error.result = Result(directory)
        raise
    return Result(directory)


def read(directory: str | os.PathLike[str]) -> Result:
    """The results of an earlier run, finished or not.

    Parameters
    ----------
    directory
        Folder that a run has written.

    Raises
    ------
    CaseError
        If it holds no results.
    """
    path = Path(directory)
    if not (path / "history.csv").is_file():
        raise CaseError(
            f"{path} holds no results: history.csv is missing. "
            "`pantograph_fem.run` and `pantograph run CASE.toml` write them."
        )
    return Result(path)


def _checked(
    case: str | os.PathLike[str] | Mapping[str, Any] | Case, overrides: Sequence[str]
) -> Case:
    if isinstance(overrides, str):
        raise CaseError(f'set: {overrides!r} must be a list of texts "key.path=value"')
    if isinstance(case, Case):
        if not overrides:
            return case
        case = case.model_dump(mode="json", exclude_none=True)
    if isinstance(case, Mapping):
        return case_from_dict(case, overrides=overrides)
    return load_case(Path(case), overrides)
