"""The runs of a sweep, side by side; what is over already is not run again."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any

from ..study.process import Runner
from ..study.warm_up import warm_up
from .plan import Plan, Point
from .progress import SweepProgress
from .results import forget, is_over, keep, read_result

#: Sections of a case of which the compiled forms know nothing.
_NOT_IN_FORMS = {"name", "title", "mesh", "continuation", "output"}


def run_points(
    plan: Plan,
    runner: Runner,
    end: Callable[[], None],
    progress: SweepProgress,
    *,
    jobs: int,
    rerun: bool = False,
) -> int:
    """Run the points of a plan that are not over, and return how many those were.

    Forms are compiled before the processes start, which would otherwise all compile the same.

    Parameters
    ----------
    plan
        What to run.
    runner
        Simulates a case; called from several threads.
    end
        Ends what the runner has started, if the sweep is interrupted.
    progress
        Told of each point that is over.
    jobs
        Number of runs side by side.
    rerun
        Run what is over, too.

    Raises
    ------
    CaseError
        If a folder cannot be written to.
    """
    unique = {p.directory: (p, p.case) for p in plan.points if p.case is not None}
    missing = [
        (point, case)
        for point, case in unique.values()
        if rerun or not is_over(point.directory, case)
    ]
    progress.start(len(missing), len(unique) - len(missing))
    for case in {forms_of(case): case for _, case in reversed(missing)}.values():
        if hasattr(case, "discretisation"):
            progress.compiling()
            warm_up(case, getattr(case, "mesh", None), runner)
    interrupted = threading.Event()

    def run(point: Point, case: Any) -> Point:
        forget(point.directory)
        ended = runner(case, point.directory)
        if not interrupted.is_set():  # else it was ended with the sweep
            keep(point.directory, ended)
        return point

    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(run, point, case) for point, case in missing]
        try:
            for future in as_completed(futures):
                progress.over(read_result(plan, future.result()))
        except BaseException:
            interrupted.set()
            for future in futures:
                future.cancel()
            end()
            raise
    return len(missing)


def forms_of(case: Any) -> str:
    """Text that is the same for cases whose forms are the same; empty where there are none.

    Forms know which numbers are 0, and whether an exponent is 2, but none of the other values.
    """
    if not hasattr(case, "discretisation"):
        return ""
    return json.dumps(_shape(case.model_dump(mode="json", exclude=_NOT_IN_FORMS)), sort_keys=True)


def _shape(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _shape(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_shape(item) for item in value]
    return value if not isinstance(value, float) or value in (0.0, 2.0) else 1.0
