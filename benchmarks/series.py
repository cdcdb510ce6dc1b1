"""What is compared: programs, schemes and their meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

PANTOGRAPH, SCIKIT_FEM = "pantograph_fem", "scikit-fem"


class Sizes(NamedTuple):
    """Element sizes inside and at the corners, m, equal for a uniform mesh, and their growth."""

    size: float
    corner_size: float
    growth: float = 0.35


VERY_COARSE = Sizes(0.017, 0.0017)
COARSE = Sizes(0.0124, 0.0005)
MEDIUM = Sizes(0.0124, 0.00031)
FINE = Sizes(0.0088, 0.00022)
#: For high degrees: few elements, which fall off to the corners.
FEW = (Sizes(0.034, 0.0025, 0.5), Sizes(0.025, 0.001, 0.5), Sizes(0.025, 0.0005, 0.5))


@dataclass(frozen=True)
class Series:
    """Runs of one program that differ by their mesh alone.

    Attributes
    ----------
    program, name
        Who solves, and how.
    options
        For pantograph_fem, values of the case; for scikit-fem, arguments of the program.
    meshes
        From coarse to fine.
    """

    program: str
    name: str
    options: tuple[str, ...]
    meshes: tuple[Sizes, ...]

    @property
    def title(self) -> str:
        """Program and name."""
        return f"{self.program}: {self.name}"


def _pantograph(scheme: str, degree: int, *meshes: Sizes) -> Series:
    options = (f"discretisation.scheme={scheme}", f"discretisation.degree={degree}")
    return Series(PANTOGRAPH, f"{scheme}, P{degree}", options, meshes)


def _scikit_fem(name: str, scheme: str, plain: bool, *meshes: Sizes) -> Series:
    how = ("--assembly", "forms", "--newton", "full") if plain else ()
    return Series(SCIKIT_FEM, name, ("--scheme", scheme, *how), meshes)


SERIES = (
    _pantograph("hinge", 3, VERY_COARSE, COARSE, MEDIUM, FINE),
    _pantograph("hinge", 5, *FEW),
    _pantograph("micromorphic", 3, VERY_COARSE, COARSE, MEDIUM),
    _pantograph("micromorphic", 5, *FEW[:2]),
    _scikit_fem("Argyris, tuned", "argyris", False, VERY_COARSE, FEW[1], COARSE, MEDIUM),
    _scikit_fem("Argyris, plain", "argyris", True, VERY_COARSE),
    _scikit_fem(
        "rectangles, tuned",
        "bfs",
        False,
        *(Sizes(0.017, corner_size) for corner_size in (0.0017, 0.0007, 0.0004)),
    ),
    _scikit_fem("micromorphic, tuned", "micromorphic", False, VERY_COARSE, COARSE),
    _scikit_fem("micromorphic, plain", "micromorphic", True, VERY_COARSE, COARSE),
    _scikit_fem(
        "Argyris, tuned, uniform mesh",
        "argyris",
        False,
        *(Sizes(size, size) for size in (0.0068, 0.0034, 0.0027)),
    ),
    _scikit_fem("micromorphic, tuned, uniform mesh", "micromorphic", False, Sizes(0.0068, 0.0068)),
)
