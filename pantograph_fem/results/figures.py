"""The figures of a run, drawn from what it left in its directory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .deformed_figure import QUANTITIES, draw_deformed
from .fields import XDMF_NAME, FieldSeries, read_fields
from .force_figure import draw_force, grip_panels
from .history import read_history


def draw_figures(
    directory: Path,
    *,
    title: str,
    fibre_angle: float,
    translation: tuple[float, float],
    rotation: float,
    stops: Sequence[float],
    line_spacing: float,
) -> list[Path]:
    """Draw ``figures/*.png`` in a results directory, in place of earlier ones.

    The sheet is drawn at every stop that was reached and at the last state saved, whose load in
    per cent is in the file's name: ``shear_angle_050.png``, ``energy_density_100.png``. A run that
    saved no fields has its force-displacement curve alone.

    Parameters
    ----------
    directory
        Results of a run, finished or not.
    title
        Title of the case.
    fibre_angle
        Angle from x to the first family of fibres, in degrees.
    translation
        Translation of the top grip at full load, relative to the bottom grip, in m.
    rotation
        Rotation of the top grip at full load, in degrees.
    stops
        Load factors of the stops.
    line_spacing
        Reference distance between neighbouring material lines of a family, in m.

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
    for quantity in QUANTITIES:
        for stale in figures.glob(f"{quantity}_[0-9]*.png"):
            stale.unlink()

    drawn = [figures / "force_displacement.png"]
    draw_force(grip_panels(history, translation, rotation), history["stable"], drawn[0], title)
    if not (directory / XDMF_NAME).exists():
        return drawn
    series = read_fields(directory)
    for index in stop_states(series, stops):
        percent = f"{100 * series.loads[index]:07.3f}".rstrip("0").rstrip(".")
        for quantity in QUANTITIES.keys() & series.fields(index).keys():
            drawn.append(figures / f"{quantity}_{percent}.png")
            draw_deformed(series, index, quantity, drawn[-1], line_spacing, fibre_angle, title)
    return sorted(drawn)


def stop_states(series: FieldSeries, stops: Sequence[float]) -> list[int]:
    """Return the numbers of the states at stops, and of the last one."""
    at_stop = np.isclose(series.loads[:, None], np.asarray(stops, float), rtol=0, atol=1e-9)
    reached = {int(index) for index in np.flatnonzero(at_stop.any(axis=1))}
    return sorted(reached | {len(series.loads) - 1})
