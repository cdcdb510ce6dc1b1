"""Units of the columns of a history, and prefixes, so that the numbers in a figure are short."""

from __future__ import annotations

import math
import re

#: Largest first; a prefix is used from half of it on, so that a beam of 1 m is drawn in metres.
PREFIXES = {1e9: "G", 1e6: "M", 1e3: "k", 1.0: "", 1e-3: "m", 1e-6: "µ"}

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def prefixed(size: float, unit: str) -> tuple[float, str]:
    """Return the factor on SI values and the unit's name with the prefix for values of a size.

    Values of no size, or below the smallest prefix, have no prefix.
    """
    step = next((step for step in PREFIXES if abs(size) >= 0.5 * step), 1.0)
    return 1.0 / step, PREFIXES[step] + unit


def power_of_ten(size: float) -> tuple[float, str]:
    """Return the factor on pure numbers of a size and the power of ten, as ``10⁻³``, or ``""``."""
    if size == 0 or 0.1 <= abs(size) < 1e4:
        return 1.0, ""
    exponent = 3 * math.floor(math.log10(abs(size)) / 3)
    return 10.0**-exponent, f"10{str(exponent).translate(_SUPERSCRIPTS)}"


#: SI unit of a column of ``history.csv`` by a pattern of its name.
_COLUMN_UNITS = {
    r"force(_[xy])?": "N",
    r"moment": "N m",
    r"energy(_\w+)?": "J",
    r"\w+_u[xy]": "m",
    r"shear_(min|max)|\w+_angle": "rad",
}


def column_unit(name: str) -> str:
    """SI unit of a column of ``history.csv``; empty for a number."""
    return next((u for pattern, u in _COLUMN_UNITS.items() if re.fullmatch(pattern, name)), "")
