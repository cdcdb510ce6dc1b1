"""What must hold of the critical points of a hard case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .evidence import Evidence


@dataclass(frozen=True)
class CriticalLoad:
    """Load fraction and kind of the first critical point.

    Attributes
    ----------
    load, relative
        The load fraction and its tolerance.
    kind
        "bifurcation" or "limit point".
    source
        Where it is from.
    """

    load: float
    relative: float
    kind: str
    source: str = ""
    others: tuple[str, ...] = ()
    of_the_end: bool = False

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Compare."""
        if not found.critical_points:
            return f"no critical point was found, of which there is one at {self.load:.8g}"
        first = found.critical_points[0]
        return _off(first, self.load, self, "the first critical point", "the critical load")


@dataclass(frozen=True)
class CriticalLoads:
    """Load fractions of all critical points, in the order of the path, which are of one kind.

    Attributes
    ----------
    loads, relative
        The load fractions and their tolerance.
    kind
        "bifurcation" or "limit point".
    source
        Where they are from.
    """

    loads: tuple[float, ...]
    relative: float
    kind: str
    source: str = ""
    others: tuple[str, ...] = ()
    of_the_end: bool = True

    def objection(self, found: Evidence, others: Mapping[str, Evidence]) -> str:
        """Compare one after the other."""
        points = found.critical_points
        if len(points) != len(self.loads):
            return f"critical points found: {len(points)}, of which there are {len(self.loads)}"
        for number, (point, load) in enumerate(zip(points, self.loads, strict=True), 1):
            off = _off(point, load, self, f"critical point {number}", f"critical load {number}")
            if off:
                return off
        return ""


def _off(
    point: Mapping[str, Any],
    load: float,
    asked: CriticalLoad | CriticalLoads,
    point_name: str,
    load_name: str,
) -> str:
    """What is wrong with one critical point; empty where nothing is."""
    if point["kind"] != asked.kind:
        return f"{point_name} is a {point['kind']}, not a {asked.kind}"
    if abs(point["load"] / load - 1) <= asked.relative:
        return ""
    return f"{load_name} is {point['load']:.8g}, not {load:.8g} ({asked.source})"
