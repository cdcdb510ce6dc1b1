"""The command ``pantograph sweep`` from start to end: plan → runs → table, indices, figures."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..case.problem import not_allowed
from ..errors import CaseError
from ..study.process import Runner
from .indices_figure import draw_indices
from .plan import Plan, make_plan
from .processes import Processes
from .progress import SweepProgress
from .results import PointResult, read_result
from .runs import run_points
from .sensitivity import Indices, sensitivity, write_indices
from .sweep_figure import draw_sweep
from .table import write_csv, write_parquet


@dataclass(frozen=True, eq=False)
class SweepResult:
    """Outcome of a sweep.

    Attributes
    ----------
    plan
        What was run.
    points
        What became of each point.
    indices
        Sensitivity indices, of designs that have them.
    notes
        Why there are none, or not of all samples.
    runs
        Number of points that were run now.
    """

    plan: Plan
    points: tuple[PointResult, ...]
    indices: tuple[Indices, ...] = ()
    notes: tuple[str, ...] = ()
    runs: int = 0


def sweep(
    study_file: Path,
    output: Path | None = None,
    *,
    overrides: Sequence[str] = (),
    jobs: int | None = None,
    rerun: bool = False,
    runner: Runner | None = None,
    quiet: bool = True,
) -> SweepResult:
    """Run a case at many values of its keys; `write` then makes the files.

    Points that are over are not run again, so that a sweep that was interrupted, or that gets
    more points, goes on. A point that stops, crashes or is no valid case is kept as such.

    Parameters
    ----------
    study_file
        TOML file of the sweep, see `SweepStudy`.
    output
        Where the sweep and its runs go; ``results/<name of the file>`` by default.
    overrides
        Values in place of those of the case, each as ``key.path=value``.
    jobs
        Number of runs side by side, each of one thread; that of the cores by default.
    rerun
        Run all points again.
    runner
        Simulates a case, in a process of its own by default; called from several threads.
    quiet
        Show no progress.

    Raises
    ------
    CaseError
        If anything given is wrong, or a folder cannot be written to.
    """
    if jobs is not None and jobs < 1:
        raise CaseError(f"--jobs: {not_allowed(jobs, 'be 1 or greater')}")
    plan = make_plan(study_file, output, overrides)
    study, directory = plan.study, plan.directory
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CaseError(
            f"--output: {directory} cannot be made: {error.strerror}; give another folder"
        ) from None
    keys = tuple(vary.key for vary in study.vary)
    progress = SweepProgress(study.title or study.name, keys, quiet=quiet)
    with Processes() as processes, progress:
        runs = run_points(
            plan,
            runner or processes,
            processes.end,
            progress,
            jobs=jobs or len(os.sched_getaffinity(0)),
            rerun=rerun,
        )
    points = tuple(read_result(plan, point) for point in plan.points)
    indices, notes = sensitivity(plan, points)
    return SweepResult(plan, points, indices, notes, runs)


def write(result: SweepResult) -> list[Path]:
    """Write the tables and figures of a sweep and return their paths."""
    directory = result.plan.directory
    names = ("sweep.csv", "sweep.parquet", "indices.csv", "sweep.png", "indices.png")
    table, parquet, indices, picture, effects = (directory / name for name in names)
    write_csv(result, table)
    draw_sweep(result, picture)
    made = {
        parquet: write_parquet(result, parquet),
        indices: write_indices(result.indices, result.plan.study.design, indices),
        effects: draw_indices(result, effects),
    }
    return [table, picture, *(path for path, is_there in made.items() if is_there)]
