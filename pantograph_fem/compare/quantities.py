"""Quantities of a history: which are compared, their units, and what counts as zero."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..case.messages import case_error
from ..case.problem import not_allowed
from ..results.units import column_unit as unit
from .outcome import Outcome

Array = NDArray[np.float64]

#: Magnitude of the force; the one quantity that is not a column of ``history.csv``.
FORCE = "force"

#: Part of the largest quantity of the same kind below which a quantity is zero up to rounding.
_NEGLIGIBLE = 1e-8

#: The same for a difference; what is left of it is the rounding of the numbers themselves.
ROUNDING = 1e-12


def values(outcome: Outcome, quantity: str) -> Array | None:
    """A quantity at every state of a run, shape (k,); None if the run does not have it."""
    history = outcome.history
    if quantity == FORCE:
        return np.hypot(history["force_x"], history["force_y"])
    return history[quantity].astype(float) if quantity in history else None


def scale(outcome: Outcome, quantity: str) -> float:
    """Largest absolute value of all quantities of the run with the same unit, at any state.

    What is below `_NEGLIGIBLE` of it is zero up to rounding, and nothing is relative to it.
    """
    alike = [name for name in outcome.history if unit(name) and unit(name) == unit(quantity)]
    found = [values(outcome, name) for name in alike or [quantity]]
    return max((float(np.abs(v).max()) for v in found if v is not None), default=0.0)


def is_negligible(value: float, outcome: Outcome, quantity: str) -> bool:
    """Whether a value of a run is zero up to rounding."""
    return abs(value) <= _NEGLIGIBLE * scale(outcome, quantity)


def choose(outcomes: Sequence[Outcome], wanted: Sequence[str]) -> tuple[str, ...]:
    """Quantities to compare, in order.

    Those wanted, if any; else the force, the energy, its parts, and displacements of probes and
    tips, without those that are zero throughout all runs. A probe is left out by default where it
    is not the same material point in all runs.

    Raises
    ------
    CaseError
        When no run has a quantity that is wanted.
    """
    columns = list(dict.fromkeys(name for run in outcomes for name in run.history))
    if wanted:
        allowed = [FORCE, *columns]
        rule = f"be one of {', '.join(allowed)}"
        problems = [f"quantities: {not_allowed(q, rule)}" for q in wanted if q not in allowed]
        if problems:
            raise case_error("The study", problems)
        return tuple(wanted)
    chosen = [FORCE, "energy"]
    for name in columns:
        if re.fullmatch(r"energy_\w+|(probe\d+|tip)_u[xy]", name) and _same_point(outcomes, name):
            found = [(run, values(run, name)) for run in outcomes]
            if any(
                v is not None and not is_negligible(float(np.abs(v).max()), run, name)
                for run, v in found
            ):
                chosen.append(name)
    return tuple(chosen)


def _same_point(outcomes: Sequence[Outcome], column: str) -> bool:
    found = re.match(r"probe(\d+)_", column)
    if not found:
        return True
    number = int(found[1])
    probes = [tuple(getattr(run.case.output, "probes", ())) for run in outcomes]
    return len({points[number] for points in probes if number < len(points)}) <= 1
