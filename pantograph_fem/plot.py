"""Figures of a finished run, from its files alone."""

from __future__ import annotations

from pathlib import Path

from .case import load_case
from .results.draw import draw_all


def plot(directory: Path) -> list[Path]:
    """Redraw ``DIR/figures/*.png`` and return their paths.

    Raises
    ------
    CaseError
        If the directory holds no results of a run.
    """
    case = load_case(directory / "case.resolved.toml")
    return draw_all(directory, case)
