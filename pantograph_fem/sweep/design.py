"""Points of a sweep: grids, space-filling designs, and those of sensitivity indices."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from ..errors import CaseError
from .study import SENSITIVITY, SweepStudy
from .vary import Value

if TYPE_CHECKING:
    from collections.abc import Mapping

Array = NDArray[np.float64]

#: Levels of the grid on which Morris's trajectories run, as usual.
LEVELS = 4


@dataclass(frozen=True, eq=False)
class Design:
    """Points of a sweep.

    Attributes
    ----------
    values
        Of each varied key at each point, n points of k values.
    unit
        The same in the unit cube, from which they are scaled, shape (n, k); None for a grid.
    """

    values: tuple[tuple[Value, ...], ...]
    unit: Array | None = None


def make_design(study: SweepStudy) -> Design:
    """The points of a sweep, in order; in a grid the last key changes first.

    Raises
    ------
    CaseError
        If the design needs SALib and that is not installed.
    """
    if study.design == "grid":
        axes = []
        for vary in study.vary:
            places = np.linspace(0.0, 1.0, vary.count or 2)
            axes.append(vary.values or tuple(vary.at(u) for u in places))
        return Design(tuple(product(*axes)))
    unit = _unit_points(study)
    values = tuple(
        tuple(vary.at(u) for vary, u in zip(study.vary, row, strict=True)) for row in unit.tolist()
    )
    return Design(values, unit)


def unit_problem(study: SweepStudy) -> Mapping[str, object]:
    """The varied keys over the unit cube, as SALib describes them.

    Effects are then changes over the whole range of a key, whatever its unit and scale.
    """
    keys = [vary.key for vary in study.vary]
    return {"num_vars": len(keys), "names": keys, "bounds": [[0.0, 1.0]] * len(keys)}


def _unit_points(study: SweepStudy) -> Array:
    count, keys, samples = len(study.vary), study.vary, study.samples
    assert samples is not None
    if study.design == "latin_hypercube":
        return qmc.LatinHypercube(count, seed=study.seed).random(samples)
    if study.design == "sobol":
        return qmc.Sobol(count, seed=study.seed).random(samples)
    assert study.design in SENSITIVITY
    assert len(keys) == count
    try:
        from SALib.sample import morris, sobol
    except ImportError as error:
        raise CaseError(
            f'design = "{study.design}" needs SALib, which cannot be imported ({error}); '
            "pip install '.[sweep]' installs it"
        ) from None
    problem = dict(unit_problem(study))
    if study.design == "morris":
        # SALib takes a seed of 0 for none
        return morris.sample(problem, samples, num_levels=LEVELS, seed=study.seed + 1)
    return sobol.sample(problem, samples, calc_second_order=False, seed=study.seed)
