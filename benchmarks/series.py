"""What is compared: programs, schemes and their meshes."""

from __future__ import annotations

from dataclasses import dataclass

#: Element sizes inside and at the corners, m; equal for a uniform mesh.
Sizes = tuple[float, float]

PANTOGRAPH, SCIKIT_FEM = "pantograph_fem", "scikit-fem"

#: Growth of the size away from the corners, in meshes of triangles.
GROWTH = 0.35
VERY_COARSE: Sizes = (0.017, 0.0017)
COARSE: Sizes = (0.0124, 0.0005)
MEDIUM: Sizes = (0.0124, 0.00031)
FINE: Sizes = (0.0088, 0.00022)


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


def _pantograph(name: str, scheme: str, *meshes: Sizes) -> Series:
    return Series(PANTOGRAPH, name, (f"discretisation.scheme={scheme}",), meshes)


def _scikit_fem(name: str, scheme: str, plain: bool, *meshes: Sizes) -> Series:
    how = ("--assembly", "forms", "--newton", "full") if plain else ()
    return Series(SCIKIT_FEM, name, ("--scheme", scheme, *how), meshes)


SERIES = (
    _pantograph("hinge, P3", "hinge", VERY_COARSE, COARSE, MEDIUM, FINE),
    _pantograph("micromorphic, P3", "micromorphic", VERY_COARSE, COARSE, MEDIUM),
    _scikit_fem("Argyris, tuned", "argyris", False, VERY_COARSE, COARSE, MEDIUM),
    _scikit_fem("Argyris, plain", "argyris", True, VERY_COARSE),
    _scikit_fem(
        "rectangles, tuned", "bfs", False, (0.017, 0.0017), (0.017, 0.0007), (0.017, 0.0004)
    ),
    _scikit_fem("micromorphic, tuned", "micromorphic", False, VERY_COARSE, COARSE),
    _scikit_fem("micromorphic, plain", "micromorphic", True, VERY_COARSE, COARSE),
    _scikit_fem(
        "Argyris, tuned, uniform mesh",
        "argyris",
        False,
        (0.0068, 0.0068),
        (0.0034, 0.0034),
        (0.0027, 0.0027),
    ),
    _scikit_fem("micromorphic, tuned, uniform mesh", "micromorphic", False, (0.0068, 0.0068)),
)
