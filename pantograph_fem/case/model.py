"""The case: what is simulated, and the rules that hold between its sections."""

from __future__ import annotations

import re
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, ValidationInfo, field_validator

from .continuation import Continuation
from .discretisation import Discretisation
from .grips import Grips
from .material import Material
from .mesh import Mesh
from .output import Output
from .part import Part
from .problem import Problem, not_allowed, problem_error
from .sheet import Sheet


def _file_name(value: str) -> str:
    """Accept what can safely name a folder of results."""
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", value):
        rule = "be a plain file name: letters, digits, _ . - and neither . nor - in front"
        raise problem_error(Problem(not_allowed(value, rule)))
    return value


class Case(Part):
    """A pantographic sheet between two grips.

    Attributes
    ----------
    name
        Plain file name; results go to ``results/<name>`` by default.
    title
        Title for figures and the progress bar.
    kind
        What is simulated; see :data:`KINDS`.
    sheet, material, grips, mesh, discretisation, continuation, output
        The sections of the file.
    """

    name: Annotated[str, AfterValidator(_file_name)]
    title: str = ""
    kind: Literal["sheet"] = "sheet"
    sheet: Sheet
    material: Material
    grips: Grips = Grips()
    # validated although a default, as its sizes depend on the sheet and the grips
    mesh: Mesh = Field(default_factory=Mesh, validate_default=True)
    discretisation: Discretisation = Field(default_factory=Discretisation)
    continuation: Continuation = Continuation()
    output: Output = Output()

    # In each of these, a section that is absent from info.data is itself wrong.

    @field_validator("grips")
    @classmethod
    def _clamps_need_bending(cls, grips: Grips, info: ValidationInfo) -> Grips:
        material = info.data.get("material")
        if material is not None:
            grips.check_clamps(has_bending=material.bending is not None)
        return grips

    @field_validator("mesh")
    @classmethod
    def _default_sizes(cls, mesh: Mesh, info: ValidationInfo) -> Mesh:
        sheet, grips = info.data.get("sheet"), info.data.get("grips")
        return mesh if sheet is None or grips is None else mesh.with_defaults(sheet, grips)

    @field_validator("output")
    @classmethod
    def _probes_in_the_sheet(cls, output: Output, info: ValidationInfo) -> Output:
        sheet, mesh = info.data.get("sheet"), info.data.get("mesh")
        if sheet is not None and mesh is not None and mesh.file is None:
            output.check_probes(sheet)
        return output


#: The model of each kind of case. Another kind has its own sections and adds its model here.
KINDS: dict[str, type[Case]] = {"sheet": Case}
