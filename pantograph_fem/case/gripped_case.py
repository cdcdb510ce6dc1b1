"""What a sheet and the lattice that stands for it have in common."""

from __future__ import annotations

from pydantic import ValidationInfo, field_validator

from .grips import Grips
from .material import Material
from .model import Case
from .sheet import Sheet


class GrippedCase(Case):
    """A rectangle of fibres between two grips."""

    sheet: Sheet
    material: Material
    grips: Grips = Grips()

    @field_validator("grips")
    @classmethod
    def _clamps_need_bending(cls, grips: Grips, info: ValidationInfo) -> Grips:
        material = info.data.get("material")
        if material is not None:  # else it is itself wrong
            grips.check_clamps(has_bending=material.bending is not None)
        return grips
