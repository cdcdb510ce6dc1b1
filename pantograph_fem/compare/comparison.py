"""Quantities of all runs at one load, their differences and orders of convergence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .orders import orders_of_errors, orders_of_values, richardson_limit
from .outcome import Outcome
from .quantities import ROUNDING, choose, is_negligible, scale, values
from .study import Study

NAN = float("nan")

#: Loads that differ by less are the same.
_SAME_LOAD = 1e-9


@dataclass(frozen=True)
class Number:
    """A quantity of a run; NaN stands for what is not known.

    Attributes
    ----------
    run
        Number of the run, from 0.
    quantity
        Name of the quantity.
    load
        Load fraction at which it was taken.
    value, reference
        Of this run and of the reference, in SI units.
    difference
        Value minus reference; 0 where that is rounding.
    relative_difference
        Difference over the magnitude of the reference.
    order
        Observed order of convergence from the next coarser run to this one, or from the next two
        where there is no reference.
    """

    run: int
    quantity: str
    load: float
    value: float
    reference: float = NAN
    difference: float = NAN
    relative_difference: float = NAN
    order: float = NAN


@dataclass(frozen=True)
class Extrapolated:
    """Limit of a quantity as the parameter tends to zero, from the three finest runs (Richardson).

    `difference` is the limit minus the reference; NaN stands for what is not known.
    """

    quantity: str
    limit: float
    order: float
    reference: float
    difference: float
    relative_difference: float


@dataclass(frozen=True, eq=False)
class Comparison:
    """Runs side by side.

    Attributes
    ----------
    study
        How they are compared.
    outcomes
        The runs.
    quantities
        Names of what is compared.
    load
        Load fraction of the comparison; NaN when the runs have none in common.
    numbers
        By run number and quantity; a run that did not reach the load has its last values there,
        and a quantity that a run does not have is absent.
    limits
        By quantity, where the runs have a parameter and converge.
    """

    study: Study
    outcomes: tuple[Outcome, ...]
    quantities: tuple[str, ...]
    load: float
    numbers: dict[tuple[int, str], Number]
    limits: dict[str, Extrapolated]

    @property
    def reference(self) -> int | None:
        """Number of the run that differences are taken against."""
        return next((i for i, run in enumerate(self.outcomes) if run.entry.reference), None)

    @property
    def series(self) -> list[int]:
        """Numbers of the runs with a positive parameter, coarsest first; not the reference."""
        parameters = {
            i: run.entry.parameter
            for i, run in enumerate(self.outcomes)
            if not run.entry.reference and (run.entry.parameter or 0) > 0
        }
        return sorted(parameters, key=lambda i: -(parameters[i] or 0))


def compare_outcomes(outcomes: Sequence[Outcome], study: Study) -> Comparison:
    """Compare runs at the load of the study, or at the last load that they have in common.

    Runs that were stopped early do not lower that load: they take part if they have it, and show
    their last values if not.

    Raises
    ------
    CaseError
        When no run has a quantity that the study asks for.
    """
    outcomes = tuple(outcomes)
    quantities = choose(outcomes, study.quantities)
    load = study.load or _last_common_load(outcomes)
    comparison = Comparison(study, outcomes, quantities, load, {}, {})
    for quantity in quantities:
        _compare(comparison, quantity)
    return comparison


def _last_common_load(outcomes: Sequence[Outcome]) -> float:
    deciding = [run for run in outcomes if run.done or run.entry.reference] or list(outcomes)
    first, *others = (run.history["load"] for run in deciding)
    shared = [
        float(load) for load in first if all(_state(loads, load) is not None for loads in others)
    ]
    return max((load for load in shared if load > 0), default=NAN)


def _state(loads: np.ndarray, load: float) -> int | None:
    """Number of the state at a load."""
    found = np.flatnonzero(np.abs(loads - load) < _SAME_LOAD)
    return int(found[-1]) if len(found) else None


def _compare(comparison: Comparison, quantity: str) -> None:
    """Fill in the numbers and the limit of a quantity."""
    number, outcomes = comparison.reference, comparison.outcomes
    reference = NAN if number is None else _at_load(comparison, number, quantity)
    # nothing is relative to what is zero up to rounding
    is_zero = number is not None and is_negligible(reference, outcomes[number], quantity)
    magnitude = NAN if is_zero else abs(reference)
    rounding = 0.0 if number is None else ROUNDING * scale(outcomes[number], quantity)

    # Runs that stopped early leave no gap in the series: their neighbours follow each other.
    at_load = {i: _at_load(comparison, i, quantity) for i in comparison.series}
    series = [i for i in at_load if np.isfinite(at_load[i])]
    h = np.array([outcomes[i].entry.parameter for i in series], float)
    v = np.array([at_load[i] for i in series])
    e = np.where(np.abs(v - reference) <= rounding, 0.0, v - reference)
    found = orders_of_values(h, v) if number is None else orders_of_errors(h, e)
    orders = dict(zip(series, found.tolist(), strict=True))

    for i, run in enumerate(outcomes):
        column = values(run, quantity)
        if column is None:
            continue
        value, load = _at_load(comparison, i, quantity), comparison.load
        if np.isnan(value):
            value, load = float(column[-1]), float(run.history["load"][-1])
            comparison.numbers[i, quantity] = Number(i, quantity, load, value)
            continue
        difference = NAN if i == number else value - reference
        difference = 0.0 if abs(difference) <= rounding else difference
        comparison.numbers[i, quantity] = Number(
            *(i, quantity, load, value, reference, difference),
            relative_difference=difference / magnitude,
            order=orders.get(i, NAN),
        )

    limit = richardson_limit(h, v)
    if limit is not None:
        difference = limit.value - reference
        comparison.limits[quantity] = Extrapolated(
            quantity, *limit, reference, difference, difference / magnitude
        )


def _at_load(comparison: Comparison, number: int, quantity: str) -> float:
    run = comparison.outcomes[number]
    column, state = values(run, quantity), _state(run.history["load"], comparison.load)
    return NAN if column is None or state is None else float(column[state])
