"""The figure ``convergence.png``: relative differences to the reference against the parameter."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator, ScalarFormatter

from .comparison import Comparison


def draw_convergence(comparison: Comparison, path: Path) -> bool:
    """Draw the magnitudes of the relative differences, and say whether there was anything to draw.

    The legend gives the slope between the two finest runs of each quantity. The expected order,
    where the study has one, is a dashed line. Needs a reference and two runs with a parameter.
    """
    series = comparison.series
    curves = {}
    for quantity in comparison.quantities:
        numbers = [comparison.numbers.get((i, quantity)) for i in series]
        points = [
            (comparison.outcomes[n.run].entry.parameter, abs(n.relative_difference), n.order)
            for n in numbers
            if n is not None and abs(n.relative_difference) > 0
        ]
        if len(points) > 1:
            curves[quantity] = np.array(points, float).T
    if not curves:
        path.unlink(missing_ok=True)
        return False

    figure = Figure(figsize=(6.4, 3.8))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.08)
    axes = figure.subplots()
    for (quantity, (h, e, orders)), marker in zip(curves.items(), cycle("osD^v<>P"), strict=False):
        slope = "" if np.isnan(orders[-1]) else f"  {orders[-1]:.2f}"
        axes.loglog(h, e, marker=marker, markersize=4.5, linewidth=1.1, label=quantity + slope)
    if (order := comparison.study.expected_order) is not None:
        largest = max(curves.values(), key=lambda curve: curve[1][-1])
        h = largest[0]
        guide = 1.8 * largest[1][-1] * (h / h[-1]) ** order
        axes.loglog(h, guide, "--", color="0.5", linewidth=1.0, label=f"expected  {order:g}")
    ticks = sorted({float(p) for h, _, _ in curves.values() for p in h})
    axes.set_xticks(ticks)
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_locator(NullLocator())
    reference = comparison.outcomes[comparison.reference or 0].entry.label
    axes.set_xlabel(comparison.study.parameter, parse_math=False)
    axes.set_ylabel(fill(f"relative difference to {reference}", 44), parse_math=False)
    axes.grid(which="major", color="0.9", linewidth=0.7)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside right upper", frameon=False, fontsize="small", title="last slope")
    if comparison.study.title:
        axes.set_title(fill(comparison.study.title, 60), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)
    return True
