"""What a run left: how it ended and its history."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from ..case import Case, case_to_toml, load_case
from ..errors import CaseError, PathError
from ..results.history import read_history
from .plan import Entry

#: Simulates a case and writes its results to a folder, as `pantograph_fem.running.run` does.
Runner = Callable[[Case, Path], object]

#: Status of a run that reached its full load.
DONE = "done"


@dataclass(frozen=True, eq=False)
class Outcome:
    """A run that is over.

    Attributes
    ----------
    entry
        The run as it was asked for.
    case
        What was simulated.
    status
        "done", or "stopped: " and the reason.
    history
        Columns of ``history.csv``, each of shape (k,).
    """

    entry: Entry
    case: Case
    status: str
    history: dict[str, NDArray[Any]]

    @property
    def done(self) -> bool:
        """Whether the path was followed to its end."""
        return self.status == DONE


def is_finished(directory: Path, case: Case) -> bool:
    """Whether a folder holds the results of exactly this case, followed to its end."""
    resolved, summary = directory / "case.resolved.toml", directory / "summary.json"
    try:
        if resolved.read_text(encoding="utf-8") != case_to_toml(case):
            return False
        ended = summary.stat().st_mtime
        if any(path.stat().st_mtime > ended for path in case.input_files):
            return False
        return _status(summary) == DONE
    except (OSError, UnicodeDecodeError, CaseError):
        return False


def run_entry(entry: Entry, runner: Runner) -> bool:
    """Simulate a run and return whether it reached its end; what it found is kept in any case.

    Raises
    ------
    CaseError
        If the case is wrong in a way that shows only now; the message names the run.
    """
    assert entry.case is not None
    try:
        runner(entry.case, entry.directory)
    except PathError:
        return False
    except CaseError as error:
        raise CaseError(f"{entry.label}: {error}") from error
    return True


def read_outcome(entry: Entry) -> Outcome:
    """Read the results of a run.

    Raises
    ------
    CaseError
        If its folder holds no results, or damaged ones.
    """
    directory = entry.directory
    for name in ("case.resolved.toml", "history.csv", "summary.json"):
        if not (directory / name).is_file():
            raise CaseError(
                f"{directory} holds no results to compare: {name} is missing. "
                "`pantograph run CASE.toml` writes them, summary.json last."
            )
    case = load_case(directory / "case.resolved.toml")
    history = read_history(directory / "history.csv")
    if not len(history["load"]):
        raise CaseError(f"{directory / 'history.csv'} holds no state; run the case again")
    return Outcome(entry, case, _status(directory / "summary.json"), history)


def _status(summary: Path) -> str:
    try:
        status = json.loads(summary.read_text(encoding="utf-8"))["status"]
    except (ValueError, TypeError, KeyError):
        status = None
    if not isinstance(status, str):
        raise CaseError(f"{summary} is damaged: it must give the status; run the case again")
    return status
