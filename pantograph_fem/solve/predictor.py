"""Predictors: guesses of the next state from those accepted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PredictorName = Literal["tangent", "secant", "none"]


@dataclass(frozen=True)
class PathPoint:
    """An accepted state and its derivative with respect to the load factor."""

    load: float
    x: Array
    rate: Array | None = None


def predict(name: PredictorName, points: Sequence[PathPoint], load: float) -> Array:
    """Guess of the state at `load`, shape of the states; `points` are accepted states, last last.

    - "none": the last state.
    - "secant": the line through the last two states.
    - "tangent": the parabola through the last two states with the last one's tangent; at the
      start of a path, or where `rate` is missing, what is left of it.
    """
    last = points[-1]
    h = load - last.load
    if name == "none":
        return last.x.copy()
    before = points[-2] if len(points) > 1 else None
    if name == "secant" or last.rate is None:
        if before is None:
            return last.x.copy()
        return last.x + (h / (last.load - before.load)) * (last.x - before.x)
    guess = last.x + h * last.rate
    if before is not None:
        back = before.load - last.load
        guess += (h / back) ** 2 * (before.x - last.x - back * last.rate)
    return guess
