"""The cheapest discretisation for an accuracy, in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from .accuracy import error_text
from .limits import QUANTITIES

if TYPE_CHECKING:
    from .measurement import Measurement
    from .study import StudyResult

#: Relative errors for which the cheapest run is named.
TOLERANCES = (1e-2, 1e-3, 1e-4)


def cheapest(result: StudyResult, quantity: str, tolerance: float) -> int | None:
    """Number of the run of the matrix with an error within a tolerance at least CPU time."""
    within = [i for i in result.matrix if result.accuracy.error(i, quantity) <= tolerance]
    return min(within, key=lambda i: _cost(result.runs[i]), default=None)


def advice(result: StudyResult) -> list[str]:
    """A line per quantity and tolerance."""
    against = "the limit of its series" if result.accuracy.reference is None else "the reference"
    lines = [f"Cheapest runs within a relative error, against {against}:"]
    for quantity in QUANTITIES:
        uncertainty = result.accuracy.uncertainty.get(quantity, math.nan)
        for tolerance in TOLERANCES:
            lines.append(
                f"  {quantity} to {error_text(tolerance, 0)}: {_words(result, quantity, tolerance)}"
            )
            if uncertainty > tolerance:
                lines[-1] += (
                    f" (the reference itself is known to {error_text(uncertainty, 0)} only)"
                )
    if off := result.accuracy.off_series:
        lines.append(
            f"Beware: the reference does not go on with the series of {' and '.join(off)}, and may "
            "lie on another branch of equilibria. Compare its history.csv with others, and give "
            "--set continuation.initial_step, --reference or --no-reference."
        )
    return lines


def _words(result: StudyResult, quantity: str, tolerance: float) -> str:
    number = cheapest(result, quantity, tolerance)
    if number is None:
        return "no run; refine further with --mesh"
    run = result.runs[number]
    return (
        f"{run.variant.series}, {run.variant.sizes.text}: {run.cpu_seconds:.1f} s CPU, "
        f"{run.dofs} dofs, error {error_text(result.accuracy.error(number, quantity))}"
    )


def _cost(run: Measurement) -> float:
    return math.inf if math.isnan(run.cpu_seconds) else run.cpu_seconds
