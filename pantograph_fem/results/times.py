"""Times of states in files for ParaView."""

from __future__ import annotations

#: Difference of two times that readers tell apart.
_APART = 1e-12


class Times:
    """The load of each state as a time, or one next to it if an earlier state has that.

    Of states with equal times readers show none, or one.
    """

    def __init__(self) -> None:
        self._taken: set[float] = set()

    def of(self, load: float) -> float:
        """The time of a state, which is taken then."""
        while load in self._taken:
            load += _APART
        self._taken.add(load)
        return load
