"""The command ``pantograph study`` from start to end: plan → runs → errors → files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..case import load_case
from ..case.problem import not_allowed
from ..errors import CaseError, PantographError, PathError
from .accuracy import Accuracy, assess
from .files import write_table
from .knobs_figure import draw_knobs
from .measurement import Measurement, measure, read
from .plan import Plan, Wanted, make_plan
from .process import Runner, run_in_process
from .variant import Variant
from .work_precision_figure import draw_work_precision

#: Sections in which a result may differ from another that it is the reference of.
_MAY_DIFFER = {"name", "title", "mesh", "discretisation", "lattice", "chain"}
_MAY_DIFFER |= {"continuation", "output"}


@dataclass(frozen=True, eq=False)
class StudyResult:
    """Outcome of a study.

    Attributes
    ----------
    plan
        What was run.
    runs
        Every run: the matrix, the case as it is and with each value of each varied key, and the
        reference.
    accuracy
        Their errors.
    """

    plan: Plan
    runs: tuple[Measurement, ...]
    accuracy: Accuracy

    @property
    def matrix(self) -> range:
        """Numbers of the runs in the matrix."""
        return range(len(self.plan.matrix))

    @property
    def default(self) -> int | None:
        """Number of the case as it is; None when no key is varied."""
        return None if self.plan.default is None else len(self.plan.matrix)

    @property
    def varied(self) -> range:
        """Numbers of the runs with a varied key."""
        first = len(self.plan.matrix) + (self.plan.default is not None)
        return range(first, first + len(self.plan.varied))

    def failure(self) -> PantographError | None:
        """What to tell of runs that crashed, or of a study in which none reached its end."""
        failed = [run for run in self.runs if run.status.startswith("failed: ")]
        if failed:
            lines = [f"  {r.variant.label}: {r.status.removeprefix('failed: ')}" for r in failed]
            return PantographError("\n".join(["Runs of the study crashed:", *lines]))
        if not any(run.done for run in self.runs):
            run = self.runs[0]
            return PathError(
                f"No run reached full load. {run.variant.label} {run.status.replace(':', ',', 1)}"
            )
        return None


def study(
    case_file: Path,
    output: Path | None = None,
    wanted: Wanted | None = None,
    *,
    repeat: int = 1,
    rerun: bool = False,
    runner: Runner = run_in_process,
    tell: Callable[[str], None] = lambda text: None,
) -> StudyResult:
    """Run a case in many discretisations, and take errors and times; `write` makes the files.

    Parameters
    ----------
    case_file
        The case.
    output
        Where the study and its runs go; ``results/study_<name>`` by default.
    wanted
        Schemes, degrees, meshes, keys to vary and reference.
    repeat
        Times that each run is measured; the median counts.
    rerun
        Measure anew what is there.
    runner
        Simulates a case, `run_in_process` by default.
    tell
        Called with a line before and after each run.

    Raises
    ------
    CaseError
        If anything given is wrong.
    """
    if repeat < 1:
        raise CaseError(f"--repeat: {not_allowed(repeat, 'be 1 or greater')}")
    plan = make_plan(case_file, output, wanted or Wanted())
    given = _given_reference(plan)
    for line in plan.left_out:
        tell(f"Left out: {line}")
    variants = [*plan.runs]
    runs = measure(variants, runner, repeat=repeat, rerun=rerun, tell=tell)
    if given is not None:
        runs.append(given)
    reference = runs[-1] if given is not None or plan.reference is not None else None
    accuracy = assess(runs, range(len(plan.matrix)), reference)
    return StudyResult(plan, tuple(runs), accuracy)


def write(result: StudyResult) -> list[Path]:
    """Write the table and the figures of a study and return their paths."""
    directory = result.plan.directory
    directory.mkdir(parents=True, exist_ok=True)
    paths = [directory / name for name in ("study.csv", "work_precision.png", "knobs.png")]
    write_table(result, paths[0])
    drawn = [draw_work_precision(result, paths[1]), draw_knobs(result, paths[2])]
    return paths[:1] + [path for path, made in zip(paths[1:], drawn, strict=True) if made]


def _given_reference(plan: Plan) -> Measurement | None:
    """Read the folder that is the reference, and check that it is a result of the same problem."""
    directory = plan.reference_directory
    if directory is None:
        return None
    if not (directory / "summary.json").is_file():
        raise CaseError(
            f"--reference: {directory} holds no results, as summary.json is missing; give the "
            "folder of a finished run"
        )
    case = load_case(directory / "case.resolved.toml")
    run = read(Variant("reference", directory, case))
    if not run.done:
        raise CaseError(f"--reference: {directory} was {run.status}; give a finished run")
    ours, theirs = (c.model_dump(mode="json") for c in (plan.matrix[0].case, case))
    for section in sorted((ours.keys() | theirs.keys()) - _MAY_DIFFER):
        if ours.get(section) != theirs.get(section):
            raise CaseError(
                f"--reference: {directory} solves another problem, as [{section}] differs; "
                "give a result of the same case on a finer mesh"
            )
    return run
