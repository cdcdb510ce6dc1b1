"""The command ``pantograph compare`` from start to end: plan → runs → comparison → files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import CaseError, PathError
from .comparison import Comparison, compare_outcomes
from .convergence_figure import draw_convergence
from .curves_figure import draw_curves
from .files import write_tables
from .outcome import Runner, is_finished, read_outcome, run_entry
from .plan import make_plan


@dataclass(frozen=True, eq=False)
class CompareResult:
    """Outcome of a comparison.

    Attributes
    ----------
    comparison
        The runs side by side.
    directory
        Where its files go.
    stopped
        Labels of the runs that were made now and did not reach their end.
    """

    comparison: Comparison
    directory: Path
    stopped: tuple[str, ...]

    def stopped_error(self) -> PathError:
        """Say how far the runs in `stopped` came, and why not further."""
        lines = [
            f"  {run.entry.label}: {run.status.removeprefix('stopped: ')}"
            for run in self.comparison.outcomes
            if run.entry.label in self.stopped
        ]
        head = "Runs that stopped before their end are compared with what they reached:"
        return PathError("\n".join([head, *lines]))


def compare(
    what: Sequence[Path],
    output: Path | None = None,
    *,
    overrides: Sequence[str] = (),
    rerun: bool = False,
    runner: Callable[[], Runner] | None = None,
    tell: Callable[[str], None] = lambda text: None,
) -> CompareResult:
    """Run what has to be run, and compare all; `write` then makes the files.

    A case is not run again when its folder holds a finished result of exactly this case. A run
    that is stopped on its way is compared with what it reached. A collective call where a case is
    run.

    Parameters
    ----------
    what
        Folders of results, case files, and at most one study file.
    output
        Where the comparison and the runs go; ``results/<name of the study>`` or
        ``results/compare`` by default.
    overrides
        Values in place of those of every case that is run, each as ``key.path=value``.
    rerun
        Run every case again.
    runner
        Gives what simulates a case, `pantograph_fem.running.run` by default; called only if there
        is one to simulate.
    tell
        Called with a line before each run.

    Raises
    ------
    CaseError
        If anything given is wrong.
    """
    plan = make_plan(what, output, overrides)
    to_run = [
        entry
        for entry in plan.entries
        if entry.case is not None and (rerun or not is_finished(entry.directory, entry.case))
    ]
    for entry in plan.entries:
        if entry.case is None:
            read_outcome(entry)  # what is given and wrong is refused before anything is run
    simulate = (runner or _quiet_runner)() if to_run else None
    stopped = []
    for entry in to_run:
        assert simulate is not None
        tell(f"Running {entry.label} in {entry.directory}")
        if not run_entry(entry, simulate):
            stopped.append(entry.label)
    outcomes = [read_outcome(entry) for entry in plan.entries]
    return CompareResult(compare_outcomes(outcomes, plan.study), plan.directory, tuple(stopped))


def write(comparison: Comparison, directory: Path) -> list[Path]:
    """Write the tables and figures of a comparison and return their paths.

    Raises
    ------
    CaseError
        If the folder cannot be made.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CaseError(
            f"--output: {directory} cannot be made: {error.strerror}; give another"
        ) from None
    paths = write_tables(comparison, directory)
    curves, convergence = directory / "curves.png", directory / "convergence.png"
    draw_curves(comparison, curves)
    drawn = draw_convergence(comparison, convergence)
    return [*paths, curves, *([convergence] if drawn else [])]


def _quiet_runner() -> Runner:
    from ..running import run  # dolfinx is imported only for a case that must be run

    return lambda case, directory: run(case, directory, quiet=True)
