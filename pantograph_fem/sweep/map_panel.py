"""A response over the two keys of a grid, as a map of coloured cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

#: More cells than this are too small for their number.
_MOST_NUMBERS = 80

#: Ratio of largest to smallest from which colours follow the logarithm.
_LOG_FROM = 10.0


def draw_map(
    axes: Axes,
    values: NDArray[np.float64],
    ticks: Sequence[Sequence[str]],
    labels: Sequence[str],
    title: str,
) -> None:
    """Draw a cell per point, with its value; a crossed cell has none.

    Parameters
    ----------
    axes
        Where to draw.
    values
        Of the response, shape (m, n), over the first key along x and the second along y.
    ticks, labels
        Values and names of the two keys.
    title
        Name of the response.
    """
    found = np.ma.masked_invalid(values.T)
    spread = found.min() > 0 and found.max() > _LOG_FROM * found.min()
    image = axes.pcolormesh(
        found,
        cmap="viridis",
        norm=LogNorm() if spread else Normalize(),
        edgecolors="white",
        linewidth=0.5,
    )
    ticker: Any = {"ticks": LogLocator(subs=(1.0, 2.0, 5.0)), "format": "{x:g}"} if spread else {}
    bar = axes.figure.colorbar(image, ax=axes, **ticker)
    bar.minorticks_off()
    bar.ax.spines["outline"].set_visible(False)
    for i, j in np.ndindex(values.shape):
        place, value = (i + 0.5, j + 0.5), values[i, j]
        if np.isnan(value):
            axes.plot(*place, "x", color="0.5", markersize=8)
        elif values.size <= _MOST_NUMBERS:
            colour = "white" if image.norm(value) < 0.6 else "black"
            axes.text(*place, f"{value:.3g}", ha="center", va="center", color=colour, fontsize=7)
    for which, texts in zip("xy", ticks, strict=True):
        axis = getattr(axes, f"{which}axis")
        axis.set_ticks(np.arange(len(texts)) + 0.5, texts)
        axis.set_tick_params(length=0)
    if max(map(len, ticks[0])) * len(ticks[0]) > 30:
        axes.xaxis.set_tick_params(rotation=45)
    axes.set_xlabel(labels[0], parse_math=False)
    axes.set_ylabel(labels[1], parse_math=False)
    axes.set_title(title, fontsize="medium", parse_math=False)
    axes.spines[["top", "right", "bottom", "left"]].set_visible(False)
