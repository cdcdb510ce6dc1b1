"""The figures of a case: its sections, put as the numbers that the drawing needs."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .figures import Panels, Pictures, draw_figures

if TYPE_CHECKING:
    from ..case import BeamCase, Case, ChainCase, LatticeCase, SheetCase
    from ..case.ends import End
    from ..case.grips import Grip


def draw_all(directory: Path, case: Case) -> list[Path]:
    """Draw ``figures/*.png`` from the results of a case and return their paths.

    Only what draws the case's kind is imported.

    Raises
    ------
    CaseError
        If the directory holds no results.
    """
    title = case.title or case.name
    panels, pictures = _PARTS[case.kind](case, title)
    return draw_figures(
        directory,
        title=title,
        stops=case.continuation.stops,
        panels=panels,
        pictures=pictures,
    )


def _sheet(case: SheetCase, title: str) -> tuple[Panels, Pictures]:
    from .planar_pictures import planar_pictures
    from .sheet_picture import sheet_painter

    painter = sheet_painter(case.output.line_spacing, case.sheet.fibre_angle)
    return _grip_panels(case), planar_pictures(painter, title)


def _lattice(case: LatticeCase, title: str) -> tuple[Panels, Pictures]:
    from .lattice_picture import paint_links
    from .planar_pictures import planar_pictures

    return _grip_panels(case), planar_pictures(paint_links, title)


def _beam(case: BeamCase | ChainCase, title: str) -> tuple[Panels, Pictures]:
    from .axis_pictures import axis_pictures
    from .end_panels import EndLoading, end_panels

    left, right = case.ends.left, case.ends.right
    end = EndLoading(
        translation=_relative(right, left),
        rotation=right.rotation,
        clamped=right.support == "clamped",
        force=right.force,
        moment=right.moment,
    )
    return partial(end_panels, end=end), axis_pictures(title)


_PARTS: dict[str, Callable[[Any, str], tuple[Panels, Pictures]]] = {
    "sheet": _sheet,
    "lattice": _lattice,
    "beam": _beam,
    "chain": _beam,
}


def _grip_panels(case: SheetCase | LatticeCase) -> Panels:
    from .force_figure import grip_panels

    top, bottom = case.grips.top, case.grips.bottom
    return partial(grip_panels, translation=_relative(top, bottom), rotation=top.rotation)


def _relative(moved: Grip | End, other: Grip | End) -> tuple[float, float]:
    """Translation of a grip or end relative to another, in m."""
    (x, y), (x0, y0) = moved.translation, other.translation
    return x - x0, y - y0
