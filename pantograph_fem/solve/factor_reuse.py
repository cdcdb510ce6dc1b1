"""When a factor of the tangent is good enough to be used again."""

from __future__ import annotations

import math

#: Steps with an old factor that cost as much as a new one.
_STEPS_PER_FACTOR = 10.0


class FactorReuse:
    """Watches how a factor contracts the error from step to step.

    A back-substitution and the residual cost a tenth of a tangent and its factorisation. So a
    factor is kept while the steps that it would still take are fewer than that.
    """

    def __init__(self, tolerance: float, contraction: float, near: float = 1e-2) -> None:
        """Aim at an error of `tolerance`.

        Errors are in typical sizes. A factor is kept where they are at most `near` and a step
        leaves at most the share `contraction` of them; with 0 never.
        """
        self._near = near
        self._tolerance = tolerance
        self._contraction = contraction
        self.begin()

    def begin(self) -> None:
        """Forget the errors: another solve, or another factor, begins."""
        self._last = math.inf

    def keep(self, error: float) -> bool:
        """Whether to go on with the factor by which the remaining error was just estimated."""
        last, self._last = self._last, error
        if not 0.0 < error <= self._near:
            return False
        share = error / last
        if math.isinf(last):
            return error <= self._contraction * self._near  # its contraction is not known yet
        if share > self._contraction:
            return False
        return math.log(self._tolerance / error) / math.log(share) <= _STEPS_PER_FACTOR
