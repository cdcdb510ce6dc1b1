"""The table ``history.csv``: one row per accepted step."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CaseError
from .atomic import replace_text

INTEGERS = ("step", "newton_iterations", "negative_pivots", "expected_negative_pivots")


@dataclass(frozen=True)
class HistoryRow:
    """An accepted state in numbers.

    Attributes
    ----------
    step
        Number of the step, from 0 or 1 as the path counts them.
    load
        Load factor t.
    force
        Force that the top grip, or the right end of a beam, exerts on what it holds, in N.
    moment
        Moment that it exerts about its current centre, in N m.
    energies
        Energy in J by effect. "stretch", "bending" and "shear" have columns in every table, and
        count as 0 where they are absent; others, as "foundation", have theirs behind `shear_max`.
    newton_iterations
        Iterations of the step.
    negative_pivots, expected_negative_pivots
        Negative pivots of the tangent, and their number at a stable state.
    stable
        Whether the state is stable.
    shear_min, shear_max
        Extreme shear angles, in rad.
    probes
        Displacement (ux, uy) in m at each reference point of ``output.probes``.
    extra
        Further numbers by the name of their column, as "tip_angle", in SI units and rad.
    """

    step: int
    load: float
    force: tuple[float, float]
    moment: float
    energies: dict[str, float]
    newton_iterations: int
    negative_pivots: int
    expected_negative_pivots: int
    stable: bool
    shear_min: float
    shear_max: float
    probes: tuple[tuple[float, float], ...] = ()
    extra: dict[str, float] = field(default_factory=dict)

    @property
    def energy(self) -> float:
        """Energy of all effects, in J."""
        return sum(self.energies.values())

    def columns(self) -> dict[str, int | float]:
        """Return the row by column name, in the order of ``history.csv``; `stable` is 1 or 0."""
        row: dict[str, int | float] = {
            "step": int(self.step),
            "load": float(self.load),
            "force_x": float(self.force[0]),
            "force_y": float(self.force[1]),
            "moment": float(self.moment),
            "energy": float(self.energy),
            "energy_stretch": float(self.energies.get("stretch", 0.0)),
            "energy_bending": float(self.energies.get("bending", 0.0)),
            "energy_shear": float(self.energies.get("shear", 0.0)),
            "newton_iterations": int(self.newton_iterations),
            "negative_pivots": int(self.negative_pivots),
            "expected_negative_pivots": int(self.expected_negative_pivots),
            "stable": int(self.stable),
            "shear_min": float(self.shear_min),
            "shear_max": float(self.shear_max),
        }
        for effect, energy in self.energies.items():
            row.setdefault(f"energy_{effect}", float(energy))
        for name, value in self.extra.items():
            row[name] = float(value)
        for i, (ux, uy) in enumerate(self.probes):
            row[f"probe{i}_ux"] = float(ux)
            row[f"probe{i}_uy"] = float(uy)
        return row


def header(probes: int, extra_columns: Sequence[str] = ()) -> list[str]:
    """Return the column names of a table with so many probes and these columns before them."""
    origin, extra = ((0.0, 0.0),) * probes, dict.fromkeys(extra_columns, 0.0)
    row = HistoryRow(0, 0.0, (0.0, 0.0), 0.0, {}, 0, 0, 0, True, 0.0, 0.0, origin, extra)
    return list(row.columns())


class HistoryWriter:
    """Write ``history.csv`` row by row; each row is on disk when `write` returns.

    Parameters
    ----------
    path
        The file. An earlier one is replaced.
    probes
        Number of probes.
    kept
        Number of rows already in the file to go on from; later ones are dropped.
    extra_columns
        Names of the columns between those of every table and the probes: the energies of other
        effects as ``energy_<effect>``, then the names of `HistoryRow.extra`.

    Raises
    ------
    CaseError
        If the file has fewer than `kept` rows, or other columns.
    """

    def __init__(
        self, path: Path, probes: int, kept: int = 0, extra_columns: Sequence[str] = ()
    ) -> None:
        self._header = header(probes, extra_columns)
        lines = [",".join(self._header)]
        if kept:
            old = _complete_lines(path)[: kept + 1]
            if old[:1] != lines or len(old) < kept + 1:
                raise CaseError(
                    f"{path} cannot be continued after {kept} rows: it has fewer, or other columns"
                )
            lines = old
        path.parent.mkdir(parents=True, exist_ok=True)
        replace_text(path, "\n".join(lines) + "\n")
        self._file = path.open("a", encoding="utf-8")

    def write(self, row: HistoryRow) -> None:
        """Add a row, with floats in full precision."""
        columns = row.columns()
        if list(columns) != self._header:
            raise ValueError(
                f"the row, with {len(row.probes)} probes, has other columns than the table: "
                f"{', '.join(columns)} instead of {', '.join(self._header)}"
            )
        self._file.write(",".join(repr(value) for value in columns.values()) + "\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> HistoryWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()


def read_history(path: Path) -> dict[str, NDArray[Any]]:
    """Read a table as one array per column: counts as integers, `stable` as booleans.

    Raises
    ------
    CaseError
        If there is no such file, or it is not a table of a run.
    """
    rows = list(csv.reader(_complete_lines(path)))
    if not rows or not set(header(0)) <= set(rows[0]):
        raise CaseError(f"{path} is not the history of a run: its columns are not those expected")
    try:
        table = np.array(rows[1:], dtype=float).reshape(len(rows) - 1, len(rows[0]))
    except ValueError as error:
        raise CaseError(f"{path} is damaged: {error}") from error
    history: dict[str, NDArray[Any]] = dict(zip(rows[0], table.T, strict=True))
    for name in INTEGERS:
        history[name] = history[name].astype(int)
    history["stable"] = history["stable"].astype(bool)
    return history


def _complete_lines(path: Path) -> list[str]:
    # A run killed while it wrote leaves a last line without its end.
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise CaseError(
            f"{path} is missing. It is written by `pantograph run CASE.toml`."
        ) from error
    return text[: text.rfind("\n") + 1].splitlines()
