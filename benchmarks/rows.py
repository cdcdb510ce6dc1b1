"""Measurements, one dataclass a row, as a table in a file."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def write_rows(path: Path, rows: Sequence[DataclassInstance], digits: int) -> None:
    """Write a header and at least one row, with so many digits of each float."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(field.name for field in fields(rows[0]))
        writer.writerows(
            [f"{v:.{digits}g}" if isinstance(v, float) else v for v in asdict(row).values()]
            for row in rows
        )
