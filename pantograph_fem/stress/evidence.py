"""What a run leaves behind, read back: all that the judge knows of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import BeamCase, Case, ChainCase, LatticeCase, SheetCase
from ..errors import CaseError
from ..results.history import read_history
from ..study.process import Ended

Array = NDArray[np.float64]

#: Share of the typical energy that is none: that of strains of 1e-7.
_NOTHING = 1e-14


@dataclass(frozen=True, eq=False)
class Evidence:
    """A run as its files tell it.

    Attributes
    ----------
    case
        What was simulated.
    ended
        Exit code, CPU time and message.
    history
        ``history.csv`` by column; empty where there is none.
    summary
        ``summary.json``; empty where there is none.
    timed_out
        Whether it was ended because it took too long.
    """

    case: Case
    ended: Ended
    history: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    summary: Mapping[str, Any] = field(default_factory=dict)
    timed_out: bool = False

    @property
    def done(self) -> bool:
        """Whether the program says that it came to the end, or stopped where it was asked to."""
        return self.ended.code == 0

    @property
    def rows(self) -> int:
        """Number of states."""
        return len(self.history.get("load", ()))

    @property
    def critical_points(self) -> list[dict[str, Any]]:
        """Step, load, kind and number of modes of each."""
        return list(self.summary.get("critical_points", ()))

    @property
    def excess(self) -> NDArray[np.int64]:
        """Negative pivots of each state beyond those of a stable one."""
        return np.asarray(
            self.history["negative_pivots"] - self.history["expected_negative_pivots"]
        )

    @property
    def energy_scale(self) -> float:
        """Energy that others are compared with, J: the largest on the path.

        At least what rounding makes of the typical energy, stiffness times area or length.
        """
        return max(
            float(np.abs(self.column("energy")).max()), _NOTHING * _typical_energy(self.case)
        )

    def column(self, name: str) -> Array:
        """A column of the history, or "force", the size of the force, N."""
        if name == "force":
            return np.hypot(self.history["force_x"], self.history["force_y"])
        return np.asarray(self.history[name], dtype=float)

    def last(self, name: str) -> float:
        """That of the last state."""
        return float(self.column(name)[-1])


def read_evidence(case: Case, ended: Ended, directory: Path, timed_out: bool = False) -> Evidence:
    """Read the files of a run; those that are missing or damaged are empty."""
    try:
        history: Mapping[str, NDArray[Any]] = read_history(directory / "history.csv")
    except CaseError:
        history = {}
    try:
        summary = json.loads((directory / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        summary = {}
    return Evidence(case, ended, history, summary, timed_out)


def _typical_energy(case: Case) -> float:
    if isinstance(case, SheetCase | LatticeCase):
        stiffness = max(*(case.material.stretch_pair or (0.0, 0.0)), case.material.shear or 0.0)
        return stiffness * case.sheet.width * case.sheet.height
    if isinstance(case, BeamCase | ChainCase):
        return (case.material.stretch or 0.0) * case.beam.length
    return 0.0
