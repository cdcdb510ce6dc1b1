"""The figure ``profile.png``: profile likelihood of each constant."""

from __future__ import annotations

from pathlib import Path
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator
from scipy.interpolate import CubicSpline
from scipy.stats import chi2

from .estimates import Estimate
from .identify import Identification
from .profile import Profile

#: Highest rise of χ² that is shown.
_HIGHEST = 8.0


def draw_profiles(found: Identification, path: Path) -> None:
    """Draw how much χ² rises along each constant, the others following.

    Dots are fits; the dashed parabola is what the standard error says. Where a curve rises above
    the line, a constant is outside of its interval.
    """
    number = len(found.profiles)
    figure = Figure(figsize=(0.4 + 3.0 * number, 3.4))
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.1)
    panels = np.ravel(figure.subplots(1, number, sharey=True, squeeze=False))
    bound = float(chi2.ppf(found.study.confidence, 1))
    for axes, estimate, profile, q in zip(
        panels, found.estimates, found.profiles, found.fit.q.tolist(), strict=True
    ):
        _draw(axes, estimate, profile, q, found.fit.chi2)
        axes.axhline(bound, color="C3", linewidth=0.9, linestyle=":")
        axes.set_ylim(-0.3, _HIGHEST)
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("rise of χ²")
    panels[0].text(
        0.5,
        bound + 0.15,
        f"{100 * found.study.confidence:g} %",
        color="C3",
        fontsize="small",
        ha="center",
        transform=panels[0].get_yaxis_transform(),
    )
    figure.suptitle(fill(found.study.title, 32 * number), fontsize="medium", parse_math=False)
    figure.savefig(path, dpi=200)


def _draw(axes: Axes, estimate: Estimate, profile: Profile, best: float, least: float) -> None:
    """One constant, over its coordinate, with ticks at its values."""
    parameter = estimate.parameter
    places = np.linspace(profile.q[0], profile.q[-1], 101)
    axes.plot(places, ((places - best) / estimate.deviation) ** 2, "--", color="0.5", linewidth=1.0)
    axes.plot(profile.q, profile.chi2 - least, "o", color="C0", markersize=4)
    if len(profile.q) > 3:
        spline = CubicSpline(profile.q, profile.chi2 - least)
        axes.plot(places, spline(places), color="C0", linewidth=1.2)
    axes.axvline(best, color="0.8", linewidth=0.8, zorder=0)
    axes.xaxis.set_major_locator(MaxNLocator(3))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda q, _: f"{parameter.value(q):.3g}"))
    axes.set_xlabel(
        f"{parameter.symbol} ({parameter.unit})" if parameter.unit else parameter.symbol
    )
