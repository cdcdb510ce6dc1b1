"""Measured data: tables of values with their standard errors."""

from __future__ import annotations

import csv
import difflib
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from .study import DataFile

Array = NDArray[np.float64]

#: Loads closer than this are the same.
_SAME = 1e-9
_DRIVES = ("load", "displacement")
_ERROR = "_error"


@dataclass(frozen=True, eq=False)
class Observations:
    """Measured values.

    Attributes
    ----------
    loads
        Increasing load fractions of the states, none of rest; shape (loads,).
    load, column
        For each value the numbers of its load and of its column, shape (values,).
    values, errors
        The values and their standard errors, SI units and rad; shape (values,).
    """

    loads: Array
    load: NDArray[np.int64]
    column: NDArray[np.int64]
    values: Array
    errors: Array

    def residuals(self, model: Array) -> Array:
        """(model - data) over the standard errors; `model` has the shape (loads, columns, ...)."""
        at = model[self.load, self.column]
        if at.ndim > 1:
            return at / self.errors[:, None]
        return (at - self.values) / self.errors

    def with_values(self, values: Array) -> Observations:
        """Other values of the same quantities, with the same errors."""
        return Observations(self.loads, self.load, self.column, values, self.errors)


@dataclass(frozen=True)
class Datum:
    """One value as it is read: its load fraction, column, value and standard error."""

    load: float
    column: str
    value: float
    error: float


def collect(data: Iterable[Datum], columns: Sequence[str]) -> Observations:
    """Sort values by load and column; those of the state of rest say nothing and are left out."""
    kept = [datum for datum in data if datum.load > _SAME]
    given = sorted(datum.load for datum in kept)
    loads = [load for i, load in enumerate(given) if i == 0 or load - given[i - 1] > _SAME]
    kept.sort(key=lambda datum: (columns.index(datum.column), datum.load))
    return Observations(
        loads=np.array(loads),
        load=np.array([np.argmin(np.abs(np.array(loads) - d.load)) for d in kept], dtype=int),
        column=np.array([columns.index(d.column) for d in kept], dtype=int),
        values=np.array([d.value for d in kept]),
        errors=np.array([d.error for d in kept]),
    )


def read_data(file: DataFile, path: Path, columns: Sequence[str], distance: float) -> list[Datum]:
    """Values of a CSV file.

    Parameters
    ----------
    file
        What the study says of it.
    path
        Where it is.
    columns
        Columns that can be compared with the model.
    distance
        Displacement of the top grip from the bottom one at full load, m.

    Raises
    ------
    CaseError
        When the file cannot be read, or does not hold what it should; the message says where.
    """
    header, rows = _table(path)
    drive = next((name for name in _DRIVES if name in header), None)
    if drive is None:
        raise CaseError(f"{path} has neither a column load nor a column displacement (m)")
    if drive == "displacement" and not distance:
        raise CaseError(f"{path}: the grips of the case do not move apart; give the column load")
    wanted = _wanted(file, path, header, columns)
    full = 1.0 if drive == "load" else distance
    data = []
    for number, row in enumerate(rows, 1):
        cells = dict(zip(header, row, strict=False))
        load = _number(cells, drive, path, number) / full
        if not -_SAME <= load <= 1 + _SAME:
            raise CaseError(
                f"{path}, row {number}: the {drive} {cells[drive]} is outside of the case's path, "
                f"which goes from 0 to {full:g}"
            )
        for column in wanted:
            if not cells.get(column, "").strip():
                continue
            value, error = _number(cells, column, path, number), error_of(file.errors, column)
            if column + _ERROR in header:
                error = _number(cells, column + _ERROR, path, number)
            if error is None or error <= 0:
                what = "has no standard error" if error is None else f"has the error {error:g}"
                raise CaseError(
                    f"{path}, row {number}: {column} {what}; give a column {column}{_ERROR}, or "
                    f"errors = {{ {column} = ... }} in the study, above 0"
                )
            data.append(Datum(min(load, 1.0), column, value, error))
    return data


def selected(patterns: Iterable[str], columns: Sequence[str]) -> list[str]:
    """Columns that match one of some patterns, in their order."""
    patterns = tuple(patterns)
    return [c for c in columns if any(fnmatchcase(c, pattern) for pattern in patterns)]


def error_of(errors: dict[str, float], column: str) -> float | None:
    """Error of a column by the first pattern that it matches."""
    return next((e for pattern, e in errors.items() if fnmatchcase(column, pattern)), None)


def _wanted(file: DataFile, path: Path, header: list[str], columns: Sequence[str]) -> list[str]:
    given = [name for name in header if name not in _DRIVES and not name.endswith(_ERROR)]
    if not file.columns:
        for name in given:
            if name not in columns:
                close = difflib.get_close_matches(name, columns, n=1)
                hint = f'did you mean "{close[0]}"? ' if close else ""
                raise CaseError(
                    f"{path}: the case measures no {name}; {hint}It measures "
                    f"{', '.join(columns)}. Other columns can be left out by `columns` in [[data]]"
                )
        return given
    for pattern in file.columns:
        if not selected([pattern], [name for name in given if name in columns]):
            raise CaseError(
                f'{path}: no column that the case measures is called "{pattern}", which the study '
                f"asks for; the file has {', '.join(given)}"
            )
    return [name for name in selected(file.columns, given) if name in columns]


def _table(path: Path) -> tuple[list[str], list[list[str]]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise CaseError(f"{path} cannot be read: {reason}") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    rows = [[cell.strip() for cell in row] for row in csv.reader(lines)]
    if len(rows) < 2:
        raise CaseError(f"{path} holds no data; it must be a line of column names and rows below")
    if len(set(rows[0])) < len(rows[0]):
        raise CaseError(f"{path} has two columns of the same name")
    return rows[0], rows[1:]


def _number(cells: dict[str, str], column: str, path: Path, row: int) -> float:
    text = cells.get(column, "")
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise CaseError(f'{path}, row {row}: {column} is "{text}"; it must be a number')
    return number
