"""Section ``[mesh]``: element sizes, or a file with the mesh."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field, ValidationInfo, field_validator, model_validator

from .grips import Grips
from .part import Part
from .problem import Problem, not_allowed, problem_error, value_text
from .sheet import Sheet

# Chosen by refinement of all cases of the paper, at degree 3: force and energy are within 0.1 % of
# their limits, most of what is left coming from the corners.
#: Default size inside, over the shorter side of the sheet: 6.2 mm for the sheet of the paper.
SIZE_OVER_SIDE = 1 / 11
#: Default size at the corners, over the size inside: 0.15 mm for the sheet of the paper.
CORNER_SIZE_OVER_SIZE = 1 / 40
#: Default size along the grips when one is a clamp, over the shorter side: 1 mm for the sheet of
#: the paper, whose clamps make layers of thickness sqrt(K_b/K_e) = 0.38 mm.
CLAMP_SIZE_OVER_SIDE = 1 / 68
#: These three, and those of the first of a series of meshes: coarse, as finer ones follow.
DEFAULTS = (SIZE_OVER_SIDE, CORNER_SIZE_OVER_SIZE, CLAMP_SIZE_OVER_SIDE)
FIRST_DEFAULTS = (1 / 6, 1 / 20, 1 / 34)
#: Degree for which they are chosen. The first of a series is the coarser the higher its degree.
DEGREE = 3
#: Default growth of the element size per distance from a corner or a grip.
GROWTH = 0.25
#: That of the first of a series by its degree; elements of high degree may grow faster.
FIRST_GROWTH = {4: 0.375, 5: 0.5, 6: 0.5}
#: Smallest size at corners and grips, over the size inside; far beyond it gmsh fails.
SMALLEST_RATIO = 1e-4


class Mesh(Part):
    """Element sizes of the rectangle, or the file of another mesh.

    In a :class:`~pantograph_fem.case.Case` the sizes have their defaults filled in, unless there
    is a file.

    Attributes
    ----------
    size
        Element size inside, m.
    corner_size
        Element size at the four corners, where the solution is singular, m.
    grip_size
        Element size along the two grips, m; None: no refinement along them.
    growth
        Increase of the element size per distance from a corner or a grip; 0.25 by default, and up
        to 0.5 for the first mesh of a series of high degree.
    adapt
        Whether the mesh is refined where the solution needs it until the force or the energy at
        full load is accurate; the sizes are then those of the first mesh, coarser by default.
    accuracy
        Relative error that is aimed at.
    accuracy_of
        Of what: "force", the top grip's, or the stored "energy".
    file
        Mesh with the physical groups bottom and top, absolute; a relative path in a case file
        starts from the folder of that file.
    """

    size: float | None = Field(default=None, gt=0)
    corner_size: float | None = Field(default=None, gt=0)
    grip_size: float | None = Field(default=None, gt=0)
    growth: float | None = Field(default=None, gt=0, le=1)
    adapt: bool = False
    accuracy: float = Field(default=1e-3, ge=1e-6, le=0.1)
    accuracy_of: Literal["force", "energy"] = "force"
    file: Path | None = None

    @field_validator("file", mode="before")
    @classmethod
    def _existing_file(cls, value: object, info: ValidationInfo) -> Path | None:
        if value is None:
            return None
        if not isinstance(value, str | Path):
            raise problem_error(Problem(not_allowed(value, "be the path of a mesh, a string")))
        base = (info.context or {}).get("base") or Path.cwd()
        path = Path(base, value).resolve()
        if not path.is_file():
            text = f"{value_text(str(value))} is not found; there is no file {path}"
            raise problem_error(Problem(text))
        return path

    @model_validator(mode="after")
    def _file_or_sizes(self) -> Mesh:
        given = ("size", "corner_size", "grip_size", "growth", "adapt")
        wrong = [key for key in given if getattr(self, key)]
        if self.file and wrong:
            text = "not allowed beside mesh.file, whose elements are used as they are"
            raise problem_error(*(Problem(text, (key,)) for key in wrong))
        return self

    def with_defaults(self, sheet: Sheet, grips: Grips, degree: int) -> Mesh:
        """Fill in the sizes that are not given, and check that none exceeds that inside."""
        if self.file:
            return self
        side = min(sheet.width, sheet.height)
        over_side, over_size, clamp_over_side = FIRST_DEFAULTS if self.adapt else DEFAULTS
        growth = FIRST_GROWTH.get(degree, GROWTH) if self.adapt else GROWTH
        if self.adapt and degree > DEGREE:
            over_side, clamp_over_side = (
                share * degree / DEGREE for share in (over_side, clamp_over_side)
            )
        size = self.size or over_side * side
        corner_size = self.corner_size or over_size * size
        grip_size = self.grip_size
        if grip_size is None and grips.clamped:
            grip_size = max(min(size, clamp_over_side * side), SMALLEST_RATIO * size)
        problems = [
            Problem(not_allowed(value, f"be at most mesh.size ({size:.6g})"), (key,))
            for key, value in (("corner_size", corner_size), ("grip_size", grip_size))
            if value is not None and value > size
        ]
        problems += [
            Problem(not_allowed(value, f"be at least {SMALLEST_RATIO:g} of mesh.size"), (key,))
            for key, value in (("corner_size", self.corner_size), ("grip_size", self.grip_size))
            if value is not None and value < SMALLEST_RATIO * size
        ]
        if problems:
            raise problem_error(*problems)
        return self.model_copy(
            update={
                "size": size,
                "corner_size": corner_size,
                "grip_size": grip_size,
                "growth": self.growth or growth,
            }
        )
