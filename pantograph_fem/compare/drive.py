"""What drives a case: the displacement against which its curves are drawn."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Drive:
    """How a case is driven.

    Attributes
    ----------
    name
        What goes along the axis of its curves.
    distance
        Displacement at full load, m; 0 where nothing is translated.
    """

    name: str
    distance: float = 0.0


#: Of cases that are driven otherwise, and of those that are not driven alike.
LOAD = Drive("load factor")


def drive_of(case: Any) -> Drive:
    """How the case is driven: by its grips, by the right end of a beam, or otherwise.

    Parameters
    ----------
    case
        A case of any kind; those with `grips` have them translated against each other, those with
        `ends` have the right one translated.
    """
    if (grips := getattr(case, "grips", None)) is not None:
        distance = math.dist(grips.top.translation, grips.bottom.translation)
        return Drive("grip displacement", distance) if distance > 0 else LOAD
    if (ends := getattr(case, "ends", None)) is not None:
        distance = math.hypot(*(getattr(ends.right, "translation", None) or (0.0, 0.0)))
        return Drive("end displacement", distance) if distance > 0 else LOAD
    return LOAD


def common_drive(drives: Iterable[Drive]) -> str:
    """The name they share, or that of the load factor."""
    names = {drive.name for drive in drives}
    return names.pop() if len(names) == 1 else LOAD.name
