"""What must hold of every result, whatever its case; told from its files alone.

Each check takes the :class:`~pantograph_fem.stress.evidence.Evidence` of a run with at least one
state and returns what does not hold, or nothing.
"""

from __future__ import annotations

import numpy as np

from .evidence import Evidence
from .work import balance

#: Shares of the largest energy: rounding of a sum of parts, and of the state of rest.
_ROUNDING = 1e-9
#: An eigenvalue of a critical state, in typical energies, which is zero for all that is known.
_ZERO = 1e-5
#: Loads closer than this are equal.
_SAME_LOAD = 1e-12


def finite(found: Evidence) -> str:
    """Every number is one; an eigenvalue may be missing."""
    for name, values in found.history.items():
        if name != "lowest_eigenvalue" and not np.isfinite(values.astype(float)).all():
            return f"{name} is not finite"
    return ""


def energies(found: Evidence) -> str:
    """No part of the energy is negative, and they add up."""
    parts = [v for name, v in found.history.items() if name.startswith("energy_")]
    total = found.column("energy")
    slack = _ROUNDING * found.energy_scale
    if min(float(part.min()) for part in parts) < -slack:
        return "a part of the energy is negative"
    if np.abs(np.sum(parts, axis=0) - total).max() > slack:
        return "the parts of the energy do not add up"
    return ""


def begins_at_rest(found: Evidence) -> str:
    """The first state is that of no load, without energy."""
    if found.column("load")[0] != 0.0:
        return "the path does not begin at load 0"
    if found.column("energy")[0] > _ROUNDING * found.energy_scale:
        return "there is energy at load 0"
    return ""


def reaches_its_end(found: Evidence) -> str:
    """A path that is done is at full load, or at the critical one where it was to stop."""
    if not found.done:
        return ""
    status, options = found.summary.get("status"), found.case.continuation
    if status == "stopped at a critical load" and options.on_instability == "stop":
        steps = [point["step"] for point in found.critical_points]
        return "" if found.history["step"][-1] in steps else "it stopped at no critical load"
    if status != "done":
        return f"exit code 0, with the status {status!r}"
    return "" if found.last("load") == 1.0 else f"done at load {found.last('load'):.6g}"


def visits_the_stops(found: Evidence) -> str:
    """The states at the stops are there, as far as the path came, and loads rise where they must.

    By arc length the load may turn back; by load it may not.
    """
    load, options = found.column("load"), found.case.continuation
    if options.method == "load" and np.diff(load).min(initial=1.0) <= -_SAME_LOAD:
        return "the load falls"
    missed = [s for s in options.stops if s <= load.max() and s not in load]
    return f"there is no state at the stop {missed[0]:.6g}" if missed else ""


def stability_is_told(found: Evidence) -> str:
    """`stable` is what the inertia says, and the eigenvalue has the sign that goes with it."""
    stable, excess = found.history["stable"], found.excess
    if (excess < 0).any():
        return "there are fewer negative pivots than multipliers"
    if (stable & (excess != 0)).any():
        return "a state with excess negative pivots is called stable"
    critical = np.isin(found.history["step"], [point["step"] for point in found.critical_points])
    if (~stable & (excess == 0) & ~critical).any():  # a critical one may have a pivot of zero
        return "a state without excess negative pivots is called unstable"
    if "lowest_eigenvalue" not in found.history:
        return ""
    lowest = found.column("lowest_eigenvalue")
    told = np.isfinite(lowest) & ~(critical & (np.abs(lowest) < _ZERO))
    wrong = told & ((lowest > 0.0) != stable)
    if wrong.any():
        i = int(np.flatnonzero(wrong)[0])
        return (
            f"at load {found.column('load')[i]:.6g} inertia and the lowest eigenvalue disagree: "
            f"{excess[i]} excess pivots, {lowest[i]:.3g}"
        )
    return ""


def changes_are_located(found: Evidence) -> str:
    """Where the path loses stability, or more of it, or regains it, there is a critical point.

    At a critical point the excess of negative pivots changes by as many modes as are critical.
    """
    stable, excess = found.history["stable"], found.excess
    modes = {point["step"]: int(point.get("modes", 1)) for point in found.critical_points}
    critical = [modes.get(step, 0) for step in found.history["step"]]
    for i, change in enumerate(np.diff(excess)):
        here = critical[i] + critical[i + 1]
        load = found.column("load")[i + 1]
        if stable[i] and not stable[i + 1] and not here:
            return f"stability is lost before load {load:.6g}, at no critical point"
        if abs(change) > here:
            return (
                f"before load {load:.6g} excess negative pivots change from {excess[i]} to "
                f"{excess[i + 1]}, at {here or 'no'} critical point{'s' * (here > 1)}"
            )
    return ""


def energy_is_work(found: Evidence) -> str:
    """The energy is the work of grips and loads, within what interpolation explains."""
    known = balance(found)
    if known is None or known.holds:
        return ""
    return (
        f"energy and work differ by {known.defect:.2g} of the energy, of which the steps "
        f"explain {known.uncertainty:.2g}"
    )


#: Those that hold of the states of any run whose numbers are finite.
ALWAYS = (
    energies,
    begins_at_rest,
    reaches_its_end,
    visits_the_stops,
    stability_is_told,
    changes_are_located,
)
