"""Pivots that are easier to solve for, as a way to those of the case."""

from __future__ import annotations

import math

from ..physics.energy import FibreEnergy

#: δ of one level, in those of the level below.
_FACTOR = 10.0
#: The largest δ that makes a state easier and leaves it near, rad; and the most levels.
_LARGEST = 0.1
_MOST = 3


class Softening:
    r"""Levels of the smoothing δ of pivots with γ < 2, see `shear_density`.

    At ψ = 0 their stiffness is :math:`\tfrac12\gamma K_p\delta^{\gamma-2}`: large, and other within
    δ. Newton's method, which sees it all along a step, can go astray there; a larger δ helps.
    """

    def __init__(self, energy: FibreEnergy) -> None:
        self._delta = energy.regularisation
        self._own = 0.0 if self._delta is None else float(self._delta.value)

    @property
    def softest(self) -> int:
        """The highest level; 0 where there is nothing to smooth."""
        if not 0.0 < self._own < _LARGEST:
            return 0
        return min(_MOST, math.floor(math.log(_LARGEST / self._own, _FACTOR) + 1e-9))

    def set(self, level: int) -> None:
        """Have the δ of a level; level 0 has that of the case."""
        if self._delta is not None:
            self._delta.value = self._own * _FACTOR**level
