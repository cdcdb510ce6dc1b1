"""Runs of a study, made or found, and what they cost."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

from ..compare.outcome import DONE, Outcome, is_finished, read_outcome
from ..compare.plan import Entry
from ..errors import CaseError
from ..results.atomic import replace_text
from .machine import machine
from .process import Ended, Runner
from .variant import Variant
from .warm_up import forms_of, warm_up

#: File beside the results of a run that keeps its times.
COST = "cost.json"


@dataclass(frozen=True, eq=False)
class Measurement:
    """A run and its cost; NaN and None stand for what is not known.

    Attributes
    ----------
    variant
        What was run.
    status
        "done", "stopped: " and the reason, or "failed: " and the last line of the message.
    outcome
        Its history; None where it has no state.
    dofs, cells
        Degrees of freedom of all fields, and cells of the mesh.
    cpu_seconds
        CPU time of the process, median of the repeats.
    solve_seconds
        Wall time of assembly and solution, likewise.
    machine
        What it was timed on; empty where it is not known.
    versions
        Version by package.
    """

    variant: Variant
    status: str
    outcome: Outcome | None = None
    dofs: int | None = None
    cells: int | None = None
    cpu_seconds: float = math.nan
    solve_seconds: float = math.nan
    machine: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)

    @property
    def done(self) -> bool:
        """Whether the path was followed to its end."""
        return self.status == DONE

    @property
    def steps(self) -> int | None:
        """Number of accepted steps."""
        return None if self.outcome is None else int(self.outcome.history["step"][-1])

    @property
    def newton_iterations(self) -> int | None:
        """Tangents factorised to find the accepted states."""
        return (
            None if self.outcome is None else int(self.outcome.history["newton_iterations"].sum())
        )


def measure(
    variants: Sequence[Variant],
    runner: Runner,
    *,
    repeat: int = 1,
    rerun: bool = False,
    tell: Callable[[str], None] = lambda text: None,
) -> list[Measurement]:
    """Run variants one at a time and measure what they cost.

    A finished run of exactly this case is taken with its times, where it has been measured often
    enough. Forms are compiled before the first timed run that needs them: that is done once on a
    machine. A run that stops, or crashes, does not keep the others from being made.

    Raises
    ------
    CaseError
        If a case is wrong in a way that shows only when it is run.
    """
    unique = list({variant.directory: variant for variant in variants}.values())
    coarsest = max(unique, key=lambda variant: variant.sizes.size)
    warm = {""}
    for number, variant in enumerate(unique, 1):
        directory, head = variant.directory, f"{number}/{len(unique)} {variant.label}"
        costs = [] if rerun or not is_finished(directory, variant.case) else _costs(directory)
        if len(costs) >= repeat:
            tell(f"{head}: {_seconds(costs)}, measured before")
            continue
        if (forms := forms_of(variant.case)) not in warm:
            warm.add(forms)
            tell(f"{head}: compiling the forms")
            _check(variant, warm_up(variant.case, coarsest.case.mesh, runner))
        tell(f"{head}: running")
        if not costs:
            for name in (COST, "summary.json"):
                (directory / name).unlink(missing_ok=True)
        ended = Ended(0, 0.0)
        while len(costs) < repeat and ended.code == 0:
            ended = _check(variant, runner(variant.case, directory))
            costs.append((ended.cpu_seconds, _solve_seconds(directory)))
            _keep(directory, costs, "" if ended.code in (0, 3) else _failure(ended))
        words = {0: "done", 3: "stopped on its way"}.get(ended.code) or _failure(ended)
        tell(f"{head}: {_seconds(costs)}, {words}")
    return [read(variant) for variant in variants]


def read(variant: Variant) -> Measurement:
    """Read what a run has left."""
    directory = variant.directory
    cost, costs = _json(directory / COST), _costs(directory)
    if failure := cost.get("failure"):
        return Measurement(variant, failure, cpu_seconds=costs[0][0], machine=cost["machine"])
    summary = _json(directory / "summary.json")
    try:
        outcome = read_outcome(Entry(variant.label, directory))
    except CaseError:
        outcome = None  # it was stopped before its first state
    return Measurement(
        variant,
        summary["status"] if outcome is None else outcome.status,
        outcome,
        sum(summary["dofs"].values()),
        summary["cells"],
        median(cpu for cpu, _ in costs) if costs else math.nan,
        median(solve for _, solve in costs) if costs else _solve_seconds(directory),
        cost.get("machine", ""),
        summary["versions"],
    )


def _check(variant: Variant, ended: Ended) -> Ended:
    if ended.code == CaseError.exit_code:
        raise CaseError(f"{variant.label}: {ended.message}")
    return ended


def _failure(ended: Ended) -> str:
    by = f"signal {-ended.code}" if ended.code < 0 else f"exit code {ended.code}"
    lines = ended.message.splitlines()
    return f"failed: {lines[-1] if lines else by}"


def _seconds(costs: Sequence[tuple[float, float]]) -> str:
    return f"{median(cpu for cpu, _ in costs):.1f} s CPU"


def _costs(directory: Path) -> list[tuple[float, float]]:
    runs = _json(directory / COST).get("runs", ())
    return [(float(run["cpu_seconds"]), float(run["solve_seconds"])) for run in runs]


def _keep(directory: Path, costs: Sequence[tuple[float, float]], failure: str) -> None:
    runs = [{"cpu_seconds": cpu, "solve_seconds": solve} for cpu, solve in costs]
    cost = {"machine": machine(), "runs": runs} | ({"failure": failure} if failure else {})
    directory.mkdir(parents=True, exist_ok=True)
    replace_text(directory / COST, json.dumps(cost, indent=2) + "\n")


def _solve_seconds(directory: Path) -> float:
    seconds = _json(directory / "summary.json").get("seconds", {})
    return float(seconds.get("assemble", math.nan)) + float(seconds.get("solve", math.nan))


def _json(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
