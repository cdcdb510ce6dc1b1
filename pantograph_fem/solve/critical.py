"""Critical points of a path: where the number of its unstable modes changes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from .crossing import JumpError, Sample, Samples, StateAt, find_crossing
from .equilibrium import Array, Linearisation, ModalEquilibrium, Mode

__all__ = ["Change", "CriticalPoint", "JumpError", "Kind", "StateAt", "locate"]

Kind = Literal["limit point", "bifurcation"]

#: Error of a critical load, relative to it.
_TOLERANCE = 1e-6
#: Loads below this are as good as none for that.
_SMALL_LOAD = 1e-3
#: Share of the load's work in the critical mode from which the load sees the mode.
_SEEN = 0.5
#: Critical points to look for between two states at most: inertia that is mere rounding has no end.
_MOST_POINTS = 32


@dataclass(frozen=True, eq=False)
class Change:
    """Two states of a path in a row, of which one has more unstable modes."""

    load: float
    first: Linearisation
    next_load: float
    second: Linearisation

    @property
    def lost(self) -> bool:
        """Whether stability is lost."""
        return self.first.stable and not self.second.stable


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """The state next to a critical load, on the side of fewer unstable modes.

    Attributes
    ----------
    load, linearisation
        The load, and the state.
    mode
        The critical mode, of which the eigenvalue is next to nothing.
    kind
        At a "limit point" the load has an extremum along the path; at a "bifurcation" another
        path crosses.
    iterations
        Tangents that were factorised to find it.
    modes
        Number of modes that are critical at once, of which `mode` is one.
    loses_stability
        Whether the path is stable up to there.
    """

    load: float
    linearisation: Linearisation
    mode: Mode
    kind: Kind
    iterations: int
    modes: int = 1
    loses_stability: bool = True

    @property
    def x(self) -> Array:
        """The state."""
        return self.linearisation.x


def locate(
    problem: ModalEquilibrium, change: Change, state_at: StateAt, length: float | None = None
) -> tuple[CriticalPoint, ...]:
    """All critical points between two states, in the order of the path.

    Those are left out of which no mode was found.

    Parameters
    ----------
    problem
        Analyses states.
    change
        The two states.
    state_at
        Corrects states between the two.
    length
        How far they are apart, in loads; the difference of their loads by default.

    Raises
    ------
    JumpError
        If they are states of two paths.
    """
    loads = change.load, change.next_load
    length = abs(loads[1] - loads[0]) if length is None else length
    tolerance = _TOLERANCE * max(*map(abs, loads), _SMALL_LOAD) / max(length, _SMALL_LOAD**2)
    search = _Search(Samples(problem, state_at), tolerance)
    first = Sample(0.0, change.load, change.first)
    second = Sample(1.0, change.next_load, change.second)
    return tuple(search.between(first, second))


class _Search:
    """Looks for critical points, one eigenvalue after the other."""

    def __init__(self, samples: Samples, tolerance: float) -> None:
        self._samples, self._tolerance = samples, tolerance
        self._left = _MOST_POINTS

    def between(self, first: Sample, second: Sample) -> Iterator[CriticalPoint]:
        """Those between two samples."""
        more = second.unstable_modes - first.unstable_modes
        if more == 0 or self._left == 0:
            return
        self._left -= 1
        before = self._samples.tangents
        ends = (first, second) if more > 0 else (second, first)
        found = find_crossing(self._samples, *ends, self._tolerance)
        if found is None:
            return
        point = _point(*found, rises=more > 0, tangents=self._samples.tangents - before)
        near, far = found if more > 0 else found[::-1]
        yield from self.between(first, near)
        yield point
        yield from self.between(far, second)


def _point(below: Sample, above: Sample, rises: bool, tangents: int) -> CriticalPoint:
    state, mode = below.linearisation, below.mode
    assert state is not None
    assert mode is not None
    return CriticalPoint(
        below.load,
        replace(state, lowest=mode) if state.stable else state,
        mode,
        "limit point" if mode.load_share > _SEEN else "bifurcation",
        tangents,
        above.unstable_modes - below.unstable_modes,
        rises and state.stable,
    )
