"""The figure ``sweep.png``: responses as curves, as maps, or as scattered points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ..case.problem import value_text
from .labels import key_label, scaled
from .map_panel import draw_map

if TYPE_CHECKING:
    from .sweep import SweepResult

Array = NDArray[np.float64]


def draw_sweep(result: SweepResult, path: Path) -> None:
    """Draw the responses: over one key, as maps over the two keys of a grid, or over each key.

    Crosses at the bottom are points without a value; hollow dots are unstable states.
    """
    study, responses = result.plan.study, result.plan.study.responses
    keys = study.vary
    as_map = len(keys) == 2 and study.design == "grid"
    rows, columns = (1, len(responses)) if as_map or len(keys) == 1 else (len(responses), len(keys))
    width = 4.4 if as_map else 3.8 if len(keys) == 1 else 2.2
    figure = Figure(figsize=(max(width * columns, 4.2), 0.5 + (3.1 if rows == 1 else 2.2 * rows)))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    grid = figure.subplots(rows, columns, squeeze=False, sharey="row" if rows > 1 else "none")
    for i, response in enumerate(responses):
        found = np.array([point.value(response) for point in result.points])
        values, name = scaled(response, found)
        if as_map:
            columns_of = list(zip(*result.plan.design.values, strict=True))
            ticks = [[_text(value) for value in _different(column)] for column in columns_of]
            shape = tuple(map(len, ticks))
            labels = [key_label(vary, result.plan.kind) for vary in keys]
            draw_map(grid[0, i], values.reshape(shape), ticks, labels, name)
            continue
        panels = grid[0, i : i + 1] if len(keys) == 1 else grid[i]
        for k, axes in enumerate(panels):
            _draw_points(axes, result, k, values)
            axes.set_xlabel(key_label(keys[k], result.plan.kind), parse_math=False)
            if k == 0:
                axes.set_ylabel(name, parse_math=False)
            if rows > 1 and i < rows - 1:
                axes.set_xlabel("")
    if study.title:
        figure.suptitle(fill(study.title, 24 * columns + 30), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _draw_points(axes: Axes, result: SweepResult, k: int, y: Array) -> None:
    """A response over a key: joined by a line where the key is all that changes."""
    vary = result.plan.study.vary[k]
    x, names = _places(result, k)
    known = np.isfinite(y)
    unstable = np.array([point.value("stable") == 0.0 for point in result.points])
    if len(result.plan.study.vary) == 1 and not names:
        order = np.argsort(x)  # with gaps where a value is missing
        axes.plot(x[order], y[order], "-", color="C0", linewidth=1.1)
    style: dict[str, Any] = {
        "color": "C0",
        "markersize": 3.5,
        "linestyle": "none",
        "clip_on": False,
    }
    bottom = axes.get_xaxis_transform()
    # one without points would have an extent without end, for which the figure makes room
    if (known & ~unstable).any():
        axes.plot(x[known & ~unstable], y[known & ~unstable], "o", **style)
    if (known & unstable).any():
        axes.plot(x[known & unstable], y[known & unstable], "o", **(style | {"mfc": "white"}))
    if not known.all():
        low = np.full(int((~known).sum()), 0.02)
        axes.plot(x[~known], low, "x", color="C3", markersize=5, transform=bottom)
    if names:
        axes.set_xticks(range(len(names)), names)
    elif vary.scale == "log":
        axes.set_xscale("log")
    else:
        axes.locator_params(axis="x", nbins=5 if len(result.plan.study.vary) == 1 else 3)
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.grid(which="major", color="0.9", linewidth=0.7)
    axes.spines[["top", "right"]].set_visible(False)


def _places(result: SweepResult, k: int) -> tuple[Array, list[str]]:
    """Places of the points along an axis, and names of the places where they are no numbers."""
    values: list[Any] = [values[k] for values in result.plan.design.values]
    if result.plan.study.vary[k].is_numeric:
        return np.array(values, dtype=float), []
    different = _different(values)
    places = [different.index(value) for value in values]
    return np.array(places, dtype=float), [_text(value) for value in different]


def _different(values: Sequence[Any]) -> list[Any]:
    """Each value once, in the order in which the points take them."""
    return [value for i, value in enumerate(values) if value not in values[:i]]


def _text(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else value_text(value)
