"""Where one eigenvalue of the tangent passes zero between two states of a path."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..errors import PathError
from .equilibrium import Array, Correction, Linearisation, ModalEquilibrium, Mode
from .factorisation import SingularTangentError

#: States to try at most. A secant method needs about five of them.
_MOST = 40
#: The eigenvalue where it passes zero is at most this share of those of the two states,
_NEXT_TO_NOTHING = 0.1
#: or this, in typical energies, as of a motion that nothing resists.
_ROUNDING = 1e-15
#: Share of the way between them within which it is, even where it falls like a square root only.
_NARROW = 1e-3

#: The state at a fraction, in [0, 1], of the way between two states of a path.
StateAt = Callable[[float], Correction]


class JumpError(PathError):
    """Two states that differ in stability are not on one path: no eigenvalue passes zero."""


@dataclass(frozen=True, eq=False)
class Sample:
    """A state on the way, and the mode asked for; without them where none was found."""

    way: float
    load: float
    linearisation: Linearisation | None
    mode: Mode | None = None

    @property
    def eigenvalue(self) -> float | None:
        """That of the mode."""
        return None if self.mode is None else self.mode.eigenvalue

    @property
    def unstable_modes(self) -> int:
        """Those of the state, which was found."""
        assert self.linearisation is not None
        return self.linearisation.unstable_modes

    def has_passed(self, number: int) -> bool:
        """Whether the eigenvalue of that number is below zero, or the state was not found."""
        return self.linearisation is None or self.unstable_modes >= number


class Samples:
    """Makes samples and counts the tangents that they take."""

    def __init__(self, problem: ModalEquilibrium, state_at: StateAt) -> None:
        self._problem, self._state_at = problem, state_at
        self.tangents = 0

    def at(self, way: float, number: int) -> Sample:
        """A new sample, with the mode of that number."""
        found = self._state_at(way)
        self.tangents += found.iterations
        if not found.converged:
            return Sample(way, found.load, None)
        return Sample(way, found.load, *self._analyse(found.x, found.load, number))

    def again(self, sample: Sample, number: int) -> Sample:
        """The same state, and as many unstable modes, with the mode of another number."""
        assert sample.linearisation is not None
        _, mode = self._analyse(sample.linearisation.x, sample.load, number)
        return Sample(sample.way, sample.load, sample.linearisation, mode)

    def _analyse(
        self, x: Array, load: float, number: int
    ) -> tuple[Linearisation, Mode | None] | tuple[None, None]:
        self.tangents += 1
        try:
            return self._problem.analyse(x, load, number)
        except SingularTangentError:
            return None, None


def find_crossing(
    samples: Samples, fewer: Sample, more: Sample, tolerance: float
) -> tuple[Sample, Sample] | None:
    """Samples on both sides of a zero of an eigenvalue; None where its mode is not found.

    It is the first eigenvalue that is above zero at `fewer` and below at `more`. Inertia tells on
    which side a state is; the eigenvalue, where it has one, tells where to look next (Illinois
    variant of the secant method). A state that cannot be found counts as one of `more`.

    Parameters
    ----------
    samples
        Makes states between the two.
    fewer, more
        Two states; the second has more unstable modes, whichever comes first on the path.
    tolerance
        How far apart, as a fraction of the way, the two that are returned may be.

    Raises
    ------
    JumpError
        If the eigenvalue does not come near zero, so that these are states of two paths.
    """
    number = fewer.unstable_modes + 1
    below, above = samples.again(fewer, number), samples.again(more, number)
    if below.eigenvalue is None:
        return None
    least = max(below.eigenvalue, -(above.eigenvalue or 0.0)) * _NEXT_TO_NOTHING
    least = max(least, _ROUNDING)
    span = abs(more.way - fewer.way)
    sign = 1.0 if more.way > fewer.way else -1.0
    low, high = 0.0, span
    last_found, value_above = above, above.eigenvalue
    kept = [1.0, 1.0]  # halved while an end stays where it is
    moved = None
    for _ in range(_MOST):
        near = (below.eigenvalue or 0.0) <= least
        if high - low <= (tolerance if near else _NARROW * span):
            break
        place = _next(low, high, below.eigenvalue, value_above, kept, 0.4 * tolerance)
        new = samples.at(fewer.way + sign * place, number)
        passed = new.has_passed(number)
        kept = [kept[0], 1.0] if passed else [1.0, kept[1]]
        if moved is passed:
            kept[0 if passed else 1] *= 0.5
        moved = passed
        if passed:
            high, value_above = place, new.eigenvalue
            last_found = new if new.linearisation is not None else last_found
        else:
            low, below = place, new
    if below.eigenvalue is None:
        return None
    if below.eigenvalue > least:
        which = "the lowest eigenvalue" if number == 1 else f"eigenvalue {number}"
        raise JumpError(
            f"{which} of the tangent jumps at load factor {below.load:.6g}: "
            "the path was left for another one"
        )
    return below, last_found


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
