"""What the points of a sweep have left in their folders."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..case import Case, case_to_toml
from ..errors import CaseError, PathError
from ..results.atomic import replace_text
from ..results.summary import CRITICAL, DONE
from ..study.process import Ended
from .outputs import read_outputs
from .plan import Plan, Point

#: File beside the results of a point that says how its process ended.
ENDED = "ended.json"


@dataclass(frozen=True, eq=False)
class PointResult:
    """A point that is over.

    Attributes
    ----------
    point
        The point.
    status
        "done", "stopped at a critical load", "stopped: " or "failed: " and why, or "invalid: "
        and what is wrong with the case.
    outputs
        Values by name; what is not known is not there.
    cpu_seconds
        User and system time of its process; NaN where it has not been run.
    """

    point: Point
    status: str
    outputs: Mapping[str, float] = field(default_factory=dict)
    cpu_seconds: float = math.nan

    @property
    def done(self) -> bool:
        """Whether the run came to the end that was asked for."""
        return self.status in (DONE, CRITICAL)

    def value(self, output: str) -> float:
        """An output; NaN where it is not known."""
        return self.outputs.get(output, math.nan)


def is_over(directory: Path, case: Case) -> bool:
    """Whether a folder holds what became of exactly this case: its end, or where it stopped.

    A run that crashed, was ended from outside or found the case wrong is not over.
    """
    try:
        if (directory / "case.resolved.toml").read_text(encoding="utf-8") != case_to_toml(case):
            return False
        written = (directory / "summary.json").stat().st_mtime
        if any(path.stat().st_mtime > written for path in case.input_files):
            return False
    except (OSError, UnicodeDecodeError):
        return False
    return "status" in _json(directory / "summary.json") and _failure(directory) is None


def forget(directory: Path) -> None:
    """Remove what says how an earlier run ended."""
    for name in ("summary.json", ENDED):
        (directory / name).unlink(missing_ok=True)


def keep(directory: Path, ended: Ended) -> None:
    """Write down how the process of a point ended."""
    words: dict[str, Any] = {"exit_code": ended.code, "cpu_seconds": ended.cpu_seconds}
    lines = [line.strip() for line in ended.message.splitlines()]
    if ended.code == CaseError.exit_code:
        words["failure"] = "invalid: " + "; ".join(lines[1:] or lines)
    elif ended.code not in (0, PathError.exit_code):
        by = f"signal {-ended.code}" if ended.code < 0 else f"exit code {ended.code}"
        words["failure"] = f"failed: {lines[-1] if lines else by}"
    directory.mkdir(parents=True, exist_ok=True)  # a process may have died before it did
    replace_text(directory / ENDED, json.dumps(words, indent=2, ensure_ascii=False) + "\n")


def read_result(plan: Plan, point: Point) -> PointResult:
    """Read what a point has left."""
    if point.case is None:
        return PointResult(point, f"invalid: {point.problem}")
    directory = point.directory
    cpu_seconds = float(_json(directory / ENDED).get("cpu_seconds", math.nan))
    status = _failure(directory) or _json(directory / "summary.json").get("status")
    if status is None:
        return PointResult(point, "failed: it left no summary.json", {}, cpu_seconds)
    loads = point.case.continuation.stops if plan.study.at_stops else ()
    at_end = status in (DONE, CRITICAL)
    stops = [load for load in loads if load < 1.0]
    outputs = read_outputs(directory, plan.outputs, stops, at_end)
    return PointResult(point, status, outputs, cpu_seconds)


def _failure(directory: Path) -> str | None:
    return _json(directory / ENDED).get("failure")


def _json(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
