"""When a factor of the tangent is good enough to be used again."""

from __future__ import annotations

import math

#: Errors, in typical sizes, above which the factor of another state is not trusted.
_NEAR = 1e-2
#: Steps with an old factor that cost as much as a new one.
_STEPS_PER_FACTOR = 10.0


class FactorReuse:
    """Watches how a factor contracts the error from step to step.

    A back-substitution and the residual cost a tenth of a tangent and its factorisation. So a
    factor is kept while the steps that it would still take are fewer than that.
    """

    def __init__(self, tolerance: float, contraction: float) -> None:
        """`tolerance` is the error aimed at; `contraction` the largest share that a step may leave.

        With a contraction of 0 a factor is never kept.
        """
        self._tolerance = tolerance
        self._contraction = contraction
        self.begin()

    def begin(self) -> None:
        """Forget the errors: another solve, or another factor, begins."""
        self._last = math.inf

    def keep(self, error: float) -> bool:
        """Whether to go on with the factor by which the remaining error was just estimated."""
        last, self._last = self._last, error
        if not 0.0 < error <= _NEAR:
            return False
        share = error / last
        if math.isinf(last):
            return error <= self._contraction * _NEAR
        if share > self._contraction:
            return False
        return math.log(self._tolerance / error) / math.log(share) <= _STEPS_PER_FACTOR
