"""Figures of a finished run, from its files alone."""

from __future__ import annotations

from pathlib import Path

from .case import load_case
from .errors import CaseError
from .results.draw import draw_all


def plot(directory: Path) -> list[Path]:
    """Redraw ``DIR/figures/*.png`` and return their paths.

    Raises
    ------
    CaseError
        If the directory holds no results of a run.
    """
    if not (directory / "case.resolved.toml").is_file():
        raise CaseError(
            f"{directory} holds no results: case.resolved.toml is missing. "
            "`pantograph run CASE.toml` writes them."
        )
    case = load_case(directory / "case.resolved.toml")
    return draw_all(directory, case)
