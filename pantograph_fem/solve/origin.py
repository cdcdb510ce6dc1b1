"""Where a state was extrapolated from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Origin:
    """The last state that is trusted, and the linear step from there; both of its shape.

    Attributes
    ----------
    x
        An equilibrium, or the iterate before.
    step
        What was added to it, to first order: along the tangent of the path, or Newton's step.
    """

    x: Array
    step: Array
