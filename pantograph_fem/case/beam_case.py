"""``kind = "beam"`` and ``kind = "chain"``: energy (16), and the springs of energy (1)."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, ValidationInfo, field_validator

from .beam import Beam, BeamMaterial
from .continuation import Continuation
from .discretisation import BeamDiscretisation
from .ends import Ends
from .model import Case
from .output import Output
from .part import Part
from .problem import Problem, not_allowed, problem_error

#: Default number of elements; at degree 4 the forces of Fig. 5 are within 1e-9 of their limits, and
#: the first integral of the equations is constant to 2e-5 along the beam.
ELEMENTS = 64


class BeamMesh(Part):
    """Elements of a beam; the foundation's pieces end between elements.

    Attributes
    ----------
    size
        Largest length of an element, m; 1/64 of the beam by default.
    """

    size: float | None = Field(default=None, gt=0)


class Chain(Part):
    """Links of a chain.

    Attributes
    ----------
    spacing
        Length ε of a link, m; in a :class:`ChainCase` fitted to a whole number of links.
    """

    spacing: float = Field(gt=0)


class _AxisCase(Case):
    """What a beam and a chain have in common: an axis with two ends."""

    beam: Beam
    material: BeamMaterial
    ends: Ends = Field(default_factory=Ends, validate_default=True)

    # In each of these, a section that is absent from info.data is itself wrong.

    @field_validator("material")
    @classmethod
    def _foundation_covers(cls, material: BeamMaterial, info: ValidationInfo) -> BeamMaterial:
        if beam := info.data.get("beam"):
            material.check_pieces(beam.length)
        return material

    @field_validator("ends")
    @classmethod
    def _supports_fit(cls, ends: Ends, info: ValidationInfo) -> Ends:
        material = info.data.get("material")
        if material is not None:
            ends.check(material.bending is not None, material.foundation is not None)
        return ends

    @field_validator("output", check_fields=False)
    @classmethod
    def _probes_on_the_axis(cls, output: Output, info: ValidationInfo) -> Output:
        if beam := info.data.get("beam"):
            output.check_probes_on_axis(beam)
        return output


class BeamCase(_AxisCase):
    """An extensible beam; its attributes are the sections of the file."""

    kind: Literal["beam"] = "beam"
    mesh: BeamMesh = Field(default_factory=BeamMesh, validate_default=True)
    discretisation: BeamDiscretisation = Field(default_factory=BeamDiscretisation)
    continuation: Continuation = Continuation()
    output: Output = Output()

    @field_validator("mesh")
    @classmethod
    def _default_size(cls, mesh: BeamMesh, info: ValidationInfo) -> BeamMesh:
        beam = info.data.get("beam")
        if beam is None:
            return mesh
        if mesh.size is None:
            return BeamMesh(size=beam.length / ELEMENTS)
        if mesh.size > beam.length:
            rule = f"be at most beam.length ({beam.length})"
            raise problem_error(Problem(not_allowed(mesh.size, rule), ("size",)))
        return mesh


class ChainCase(_AxisCase):
    """A chain of springs with the constants (15); its attributes are the sections of the file."""

    kind: Literal["chain"] = "chain"
    chain: Chain
    continuation: Continuation = Continuation()
    output: Output = Output()

    @field_validator("chain")
    @classmethod
    def _fit(cls, chain: Chain, info: ValidationInfo) -> Chain:
        beam = info.data.get("beam")
        if beam is None:
            return chain
        if chain.spacing > beam.length / 2:
            rule = f"be at most half of beam.length ({beam.length})"
            raise problem_error(Problem(not_allowed(chain.spacing, rule), ("spacing",)))
        return Chain(spacing=beam.length / round(beam.length / chain.spacing))

    @field_validator("output")
    @classmethod
    def _no_elements(cls, output: Output) -> Output:
        output.check_no_elements("chain")
        return output
