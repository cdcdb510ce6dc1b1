"""What is done where a path loses stability, or regains it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from ..errors import PathError
from .branch import BranchState, switch_branch
from .critical import CriticalPoint, locate
from .equilibrium import Correction, Linearisation, ModalEquilibrium

#: Relative difference of loads that are both critical, for all that is known.
_SAME_LOAD = 1e-5

#: Go on along the unstable path, end there, or go on along the stable path that branches off.
OnInstability = Literal["follow", "stop", "branch"]


@dataclass(frozen=True, eq=False)
class Change:
    """Two states in a row, one of which is stable."""

    load: float
    first: Linearisation
    next_load: float
    second: Linearisation

    @property
    def lost(self) -> bool:
        """Whether stability is lost, not regained."""
        return self.first.stable


def critical_point(
    problem: ModalEquilibrium,
    change: Change,
    state_at: Callable[[float], Correction],
    length: float | None = None,
) -> CriticalPoint | None:
    """The critical point between two states; None where no mode could be found.

    `state_at` corrects states at fractions of the way between them, and `length` is that way, by
    default that of the load.

    Raises
    ------
    JumpError
        If they are states of two paths.
    """

    def known_at(way: float) -> Correction:
        if way == 0.0:
            return Correction(change.load, change.first.x, True, 0, "")
        if way == 1.0:
            return Correction(change.next_load, change.second.x, True, 0, "")
        return state_at(way)

    loads = change.load, change.next_load
    length = abs(loads[1] - loads[0]) if length is None else length
    return locate(problem, known_at, loads, length, change.lost)


@dataclass(frozen=True, eq=False)
class Decision:
    """What is done at a critical point: whether the path is left there, or ends there."""

    point: CriticalPoint
    leaves: bool
    ends: bool


def decide(
    point: CriticalPoint | None,
    change: Change,
    end: Correction,
    on_instability: OnInstability,
    stops: Sequence[float],
) -> Decision | None:
    """What the user wants at a critical point, of which `end` is the state behind.

    A path is left where it loses stability at a bifurcation, and ends only where it loses it.
    None where the point could not be located, and nothing is wanted there.

    Raises
    ------
    PathError
        If the path is to end at a point that could not be located, or to be left there.
    """
    lost = change.lost
    if point is None:
        if not lost or on_instability == "follow":
            return None
        raise PathError(
            f"The path loses stability between load factors {change.load:.9g} and "
            f"{change.next_load:.9g}, and no mode was found there by which to locate the critical "
            "point. Every state up to there is saved. Try a finer mesh, or "
            'continuation.on_instability = "follow".'
        )
    leaves = lost and on_instability == "branch" and point.kind == "bifurcation"
    if leaves:
        point = _put_on_stop(point, end, change.second, stops)
    return Decision(point, leaves, lost and on_instability == "stop")


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


def leave(
    problem: ModalEquilibrium, point: CriticalPoint, before: float, upwards: bool = True
) -> BranchState:
    """The first state on the branch at a bifurcation.

    Raises
    ------
    PathError
        If there is none; with `upwards`, none that is stable at a load above the critical one.
    """
    branch = switch_branch(problem, point, before, upwards)
    if branch is None:
        raise PathError(
            f"The path loses stability at load factor {point.load:.9g}, and no stable branch was "
            "found to rise from there. Every state up to there is saved. Try "
            'continuation.on_instability = "follow" or "stop"'
            + (', or continuation.method = "arc_length".' if upwards else ".")
        )
    return branch
