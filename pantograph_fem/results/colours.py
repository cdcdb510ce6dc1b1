"""Which colours show a field: the map, and the values at its ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, LinearSegmentedColormap
from numpy.typing import NDArray

from .fields import FieldGrid

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """How a field is named and coloured; `clipped` ends the colours at the 99th percentile."""

    label: str
    colours: str
    clipped: bool = False


QUANTITIES = {
    "shear_angle": Quantity("shear angle (rad)", "viridis"),
    "energy_density": Quantity("energy density (J/m²)", "magma", clipped=True),
}


@dataclass(frozen=True)
class ColourScale:
    """Colours of a field: the map, the values at its ends, and the ends that values exceed."""

    colours: Colormap
    lowest: float
    highest: float
    exceeded: str


def colour_scale(values: Array, weights: Array, quantity: Quantity) -> ColourScale:
    """Choose colours: diverging about 0 where the sign changes, else light at 0 to dark.

    Parameters
    ----------
    values
        The field at the nodes, shape (n,).
    weights
        Reference area or length that each node stands for, shape (n,); percentiles are of these,
        for refined corners have more nodes than the rest.
    quantity
        What the field is.
    """
    lowest, highest = float(values.min()), float(values.max())
    size = max(-lowest, highest)
    if size < 1e-12:  # rad or J/m²: rounding
        return ColourScale(_shades(quantity.colours), 0.0, 1.0, "neither")
    # A few per cent of the other sign, at a corner or from rounding, are no change of sign.
    if min(-lowest, highest) > 0.05 * size:
        return ColourScale(colormaps["RdBu_r"], -size, size, "neither")
    if -lowest > highest:
        return ColourScale(
            _shades(quantity.colours).reversed(), lowest, max(highest, 0.0), "neither"
        )
    # An energy confined to less than the last per cent is shown to its peak.
    clip = (quantity.clipped and weighted_percentile(values, weights, 99.0)) or highest
    return ColourScale(
        _shades(quantity.colours), min(lowest, 0.0), clip, "max" if clip < highest else "neither"
    )


def weighted_percentile(values: Array, weights: Array, percent: float) -> float:
    """Return the value that is not exceeded on so many per cent of the weights."""
    order = np.argsort(values)
    share = np.cumsum(weights[order]) / weights.sum()
    index = min(int(np.searchsorted(share, percent / 100.0)), len(values) - 1)
    return float(values[order[index]])


def node_weights(grid: FieldGrid) -> Array:
    """Return the part of the reference that is each node's, shape (n,).

    That is a third of the areas of the triangles around it, in m², or half the lengths of the lines
    that meet there, in m.
    """
    corners = [grid.points[grid.cells[:, i]] for i in range(grid.cells.shape[1])]
    if len(corners) == 3:
        (ux, uy), (vx, vy) = (corners[1] - corners[0]).T, (corners[2] - corners[0]).T
        parts = np.abs(ux * vy - uy * vx) / 6.0
    else:
        parts = np.linalg.norm(corners[1] - corners[0], axis=1) / 2.0
    shares = np.zeros(len(grid.points))
    np.add.at(shares, grid.cells, parts[:, None])
    return shares


def _shades(name: str) -> Colormap:
    # Without the darkest third, on which black lines would not be seen.
    shades = colormaps[name](np.linspace(1.0, 0.3, 256))
    return LinearSegmentedColormap.from_list(f"{name}_shades", shades)
