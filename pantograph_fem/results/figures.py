"""The figures of a run, drawn from what it left in its directory."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .fields import XDMF_NAME, FieldSeries, read_fields
from .force_figure import Panel, draw_force
from .history import read_history

#: Names of all figures but the force curve, which every run has.
PICTURES = ("shear_angle_[0-9]*.png", "energy_density_[0-9]*.png", "shapes.png", "profiles.png")

#: Makes the panels of ``force_displacement.png`` of the columns of ``history.csv``.
Panels = Callable[[Mapping[str, NDArray[Any]]], list[Panel]]
#: Draws states, given by their numbers, into a folder and returns the files.
Pictures = Callable[[FieldSeries, Sequence[int], Path], list[Path]]


def draw_figures(
    directory: Path,
    *,
    title: str,
    stops: Sequence[float],
    panels: Panels,
    pictures: Pictures,
) -> list[Path]:
    """Draw ``figures/*.png`` in a results directory, in place of earlier ones.

    The states at every stop that was reached and the last one saved are drawn. A run that saved no
    fields has its force-displacement curve alone.

    Parameters
    ----------
    directory
        Results of a run, finished or not.
    title
        Title of the case.
    stops
        Load factors of the stops.
    panels
        Makes the panels of ``force_displacement.png`` of the columns of ``history.csv``.
    pictures
        Draws the states.

    Returns
    -------
    list of Path
        The files, in the order of their names.

    Raises
    ------
    CaseError
        If the directory holds no results.
    """
    history = read_history(directory / "history.csv")
    figures = directory / "figures"
    figures.mkdir(exist_ok=True)
    for pattern in PICTURES:
        for stale in figures.glob(pattern):
            stale.unlink()

    drawn = [figures / "force_displacement.png"]
    draw_force(panels(history), history["stable"], drawn[0], title)
    if (directory / XDMF_NAME).exists():
        series = read_fields(directory)
        drawn += pictures(series, stop_states(series, stops), figures)
    return sorted(drawn)


def stop_states(series: FieldSeries, stops: Sequence[float]) -> list[int]:
    """Return the numbers of the states at stops, and of the last one."""
    at_stop = np.isclose(series.loads[:, None], np.asarray(stops, float), rtol=0, atol=1e-9)
    reached = {int(index) for index in np.flatnonzero(at_stop.any(axis=1))}
    return sorted(reached | {len(series.loads) - 1})
