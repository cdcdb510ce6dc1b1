"""The study as a table, ``study.csv``."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..results.atomic import replace_text
from .accuracy import COMPONENTS, Error
from .limits import QUANTITIES, at_full_load

if TYPE_CHECKING:
    from .study import StudyResult

COLUMNS = (
    *("scheme", "degree", "size", "corner_size", "vary", "value"),
    *("dofs", "cells", "steps", "newton_iterations", "cpu_seconds", "solve_seconds"),
    *("force", "energy", "force_error", "energy_error", "status"),
    *("force_error_largest", "energy_error_largest", "force_error_to_limit"),
    *("energy_error_to_limit", "force_x", "force_y", "force_x_error", "force_y_error", "label"),
)


def write_table(result: StudyResult, path: Path) -> None:
    """Write a row a run, in SI units; what is not known is empty.

    Forces and energies are those at full load, and errors are relative and without sign:
    ``*_error`` at full load against the reference, or against the limit of the series where the
    study has no reference; ``*_error_largest`` the largest at any stop, over the largest value at
    a stop; ``*_error_to_limit`` against the limit of the series.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for number in range(len(result.runs)):
        writer.writerow([_text(value) for value in _row(result, number)])
    replace_text(path, text.getvalue())


def _row(result: StudyResult, number: int) -> Sequence[object]:
    run, accuracy = result.runs[number], result.accuracy
    variant, sizes = run.variant, run.variant.sizes
    errors = [accuracy.errors.get((number, q), Error()) for q in (*QUANTITIES, *COMPONENTS)]
    # a result from elsewhere may lie in any folder
    is_reference = number >= len(result.plan.matrix) and run is accuracy.reference
    return (
        *(variant.scheme, variant.degree, sizes.size, sizes.corner_size),
        *(variant.key, variant.value),
        *(run.dofs, run.cells, run.steps, run.newton_iterations),
        *(run.cpu_seconds, run.solve_seconds),
        *(at_full_load(run, quantity) for quantity in QUANTITIES),
        *(accuracy.error(number, quantity) for quantity in QUANTITIES),
        run.status,
        *(error.largest for error in errors[:2]),
        *(error.to_limit for error in errors[:2]),
        *(at_full_load(run, component) for component in COMPONENTS),
        *(error.last for error in errors[2:]),
        "reference" if is_reference else variant.label,
    )


def _text(value: object) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return repr(value) if isinstance(value, float) else str(value)
