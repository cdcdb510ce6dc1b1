"""Mesh sizes of a study: which key of a case they are, and how they are varied."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import CaseError
from ..results.units import prefixed

#: The key that the size of elements or links has in each kind of case.
_KEY = {"sheet": "mesh.size", "beam": "mesh.size"} | {
    kind: f"{kind}.spacing" for kind in ("lattice", "chain")
}

#: Sizes of a study by default, over that of the case. Only whole periods fit into a lattice.
_FACTORS = {
    "sheet": (2.0, math.sqrt(2.0), 1.0, math.sqrt(0.5)),
    "beam": (4.0, 2.0, 1.0, 0.5),
    "lattice": (2.0, 1.0, 0.5),
    "chain": (4.0, 2.0, 1.0, 0.5),
}


@dataclass(frozen=True)
class Sizes:
    """Element sizes of a mesh, or the spacing of a net.

    Attributes
    ----------
    size
        Inside, m.
    corner_size
        At the corners of a sheet, m; None elsewhere.
    """

    size: float
    corner_size: float | None = None

    @property
    def text(self) -> str:
        """The sizes with their unit, such as "6.18/0.155 mm"."""
        factor, unit = prefixed(self.size, "m")
        sizes = [self.size] if self.corner_size is None else [self.size, self.corner_size]
        return "/".join(f"{factor * size:.3g}" for size in sizes) + f" {unit}"


def sizes_of(case: Any) -> Sizes:
    """Sizes of a case.

    Raises
    ------
    CaseError
        If its mesh is read from a file.
    """
    section, key = _KEY[case.kind].split(".")
    if getattr(case, section).model_dump().get("file"):
        raise CaseError(
            f"mesh.file: {case.mesh.file} cannot be refined, as a study does; "
            "take mesh.file out of the case and give mesh.size or --mesh"
        )
    corner_size = case.mesh.corner_size if case.kind == "sheet" else None
    return Sizes(getattr(getattr(case, section), key), corner_size)


def default_series(case: Any) -> list[Sizes]:
    """Sizes of a study of a case by default, coarsest first."""
    return [_scaled(sizes_of(case), factor) for factor in _FACTORS[case.kind]]


def parse_sizes(text: str, case: Any) -> Sizes:
    """Read SIZE or SIZE/CORNER_SIZE; a corner size that is not given is in proportion.

    Raises
    ------
    CaseError
        If the text is neither, or gives a corner size to what has no corners.
    """
    has_corners = case.kind == "sheet"
    parts = text.split("/")
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = []
    if not 1 <= len(numbers) <= 1 + has_corners or not all(0 < n < math.inf for n in numbers):
        form = "SIZE/CORNER_SIZE, such as 0.006/0.00015, or SIZE" if has_corners else "SIZE"
        raise CaseError(
            f"--mesh {text} is not allowed; for a {case.kind} it must be of the form {form}, with "
            "positive numbers in m"
        )
    if has_corners and len(numbers) == 1:
        now = sizes_of(case)
        return _scaled(now, numbers[0] / now.size)
    return Sizes(*numbers)


def size_overrides(case: Any, sizes: Sizes) -> tuple[str, ...]:
    """Overrides that give a case these sizes; those along clamped grips go with the size inside."""
    overrides = [f"{_KEY[case.kind]}={sizes.size!r}"]
    if sizes.corner_size is not None:
        overrides.append(f"mesh.corner_size={sizes.corner_size!r}")
        if case.mesh.grip_size is not None:
            grip_size = case.mesh.grip_size * sizes.size / case.mesh.size
            overrides.append(f"mesh.grip_size={min(grip_size, sizes.size)!r}")
    return tuple(overrides)


def finer_than(series: Sequence[Sizes]) -> Sizes:
    """Sizes for a reference: half of the finest inside, a quarter at the corners.

    The solution is singular at the corners, where most of the error comes from.
    """
    corners = [sizes.corner_size for sizes in series if sizes.corner_size is not None]
    return Sizes(min(sizes.size for sizes in series) / 2, min(corners) / 4 if corners else None)


def in_proportion(series: Sequence[Sizes]) -> bool:
    """Whether all have the same ratio of the sizes inside and at the corners, to 1 %."""
    ratios = [sizes.corner_size / sizes.size for sizes in series if sizes.corner_size]
    return not ratios or max(ratios) < 1.01 * min(ratios)


def _scaled(sizes: Sizes, factor: float) -> Sizes:
    corner_size = None if sizes.corner_size is None else factor * sizes.corner_size
    return Sizes(factor * sizes.size, corner_size)
