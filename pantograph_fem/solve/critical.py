"""Critical points of a path: where a stable state becomes unstable, or the other way round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ..errors import PathError
from .equilibrium import Array, Correction, Linearisation, ModalEquilibrium, Mode

Kind = Literal["limit point", "bifurcation"]

#: Error of a critical load, relative to it.
_TOLERANCE = 1e-6
#: Loads below this are as good as none for that.
_SMALL_LOAD = 1e-3
#: States to try at most. A secant method needs about five of them.
_MOST = 40
#: Share of the load's work in the critical mode from which the load sees the mode.
_SEEN = 0.5

#: The lowest eigenvalue at a critical point is at most this share of those of the two states.
_NEXT_TO_NOTHING = 0.1
#: Share of the way between them within which it is, even where it falls like a square root only.
_NARROW = 1e-3

#: The state at a fraction, in [0, 1], of the way between two states of a path.
StateAt = Callable[[float], Correction]


class JumpError(PathError):
    """Two states of which one is stable are not on one path: no eigenvalue passes zero."""


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """The last stable state before a critical load, or the first one behind it.

    Attributes
    ----------
    load, linearisation
        The load, and the state with its lowest mode, of which the eigenvalue is next to nothing.
    kind
        At a "limit point" the load has an extremum along the path; at a "bifurcation" another
        path crosses.
    iterations
        Tangents that were factorised to find it.
    """

    load: float
    linearisation: Linearisation
    kind: Kind
    iterations: int

    @property
    def x(self) -> Array:
        """The state."""
        return self.linearisation.x

    @property
    def mode(self) -> Mode:
        """The critical mode."""
        assert self.linearisation.lowest is not None
        return self.linearisation.lowest


@dataclass(frozen=True, eq=False)
class _Sample:
    """A state on the way; without a mode where none was found."""

    load: float
    linearisation: Linearisation | None

    @property
    def stable(self) -> bool:
        return self.linearisation is not None and self.linearisation.stable

    @property
    def eigenvalue(self) -> float | None:
        lowest = None if self.linearisation is None else self.linearisation.lowest
        return None if lowest is None else lowest.eigenvalue


def locate(
    problem: ModalEquilibrium,
    state_at: StateAt,
    loads: tuple[float, float],
    length: float,
    stable_first: bool = True,
) -> CriticalPoint | None:
    """Find the critical point between a stable and an unstable state of a path.

    Inertia tells on which side a state is; the lowest eigenvalue, where it has one, tells where
    to look next (Illinois variant of the secant method). None where no mode could be found.

    Parameters
    ----------
    problem
        Analyses states.
    state_at
        Corrects states between the two; one that cannot be found counts as unstable.
    loads
        Of the two states.
    length
        How far they are apart, in loads.
    stable_first
        Whether the first of the two is the stable one.

    Raises
    ------
    JumpError
        If the lowest eigenvalue does not come near zero, so that these are states of two paths.
    """
    count = 0

    def sample(way: float) -> _Sample:
        nonlocal count
        found = state_at(way if stable_first else 1.0 - way)
        count += found.iterations
        if not found.converged:
            return _Sample(found.load, None)
        count += 1
        return _Sample(found.load, problem.analyse(found.x, found.load))

    tolerance = _TOLERANCE * max(*map(abs, loads), _SMALL_LOAD) / max(length, _SMALL_LOAD**2)
    low, high = 0.0, 1.0
    below, above = sample(low), sample(high)
    if not below.stable or above.stable or below.eigenvalue is None:
        return None
    least = _NEXT_TO_NOTHING * max(below.eigenvalue, -(above.eigenvalue or 0.0))
    kept = [1.0, 1.0]  # halved while an end stays where it is
    moved = None
    for _ in range(_MOST):
        jump = high - low <= _NARROW and (below.eigenvalue or 0.0) > least
        if high - low <= tolerance or jump:
            break
        way = _next(low, high, below.eigenvalue, above.eigenvalue, kept, 0.4 * tolerance)
        new = sample(way)
        kept = [1.0, kept[1]] if new.stable else [kept[0], 1.0]
        if moved is new.stable:
            kept[1 if moved else 0] *= 0.5
        moved = new.stable
        if new.stable:
            low, below = way, new
        else:
            high, above = way, new
    linearisation = below.linearisation
    if linearisation is None or linearisation.lowest is None:
        return None
    if linearisation.lowest.eigenvalue > least:
        raise JumpError(
            f"the lowest eigenvalue of the tangent jumps at load factor {below.load:.6g}: "
            "the path was left for another one"
        )
    seen = linearisation.lowest.load_share > _SEEN
    return CriticalPoint(below.load, linearisation, "limit point" if seen else "bifurcation", count)


def _next(
    low: float,
    high: float,
    below: float | None,
    above: float | None,
    kept: list[float],
    margin: float,
) -> float:
    """Where to look between low and high, with eigenvalues above and below zero there."""
    if below is None or above is None or not below > 0.0 > above:
        return 0.5 * (low + high)
    first, second = kept[0] * below, kept[1] * above
    way = low + (high - low) * first / (first - second)
    # Beyond the zero by a margin, towards the end that is farther away: it closes in from there.
    way += margin if way - low < high - way else -margin
    return min(max(way, low + 0.25 * margin), high - 0.25 * margin)
