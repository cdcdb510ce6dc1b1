"""Pictures of a beam or chain: its shapes, and its strains along the abscissa."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .fields import FieldSeries
from .figures import Pictures
from .profiles_figure import draw_profiles
from .shapes_figure import draw_shapes


def axis_pictures(title: str) -> Pictures:
    """Return what draws ``shapes.png`` and ``profiles.png``, each with all states."""

    def draw(series: FieldSeries, indices: Sequence[int], figures: Path) -> list[Path]:
        shapes, profiles = figures / "shapes.png", figures / "profiles.png"
        draw_shapes(series, indices, shapes, title)
        draw_profiles(series, indices, profiles, title)
        return [shapes, profiles]

    return draw
