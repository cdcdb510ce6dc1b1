"""The sweep as one table, ``sweep.csv``, and as ``sweep.parquet`` where pyarrow is installed."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..results.atomic import replace_text
from ..results.history import INTEGERS
from .outputs import at_stop

if TYPE_CHECKING:
    from .sweep import SweepResult

#: Outputs that are whole numbers.
_WHOLE = {*INTEGERS, "stable", "steps"}


def columns(result: SweepResult) -> dict[str, list[Any]]:
    """Columns of the table, a value per point in SI units; what is not known is None.

    These are the number of the point, the varied keys, the outputs, the outputs at the stops,
    load fraction and number of the last step, how the run ended, what it cost, and the folder of
    its results.
    """
    points = result.points
    table: dict[str, list[Any]] = {"point": list(range(1, len(points) + 1))}
    for i, vary in enumerate(result.plan.study.vary):
        values: list[Any] = [point.point.values[i] for point in points]
        if vary.is_numeric:
            values = [float(value) for value in values]
        elif len({type(value) for value in values}) > 1 or isinstance(values[0], list):
            values = [json.dumps(value, ensure_ascii=False) for value in values]
        table[vary.key] = values
    for name in (*result.plan.outputs, *_names_at_stops(result), "load", "steps"):
        found = [_known(point.value(name)) for point in points]
        if name.partition("@")[0] in _WHOLE:
            found = [None if value is None else int(value) for value in found]
        table[name] = found
    table["status"] = [point.status for point in points]
    table["cpu_seconds"] = [_known(point.cpu_seconds) for point in points]
    folders = [point.point.directory for point in points]
    table["folder"] = [
        str(folder.relative_to(result.plan.directory)) if point.point.case is not None else None
        for folder, point in zip(folders, points, strict=True)
    ]
    return table


def write_csv(result: SweepResult, path: Path) -> None:
    """Write a row per point; what is not known is empty."""
    table, text = columns(result), io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    writer.writerows([_text(value) for value in row] for row in zip(*table.values(), strict=True))
    replace_text(path, text.getvalue())


def write_parquet(result: SweepResult, path: Path) -> bool:
    """Write the same table in Parquet, and say whether pyarrow is there to do it."""
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError:
        path.unlink(missing_ok=True)
        return False
    arrays = {}
    for name, values in columns(result).items():
        # a column in which nothing is known has a type, too
        known = next((value for value in values if value is not None), 0.0)
        arrays[name] = pa.array(values, pa.scalar(known).type)
    aside = path.with_name(path.name + ".part")
    parquet.write_table(pa.table(arrays), aside)
    os.replace(aside, path)
    return True


def _names_at_stops(result: SweepResult) -> list[str]:
    if not result.plan.study.at_stops:
        return []
    cases = [point.point.case for point in result.points]
    stops = {s for case in cases if case is not None for s in case.continuation.stops if s < 1.0}
    return [at_stop(name, stop) for stop in sorted(stops) for name in result.plan.outputs]


def _known(value: float) -> float | None:
    return None if math.isnan(value) else value


def _text(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)
