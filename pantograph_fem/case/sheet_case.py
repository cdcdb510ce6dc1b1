"""``kind = "sheet"``: the continuum of energy (31) between two grips."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import Field, ValidationInfo, field_validator

from .continuation import Continuation
from .discretisation import Discretisation
from .gripped_case import GrippedCase
from .measurements import Measurements, check_places
from .mesh import Mesh
from .output import Output


class SheetCase(GrippedCase):
    """A pantographic sheet between two grips; its attributes are the sections of the file."""

    kind: Literal["sheet"] = "sheet"
    discretisation: Discretisation = Field(default_factory=Discretisation)
    # validated although a default, as its sizes depend on what is above
    mesh: Mesh = Field(default_factory=Mesh, validate_default=True)
    continuation: Continuation = Continuation()
    output: Output = Output()
    measurements: Measurements = Field(default_factory=dict)

    @property
    def input_files(self) -> tuple[Path, ...]:
        """The mesh, where it is read from a file."""
        return () if self.mesh.file is None else (self.mesh.file,)

    # In each of these, a section that is absent from info.data is itself wrong.

    @field_validator("mesh")
    @classmethod
    def _default_sizes(cls, mesh: Mesh, info: ValidationInfo) -> Mesh:
        sheet, grips, elements = (
            info.data.get(name) for name in ("sheet", "grips", "discretisation")
        )
        if sheet is None or grips is None or elements is None:
            return mesh
        return mesh.with_defaults(sheet, grips, elements.degree)

    @field_validator("output")
    @classmethod
    def _probes_in_the_sheet(cls, output: Output, info: ValidationInfo) -> Output:
        sheet, mesh = info.data.get("sheet"), info.data.get("mesh")
        if sheet is not None and mesh is not None and mesh.file is None:
            output.check_probes(sheet)
        return output

    @field_validator("measurements")
    @classmethod
    def _measured_in_the_sheet(
        cls, measurements: Measurements, info: ValidationInfo
    ) -> Measurements:
        sheet, mesh = info.data.get("sheet"), info.data.get("mesh")
        if sheet is not None and mesh is not None and mesh.file is None:
            check_places(measurements, sheet)
        return measurements
