"""The figures of a case: its sections, put as the numbers that the drawing needs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .figures import draw_figures

if TYPE_CHECKING:
    from ..case import Case


def draw_all(directory: Path, case: Case) -> list[Path]:
    """Draw ``figures/*.png`` from the results of a case and return their paths.

    Raises
    ------
    CaseError
        If the directory holds no results.
    """
    top, bottom = case.grips.top, case.grips.bottom
    return draw_figures(
        directory,
        title=case.title or case.name,
        fibre_angle=case.sheet.fibre_angle,
        translation=(
            top.translation[0] - bottom.translation[0],
            top.translation[1] - bottom.translation[1],
        ),
        rotation=top.rotation,
        stops=case.continuation.stops,
        line_spacing=case.output.line_spacing,
    )
