"""Columns of a history as text: units with prefixes, and as many digits as can be read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .units import power_of_ten, prefixed

#: Part of the largest value of the same unit below which a column is zero up to rounding.
NEGLIGIBLE = 1e-9
#: Significant digits of the largest value of a column.
DIGITS = 6
#: A critical load is found to 1e-6.
LOAD_DECIMALS = 7

NOT_A_NUMBER = "–"


@dataclass(frozen=True)
class ColumnTexts:
    """A column of a table: its name, its unit with a prefix, and a text per row."""

    name: str
    unit: str
    texts: tuple[str, ...]


def column_texts(
    history: Mapping[str, NDArray[Any]], units: Mapping[str, str]
) -> list[ColumnTexts]:
    """Return the columns of a history as they are printed.

    The values of a column have one unit and one number of decimals. A column whose values are all
    below 1e-9 of the largest of the same unit is zero up to rounding, and is printed so.

    Parameters
    ----------
    history
        Values by name, each of shape (k,).
    units
        SI unit by name; names that are not there have none.
    """
    largest = largest_by_unit(history, units)
    return [
        _column(name, values, units.get(name, ""), largest.get(units.get(name, ""), 0.0))
        for name, values in history.items()
    ]


def largest_by_unit(
    history: Mapping[str, NDArray[Any]], units: Mapping[str, str]
) -> dict[str, float]:
    """Largest absolute value by SI unit; moments and energies count as of one unit."""
    largest: dict[str, float] = {}
    for name, values in history.items():
        if unit := units.get(name):
            largest[unit] = max(largest.get(unit, 0.0), _size(values))
    work = max(largest.get("J", 0.0), largest.get("N m", 0.0))
    return largest | {"J": work, "N m": work}


def _column(name: str, values: NDArray[Any], unit: str, largest: float) -> ColumnTexts:
    if values.dtype == bool:
        return ColumnTexts(name, unit, tuple("yes" if value else "no" for value in values))
    if np.issubdtype(values.dtype, np.integer):
        return ColumnTexts(name, unit, tuple(str(value) for value in values))
    if name == "load":
        return ColumnTexts(name, "", _without_common_zeros(_fixed(values, LOAD_DECIMALS)))
    size = _size(values)
    if size <= NEGLIGIBLE * largest or size == 0.0:
        texts = ("0" if math.isfinite(value) else NOT_A_NUMBER for value in values)
        return ColumnTexts(name, unit, tuple(texts))
    if unit in ("", "rad"):
        factor, power = power_of_ten(size)
        label = f"{power} {unit}".strip()
    else:
        factor, label = prefixed(size, unit)
    decimals = max(0, DIGITS - 1 - math.floor(math.log10(factor * size)))
    return ColumnTexts(name, label, _fixed(factor * values, min(decimals, 9)))


def _size(values: NDArray[Any]) -> float:
    numbers = np.abs(np.asarray(values, float))
    return float(numbers[np.isfinite(numbers)].max(initial=0.0))


def _fixed(values: NDArray[Any], decimals: int) -> tuple[str, ...]:
    texts = (f"{value:.{decimals}f}" if math.isfinite(value) else NOT_A_NUMBER for value in values)
    return tuple(text.lstrip("-") if not text.strip("-0.") else text for text in texts)


def _without_common_zeros(texts: tuple[str, ...]) -> tuple[str, ...]:
    """Fewer decimals, where none of them needs the last ones."""
    spare = min((len(text) - len(text.rstrip("0")) for text in texts if "." in text), default=0)
    return tuple(text[: len(text) - spare].rstrip(".") if "." in text else text for text in texts)
