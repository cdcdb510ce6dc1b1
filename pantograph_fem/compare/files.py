"""The comparison as tables ``comparison.csv``, ``limits.csv`` and ``curves.csv``."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from ..results.atomic import replace_text
from .comparison import Comparison
from .drive import drive_of
from .quantities import values

COMPARISON = (
    *("run", "label", "parameter", "load", "quantity", "value", "reference", "difference"),
    *("relative_difference", "order"),
)
LIMITS = ("quantity", "limit", "order", "reference", "difference", "relative_difference")
CURVES = ("run", "label", "load", "displacement")


def write_tables(comparison: Comparison, directory: Path) -> list[Path]:
    """Write the tables to a folder that exists and return their paths.

    ``comparison.csv`` has a row per run and quantity, ``limits.csv`` a row per quantity whose
    limit is known, ``curves.csv`` a row per run and state. All is in SI units; what is not known
    is empty.
    """
    names = ("comparison.csv", "limits.csv", "curves.csv")
    paths = [directory / name for name in names]
    _write(paths[0], COMPARISON, _comparison_rows(comparison))
    if comparison.limits:
        limits = comparison.limits.values()
        _write(paths[1], LIMITS, [[getattr(limit, name) for name in LIMITS] for limit in limits])
    else:
        paths.pop(1).unlink(missing_ok=True)
    _write(paths[-1], (*CURVES, *comparison.quantities), _curve_rows(comparison))
    return paths


def _comparison_rows(comparison: Comparison) -> Iterable[Sequence[object]]:
    for i, run in enumerate(comparison.outcomes):
        for quantity in comparison.quantities:
            if (number := comparison.numbers.get((i, quantity))) is not None:
                row = (number.load, quantity, number.value, number.reference, number.difference)
                last = (number.relative_difference, number.order)
                yield (i + 1, run.entry.label, run.entry.parameter, *row, *last)


def _curve_rows(comparison: Comparison) -> Iterable[Sequence[object]]:
    for i, run in enumerate(comparison.outcomes):
        columns = [values(run, quantity) for quantity in comparison.quantities]
        distance = drive_of(run.case).distance
        for k, load in enumerate(run.history["load"].tolist()):
            row = (None if column is None else float(column[k]) for column in columns)
            yield (i + 1, run.entry.label, load, distance * load if distance else None, *row)


def _write(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([_text(value) for value in row] for row in rows)
    replace_text(path, text.getvalue())


def _text(value: object) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return repr(value) if isinstance(value, float) else str(value)
