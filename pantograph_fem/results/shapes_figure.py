"""Deformed shapes of a beam or chain on top of one another, as in Figs. 5 and 6."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .axis import Axis, add_legend, panels_beside_legend, state_colours
from .fields import FieldSeries
from .units import prefixed

WIDTH = 6.0  # inches, of the axes
LOWEST, HIGHEST = 1.6, 6.0  # inches, of the axes


def draw_shapes(series: FieldSeries, indices: Sequence[int], path: Path, title: str = "") -> None:
    """Draw the true shapes of some states, the reference, and the path of the right end.

    Parameters
    ----------
    series
        States of a run on a grid of lines.
    indices
        Which of them, in the order of their loads. The path goes through all up to the last.
    path
        The PNG file to write.
    title
        Written above.
    """
    axis = Axis.of(series.grid)
    scale, unit = prefixed(axis.length, "m")
    reference = scale * series.grid.points[axis.nodes]
    placements = np.array(
        [
            reference + scale * series.fields(index)["displacement"][axis.nodes]
            for index in range(max(indices) + 1)
        ]
    )
    shapes, end = placements[list(indices)], placements[:, -1]

    drawn = np.concatenate([reference, shapes.reshape(-1, 2), end])
    width, height = np.ptp(drawn, axis=0)
    figure = Figure(figsize=(WIDTH + 1.9, np.clip(WIDTH * height / width, LOWEST, HIGHEST) + 1.0))
    figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.1)
    (axes,), beside = panels_beside_legend(figure, 1)
    axes.set(xlabel=f"x ({unit})", ylabel=f"y ({unit})")
    axes.set_aspect("equal", adjustable="datalim")

    axes.plot(*reference.T, color="0.7", linewidth=2.5, solid_capstyle="round", zorder=1)
    axes.plot(*end.T, ":", color="0.35", linewidth=1.0, zorder=1.5)
    for shape, colour in zip(shapes, state_colours(len(shapes)), strict=True):
        axes.plot(*shape.T, color=colour, linewidth=1.5, marker=axis.marker, markersize=4)
        axes.plot(*shape[-1], "o", color=colour, markersize=4, zorder=3)
    others = [
        Line2D([], [], color="0.7", linewidth=2.5, label="reference"),
        Line2D([], [], color="0.35", linewidth=1.0, linestyle=":", label="path of the end"),
    ]
    add_legend(beside, series, indices, others)
    figure.suptitle(fill(title, 80), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
