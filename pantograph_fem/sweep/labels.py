"""What keys and outputs are called in figures, with their units."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ..compare.quantities import unit
from ..results.units import prefixed
from .vary import Vary

_PLANAR = {
    r"material\.stretch(\[\d\])?|material\.shear": "N/m",
    r"material\.bending(\[\d\])?": "N m",
}
_AXIS = {
    r"material\.stretch": "N",
    r"material\.bending": "N m²",
    r"material\.foundation": "N/m²",
}
_ANY = {
    r"sheet\.(width|height)|beam\.length": "m",
    r"sheet\.fibre_angle|(grips|ends)\.\w+\.rotation": "degrees",
    r"(grips|ends)\.\w+\.(translation|pivot)(\[\d\])?": "m",
    r"ends\.\w+\.force(\[\d\])?": "N",
    r"ends\.\w+\.moment": "N m",
    r"mesh\.(size|corner_size|grip_size)|(lattice|chain)\.spacing": "m",
}


def key_label(vary: Vary, kind: str) -> str:
    """Label of a varied key: the one given, or the key with its unit where that is known."""
    if vary.label:
        return vary.label
    units = _ANY | (_PLANAR if kind in ("sheet", "lattice") else _AXIS)
    found = next((u for pattern, u in units.items() if re.fullmatch(pattern, vary.key)), "")
    return f"{vary.key} ({found})" if found else vary.key


def output_label(name: str) -> str:
    """Label of an output, with its unit where it has one."""
    return f"{name} ({unit(name)})" if unit(name) else name


def scaled(name: str, values: NDArray[np.float64]) -> tuple[NDArray[np.float64], str]:
    """Values of an output in units in which they are short, and its label with that unit."""
    size = np.abs(values[np.isfinite(values)]).max(initial=0.0)
    if not unit(name) or unit(name) == "rad":
        return values, output_label(name)
    factor, prefix = prefixed(float(size), unit(name))
    return factor * values, f"{name} ({prefix})"
