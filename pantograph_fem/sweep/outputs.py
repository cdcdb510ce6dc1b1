"""Outputs of the points of a sweep: which there are, and what a run has left of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..case.messages import case_error
from ..case.problem import not_allowed
from ..compare.quantities import FORCE
from ..errors import CaseError
from ..results.history import header, read_history

#: Loads that differ by less are the same.
_SAME_LOAD = 1e-9

_STANDARD = (FORCE, "force_x", "force_y", "energy", "energy_stretch", "energy_bending")
_TIP = ("tip_ux", "tip_uy", "tip_angle")


def choose_outputs(case: Any, outputs: Sequence[str], responses: Sequence[str]) -> tuple[str, ...]:
    """Outputs of a sweep: those asked for, else the default of the kind of case and the responses.

    Raises
    ------
    CaseError
        When a run of the case has no such output.
    """
    is_planar, foundation = hasattr(case, "grips"), getattr(case.material, "foundation", None)
    parts = ("energy_shear",) if is_planar else ("energy_foundation",) if foundation else ()
    chosen = tuple(outputs) or tuple(dict.fromkeys((*_STANDARD, *parts, "stable", *responses)))
    allowed = dict.fromkeys([FORCE, *header(len(case.output.probes)), *parts])
    allowed.update(dict.fromkeys(() if is_planar else _TIP))
    for name, measurement in getattr(case, "measurements", {}).items():
        allowed.update(dict.fromkeys(measurement.columns(name)))
    if case.output.eigenvalues:
        allowed["lowest_eigenvalue"] = None
    rule = f"be one of {', '.join(allowed)}"
    problems = [f"outputs: {not_allowed(name, rule)}" for name in chosen if name not in allowed]
    if problems:
        raise case_error("The sweep", problems)
    return chosen


def read_outputs(
    directory: Path, outputs: Sequence[str], stops: Sequence[float], at_end: bool
) -> dict[str, float]:
    """Outputs that the run in a folder has found.

    Parameters
    ----------
    directory
        Results of a run.
    outputs
        Their names.
    stops
        Loads below 1 at which they are wanted, too; those that the run has not reached are left
        out.
    at_end
        Whether the run came to its end, so that the last state counts.

    Returns
    -------
    dict
        By name, in SI units; ``<name>@<load>`` at the stops. "load" and "steps" of the last state
        are always there, unless there is no state.
    """
    try:
        history = read_history(directory / "history.csv")
    except CaseError:
        return {}
    loads = history["load"]
    if not len(loads):
        return {}
    found = {"load": float(loads[-1]), "steps": float(history["step"][-1])}
    history[FORCE] = np.hypot(history["force_x"], history["force_y"])
    columns = {name: history[name] for name in outputs if name in history}
    for stop in stops:
        states = np.flatnonzero(np.abs(loads - stop) < _SAME_LOAD)
        if len(states):
            at = {at_stop(name, stop): float(c[states[-1]]) for name, c in columns.items()}
            found.update(at)
    if at_end:
        found.update((name, float(column[-1])) for name, column in columns.items())
    return found


def at_stop(output: str, stop: float) -> str:
    """Name of an output at a load fraction, as ``force@0.5``."""
    return f"{output}@{stop:.9g}"
