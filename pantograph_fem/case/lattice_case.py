"""``kind = "lattice"``: the springs of energy (19), cut from a rectangle between two grips."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, ValidationInfo, field_validator

from .continuation import Continuation
from .gripped_case import GrippedCase
from .lattice_spacing import fitted_spacing
from .output import Output
from .part import Part
from .problem import Problem, not_allowed, problem_error


class Lattice(Part):
    """Nodes and springs.

    Attributes
    ----------
    spacing
        Distance ε of neighbouring nodes along the fibres, m. In a
        :class:`LatticeCase` it is fitted to the rectangle where that can be done.
    pivots
        "averaged": at each node the mean of the four angles between its fibres; "literal": the
        one angle of (19).
    shear_regularisation
        Angle below which the energy of the pivots is rounded off, rad; not used for an exponent
        of 2.
    """

    spacing: float = Field(gt=0)
    pivots: Literal["averaged", "literal"] = "averaged"
    shear_regularisation: float = Field(default=1e-4, gt=0)


#: Fewest spacings across the shorter side.
_FEWEST = 2


class LatticeCase(GrippedCase):
    """A lattice of springs with the constants (30); its attributes are the sections of the file.

    Sheet, material and grips are those of the continuum that it stands for.
    """

    kind: Literal["lattice"] = "lattice"
    lattice: Lattice
    continuation: Continuation = Continuation()
    output: Output = Output()

    # In each of these, a section that is absent from info.data is itself wrong.

    @field_validator("lattice")
    @classmethod
    def _fit(cls, lattice: Lattice, info: ValidationInfo) -> Lattice:
        sheet = info.data.get("sheet")
        if sheet is None:
            return lattice
        largest = min(sheet.width, sheet.height) / _FEWEST
        if lattice.spacing > largest:
            rule = f"be at most {largest:.6g} m, half the shorter side of the sheet"
            raise problem_error(Problem(not_allowed(lattice.spacing, rule), ("spacing",)))
        spacing = fitted_spacing(sheet.width, sheet.height, sheet.fibre_angle, lattice.spacing)
        return lattice.model_copy(update={"spacing": spacing})

    @field_validator("output")
    @classmethod
    def _probes_in_the_sheet(cls, output: Output, info: ValidationInfo) -> Output:
        sheet = info.data.get("sheet")
        if sheet is not None:
            output.check_probes(sheet)
        output.check_no_elements("lattice")
        return output
