"""Force-displacement and moment-rotation curves, and those of the top grip of a sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Panel:
    """Curves over the same axis: `x` of shape (k,), and arrays like it by the curve's name."""

    x: Array
    curves: Mapping[str, Array]
    xlabel: str
    ylabel: str


def grip_panels(
    history: Mapping[str, NDArray[Any]], translation: tuple[float, float], rotation: float
) -> list[Panel]:
    """Return what the top grip exerts against how it moves.

    A grip that translates gives the force along its translation; one that also rotates, the force
    across as well, and the moment against the rotation; one that only rotates, the moment alone.
    If it does neither, the magnitude of the force is given against the load factor.

    Parameters
    ----------
    history
        Columns of ``history.csv``.
    translation
        Translation of the top grip at full load, relative to the bottom grip, in m.
    rotation
        Rotation of the top grip at full load, in degrees.
    """
    load = history["load"]
    force = np.column_stack([history["force_x"], history["force_y"]])
    distance = float(np.hypot(*translation))
    panels = []
    if distance > 0:
        along = np.array(translation) / distance
        curves = {"along the translation": force @ along}
        if rotation:
            curves["across, to its left"] = force @ np.array([-along[1], along[0]])
        ylabel = "force (N)" if rotation else "force along the translation (N)"
        panels.append(Panel(1e3 * distance * load, curves, "grip displacement (mm)", ylabel))
    if rotation:
        curves = {"moment": history["moment"]}
        panels.append(Panel(rotation * load, curves, "grip rotation (degrees)", "moment (N m)"))
    if not panels:
        curves = {"force": np.hypot(*force.T)}
        panels.append(Panel(load, curves, "load factor", "magnitude of the force (N)"))
    return panels


def draw_force(panels: Sequence[Panel], stable: NDArray[np.bool_], path: Path, title: str) -> None:
    """Draw the panels side by side: a dot per accepted state, hollow and red where unstable.

    Parameters
    ----------
    panels
        What to draw, as `grip_panels` or `end_panels` gives it.
    stable
        Whether each state is stable, shape (k,).
    path
        The PNG file to write.
    title
        Written above.
    """
    figure = Figure(figsize=(0.5 + 4.5 * len(panels), 3.6))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    for axes, panel in zip(np.ravel(figure.subplots(1, len(panels))), panels, strict=True):
        for i, (name, y) in enumerate(panel.curves.items()):
            colour = f"C{i}"
            axes.plot(panel.x, y, color=colour, linewidth=1.0, label=name)
            axes.plot(panel.x[stable], y[stable], "o", color=colour, markersize=4)
            axes.plot(panel.x[~stable], y[~stable], "o", color="red", mfc="white", markersize=5)
        handles = axes.get_legend_handles_labels()[0] if len(panel.curves) > 1 else []
        if not stable.all():
            hollow = Line2D([], [], color="red", marker="o", mfc="white", linestyle="none")
            hollow.set_label("unstable")
            handles.append(hollow)
        if handles:
            axes.legend(handles=handles, frameon=False, fontsize="small")
        axes.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
        axes.set(xlabel=panel.xlabel, ylabel=panel.ylabel)
        axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle(fill(title, 55 * len(panels)), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
