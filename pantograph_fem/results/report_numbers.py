"""The last state of a run as labelled numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from .column_texts import NEGLIGIBLE, largest_by_unit
from .units import column_unit, prefixed

#: What each kind of case is, and what exerts the force that is recorded.
KINDS = {
    "sheet": ("Pantographic sheet", "top grip"),
    "lattice": ("Lattice of springs", "top grip"),
    "beam": ("Extensible beam", "right end"),
    "chain": ("Chain of springs", "right end"),
}

_LABELS = {
    "shear_min": "Smallest shear angle",
    "shear_max": "Largest shear angle",
    "tip_ux": "Displacement x of the right end",
    "tip_uy": "Displacement y of the right end",
    "tip_angle": "Direction of the right end",
    "lowest_eigenvalue": "Lowest eigenvalue",
}


@dataclass(frozen=True)
class LabelledNumber:
    """A number with its unit as text, what it is, and a remark beside it."""

    label: str
    text: str
    note: str = ""


def last_state(history: Mapping[str, NDArray[Any]], kind: str) -> list[LabelledNumber]:
    """Return the numbers of the last row of a history; none where it has no row.

    Parameters
    ----------
    history
        Columns of ``history.csv``, each of shape (k,).
    kind
        Kind of the case.
    """
    if not len(history["load"]):
        return []
    last = {name: values[-1] for name, values in history.items()}
    where = KINDS[kind][1]
    units = {name: column_unit(name) for name in history}
    largest = largest_by_unit(history, units)

    def text(name: str) -> str:
        return _text(float(last[name]), units[name], largest.get(units[name], 0.0))

    numbers = [
        LabelledNumber("Load factor", f"{last['load']:.7g}", f"step {last['step']}"),
        LabelledNumber(f"Force x of the {where}", text("force_x")),
        LabelledNumber(f"Force y of the {where}", text("force_y")),
        LabelledNumber(f"Moment of the {where}", text("moment")),
        LabelledNumber("Energy", text("energy")),
    ]
    parts = [name for name in last if name.startswith("energy_")]
    for name in parts:
        if history[name].any():  # an effect that is absent has none at any state
            effect = name.removeprefix("energy_").replace("_", " ")
            share = f"{last[name] / last['energy']:.1%}" if last["energy"] > 0 else ""
            numbers.append(LabelledNumber(f"Energy of {effect}", text(name), share))
    planar = kind in ("sheet", "lattice")
    for name, label in _LABELS.items():
        if name in last and (planar or not name.startswith("shear_")):
            numbers.append(LabelledNumber(label, text(name)))
    surplus = last["negative_pivots"] - last["expected_negative_pivots"]
    note = "" if last["stable"] else f"{surplus:+d} negative pivots"
    numbers.append(LabelledNumber("Stable", "yes" if last["stable"] else "no", note))
    return numbers


def _text(value: float, unit: str, largest: float) -> str:
    """A value with its unit; it is zero where it is so up to rounding."""
    if abs(value) <= NEGLIGIBLE * largest:
        value = 0.0
    if unit in ("", "rad"):
        return f"{value:.5g} {unit}".strip()
    factor, label = prefixed(value, unit)
    return f"{factor * value:.6g} {label}"
