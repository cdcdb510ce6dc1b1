"""One series of Newton steps: whether it is worth going on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from petsc4py import PETSc

#: A Newton step that leaves more than this share of the error is a slow one;
_SLOW = 0.7
#: so many in a row, and another way of shortening steps is tried, where there is one.
_SLOW_STEPS = 3


@dataclass
class Attempt:
    """What is asked of a series of steps, and how it goes.

    Attributes
    ----------
    bound
        Tangents after which it has failed.
    reuse
        Whether a factor may serve for more than one step.
    patient
        Whether to go on while steps are slow.
    """

    bound: int = 0
    reuse: bool = True
    patient: bool = True
    _slow: int = 0
    _last_error: float = math.inf

    def outcome(self, error: float, tangents: int) -> int:
        """PETSc's reason to stop at an error that is too large, or to go on."""
        if tangents >= self.bound:
            return PETSc.SNES.ConvergedReason.DIVERGED_MAX_IT
        self._slow = self._slow + 1 if error > _SLOW * self._last_error else 0
        self._last_error = error
        if self._slow >= _SLOW_STEPS and not self.patient:
            return PETSc.SNES.ConvergedReason.DIVERGED_DTOL
        return PETSc.SNES.ConvergedReason.ITERATING
