"""Pictures of a sheet or lattice: a file a state and quantity."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from .colours import QUANTITIES
from .deformed_figure import Painter, draw_deformed
from .fields import FieldSeries
from .figures import Pictures


def planar_pictures(painter: Painter, title: str) -> Pictures:
    """Return what draws states coloured by each quantity.

    The load in per cent is in the file's name: ``shear_angle_050.png``, ``energy_density_100.png``.
    """

    def draw(series: FieldSeries, indices: Sequence[int], figures: Path) -> list[Path]:
        drawn = []
        for index in indices:
            percent = f"{100 * series.loads[index]:07.3f}".rstrip("0").rstrip(".")
            for quantity in QUANTITIES.keys() & series.fields(index).keys():
                drawn.append(figures / f"{quantity}_{percent}.png")
                draw_deformed(series, index, quantity, drawn[-1], painter, title)
        return drawn

    return draw
