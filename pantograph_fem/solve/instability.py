"""What is done where a path loses stability, or regains it, and at its other critical points."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from .branch import BranchState, switch_branch
from .critical import Change, CriticalPoint
from .ending import no_branch, no_mode
from .equilibrium import Correction, Linearisation, ModalEquilibrium
from .step_size import StepSize
from .steps import Checkpoint, Step, critical_step

#: Relative difference of loads that are both critical, for all that is known.
_SAME_LOAD = 1e-5

#: Go on along the unstable path, end there, or go on along the stable path that branches off.
OnInstability = Literal["follow", "stop", "branch"]


@dataclass(frozen=True, eq=False)
class Passage:
    """What came of the critical points between two states.

    Attributes
    ----------
    number
        Of the last step.
    ended
        Whether the path ends at the last of them.
    left
        The bifurcation at which the path is left, and the first state of the branch; None where
        it goes on.
    """

    number: int
    ended: bool = False
    left: tuple[CriticalPoint, BranchState] | None = None


def pass_critical(
    problem: ModalEquilibrium,
    points: Sequence[CriticalPoint],
    change: Change,
    end: Correction,
    checkpoint: Checkpoint,
    size: StepSize,
    on_instability: OnInstability,
    upwards: bool = True,
) -> Generator[Step, None, Passage]:
    """Yield critical points as steps until the path is left or ends at one, as the user wants it.

    A path is left where it loses stability at a bifurcation, and ends only where it loses it.

    Parameters
    ----------
    problem
        Finds branches.
    points, change
        The critical points, and the states before and behind them.
    end
        The state behind them, as it was found.
    checkpoint
        Of the state before them.
    size
        Knows the stops.
    on_instability
        What the user wants.
    upwards
        Whether a branch must be stable and rise.

    Raises
    ------
    PathError
        If the path is to end or to be left where stability is lost, and no point was located
        there; or if no branch is found.
    """
    stops = size.settings.stops
    if change.lost and on_instability != "follow" and not any(p.loses_stability for p in points):
        raise no_mode(problem, change)
    number = checkpoint.number
    for point in points:
        leaves = (
            point.loses_stability and on_instability == "branch" and point.kind == "bifurcation"
        )
        here = _put_on_stop(point, end, change.second, stops) if leaves else point
        number += 1
        yield critical_step(number, here, checkpoint, size.settings)
        if (point.loses_stability and on_instability == "stop") or size.finished(here.load):
            return Passage(number, ended=True)
        if leaves:
            branch = switch_branch(problem, here, size.next_stop(here.load), upwards)
            if branch is None:
                raise no_branch(problem, here, upwards)
            return Passage(number, left=(here, branch))
    return Passage(number)


def _put_on_stop(
    point: CriticalPoint, end: Correction, linearisation: Linearisation, stops: Sequence[float]
) -> CriticalPoint:
    """The critical point at the state behind it, if that is a stop which is critical itself.

    No branch could be taken between the two.
    """
    near = abs(end.load - point.load) <= _SAME_LOAD * max(abs(end.load), 1.0)
    if not near or end.load not in stops:
        return point
    there = replace(linearisation, lowest=point.mode)
    return replace(point, load=end.load, linearisation=there)
