"""What the right end of a beam or chain exerts or carries, against how it moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .force_figure import Panel
from .units import prefixed

Array = NDArray[np.float64]
History = Mapping[str, NDArray[Any]]

#: Displacement across a force, over the one along it, that is rounding.
ROUNDING = 1e-6


@dataclass(frozen=True)
class EndLoading:
    """How the right end is driven or loaded at full load.

    Attributes
    ----------
    translation
        Its translation relative to the left end, in m.
    rotation
        Its rotation about a pivot, in degrees.
    clamped
        Whether its direction turns by `rotation` too; otherwise it is free to rotate.
    force
        Dead force on it, in N.
    moment
        Dead moment on it, in N m.
    """

    translation: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    clamped: bool = False
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0


def end_panels(history: History, end: EndLoading) -> list[Panel]:
    """Return the curves of a driven or loaded end, whichever of these there are.

    - translated: force along the translation, and across if the end is turned too, against the
      displacement;
    - turned alone: force in x and y against the angle travelled;
    - turned and clamped: the moment against the angle;
    - loaded by a force: its magnitude against the displacement along it, and across it;
    - loaded by a moment: the moment against the angle by which the end has turned.

    If there is none of them, the magnitude of the force is given against the load factor.

    Parameters
    ----------
    history
        Columns of ``history.csv``; of a loaded end ``tip_ux``, ``tip_uy`` (m) and ``tip_angle``
        (rad) too.
    end
        How the end is driven or loaded.
    """
    panels = [*_driven(history, end), *_loaded(history, end)]
    if panels:
        return panels
    force, unit = _readable(np.hypot(history["force_x"], history["force_y"]), "N")
    return [Panel(history["load"], {"force": force}, "load factor", f"magnitude of force ({unit})")]


def _driven(history: History, end: EndLoading) -> list[Panel]:
    load, angle = history["load"], end.rotation * history["load"]
    force = np.column_stack([history["force_x"], history["force_y"]])
    distance = float(np.hypot(*end.translation))
    panels = []
    if distance:
        along, across = _directions(end.translation)
        names = ["along the translation", "across, to its left"][: 2 if end.rotation else 1]
        drawn, force_unit = _readable(force @ np.transpose([along, across])[:, : len(names)], "N")
        curves = dict(zip(names, drawn.T, strict=True))
        label = "force" if end.rotation else "force along the translation"
        displacement, unit = _readable(distance * load, "m")
        panels.append(
            Panel(displacement, curves, f"end displacement ({unit})", f"{label} ({force_unit})")
        )
    elif end.rotation:
        drawn, force_unit = _readable(force, "N")
        curves = dict(zip(["in x", "in y"], drawn.T, strict=True))
        panels.append(Panel(angle, curves, "angle travelled (degrees)", f"force ({force_unit})"))
    if end.rotation and end.clamped:
        moment, unit = _readable(history["moment"], "N m")
        panels.append(
            Panel(angle, {"moment": moment}, "end rotation (degrees)", f"moment ({unit})")
        )
    return panels


def _loaded(history: History, end: EndLoading) -> list[Panel]:
    load = history["load"]
    panels = []
    if size := float(np.hypot(*end.force)):
        force, force_unit = _readable(size * load, "N")
        tip = np.column_stack([history["tip_ux"], history["tip_uy"]])
        along, across = (tip @ direction for direction in _directions(end.force))
        for name, values in (("along the force", along), ("across it, to its left", across)):
            if values is across and np.abs(across).max() <= ROUNDING * np.abs(along).max():
                continue
            displacement, unit = _readable(values, "m")
            label = f"end displacement {name} ({unit})"
            panels.append(Panel(displacement, {"force": force}, label, f"force ({force_unit})"))
    if end.moment:
        moment, unit = _readable(end.moment * load, "N m")
        turned = np.degrees(history["tip_angle"])
        panels.append(
            Panel(turned, {"moment": moment}, "end rotation (degrees)", f"moment ({unit})")
        )
    return panels


def _directions(vector: tuple[float, float]) -> tuple[Array, Array]:
    """Unit vectors along a vector, and to its left."""
    x, y = np.array(vector) / np.hypot(*vector)
    return np.array([x, y]), np.array([-y, x])


def _readable(values: Array, unit: str) -> tuple[Array, str]:
    factor, name = prefixed(float(np.abs(values).max(initial=0.0)), unit)
    return factor * values, name
