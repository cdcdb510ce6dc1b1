"""Sensitivity indices of the responses with respect to the varied keys, by SALib."""

from __future__ import annotations

import csv
import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..results.atomic import replace_text
from .design import LEVELS, unit_problem
from .plan import Plan
from .results import PointResult
from .study import SENSITIVITY

Array = NDArray[np.float64]

#: Names of the indices by design.
NAMES = {
    "morris": ("mu", "mu_star", "mu_star_conf", "sigma"),
    "saltelli": ("S1", "S1_conf", "ST", "ST_conf"),
}

#: Spread of a response, over its size, that is rounding and depends on nothing.
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Indices:
    """Sensitivity indices of a response.

    For "morris" they are the mean `mu` of the elementary effects, each the change of the response
    over the whole range of the key at the rate of one step; the mean `mu_star` of their
    magnitudes; and their standard deviation `sigma`, which is 0 where the response is linear in
    the key and does not interact. They have the unit of the response. For "saltelli" they are the
    parts of the variance of the response that are due to the key alone, `S1`, and with all its
    interactions, `ST`. Names with ``_conf`` are half widths of 95 % intervals.

    Attributes
    ----------
    response
        Name of the output.
    keys
        The varied keys.
    values
        By name of the index, see `NAMES`; each of shape (k,).
    samples, of
        Number of trajectories, or samples, that were used, and that there are.
    """

    response: str
    keys: tuple[str, ...]
    values: dict[str, Array]
    samples: int
    of: int


def sensitivity(
    plan: Plan, points: Sequence[PointResult]
) -> tuple[tuple[Indices, ...], tuple[str, ...]]:
    """Indices of the responses, and a sentence for each that has none or less than all samples.

    Trajectories of which a point failed are left out, as each is a sample by itself. Sobol indices
    need every point: without some they would be biased, and there are none.
    """
    study, unit = plan.study, plan.design.unit
    if study.design not in SENSITIVITY or unit is None:
        return (), ()
    indices, notes = [], []
    for response in study.responses:
        y = np.array([point.value(response) for point in points])
        missing = int(np.isnan(y).sum())
        if study.design == "saltelli" and missing:
            notes.append(
                f"No Sobol indices of {response}: {missing} of {len(y)} points have no value, and "
                "the indices of the others would be biased. Narrow the ranges, or let the runs "
                "arrive, e.g. with continuation.min_step."
            )
            continue
        size = len(study.vary) + (1 if study.design == "morris" else 2)
        samples = y.reshape(-1, size)
        whole = np.isfinite(samples).all(axis=1)
        if whole.sum() < 2:
            notes.append(f"No indices of {response}: fewer than two trajectories are complete.")
            continue
        if missing:
            notes.append(
                f"Indices of {response} are of {whole.sum()} of {len(whole)} trajectories; in the "
                "others a point has no value."
            )
        kept = samples[whole].ravel()
        if np.ptp(kept) <= _ROUNDING * np.abs(kept).max():
            notes.append(f"No indices of {response}: it is the same at all points.")
            continue
        values = _analysed(plan, unit[np.repeat(whole, size)], kept)
        keys = tuple(vary.key for vary in study.vary)
        indices.append(Indices(response, keys, values, int(whole.sum()), len(whole)))
    return tuple(indices), tuple(notes)


def write_indices(indices: Sequence[Indices], design: str, path: Path) -> bool:
    """Write a row per response and key, and say whether there is one."""
    if not indices:
        path.unlink(missing_ok=True)
        return False
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = NAMES[design]
    writer.writerow(("response", "key", *names, "samples"))
    for found in indices:
        for i, key in enumerate(found.keys):
            row = (repr(float(found.values[name][i])) for name in names)
            writer.writerow((found.response, key, *row, found.samples))
    replace_text(path, text.getvalue())
    return True


def _analysed(plan: Plan, x: Array, y: Array) -> dict[str, Array]:
    from SALib.analyze import morris, sobol

    study = plan.study
    problem = dict(unit_problem(study))
    seed = study.seed + 1  # SALib takes 0 for none
    with warnings.catch_warnings():
        # of pandas, about how SALib calls it
        warnings.simplefilter("ignore", FutureWarning)
        if study.design == "morris":
            found = morris.analyze(problem, x, y, num_levels=LEVELS, seed=seed)
        else:
            found = sobol.analyze(problem, y, calc_second_order=False, seed=seed)
    return {name: np.asarray(found[name], dtype=float) for name in NAMES[study.design]}
