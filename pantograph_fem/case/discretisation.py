"""Section ``[discretisation]``: scheme, degrees and regularisation."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, ValidationInfo, field_validator

from .part import Part
from .problem import Problem, not_allowed, problem_error


def _default_auxiliary_degree(fields: dict[str, Any]) -> int | None:
    return int(fields["degree"]) - 1 if fields["scheme"] == "micromorphic" else None


def _default_sheet_quadrature_degree(fields: dict[str, Any]) -> int:
    # Raising it from 5 to 6 at degree 3 changes the force of case a by 6e-6: cost without gain.
    return int(fields["degree"]) + 2


def _default_beam_quadrature_degree(fields: dict[str, Any]) -> int:
    # On a line points are cheap.
    return 2 * int(fields["degree"]) + 2


class BeamDiscretisation(Part):
    """Finite elements of a beam.

    Attributes
    ----------
    scheme
        How the second derivatives are treated: "micromorphic", the paper's auxiliary gradient and
        multiplier; "hinge", by the displacement alone, with hinges between elements.
    degree
        Polynomial degree of the displacement.
    auxiliary_degree
        Degree of the auxiliary gradient and of its multiplier; one less than `degree` by default.
        None in the hinge scheme, which has neither.
    quadrature_degree
        Degree integrated exactly; 2 `degree` + 2 by default.
    """

    scheme: Literal["micromorphic", "hinge"] = "micromorphic"
    degree: Literal[2, 3, 4, 5, 6] = 4
    auxiliary_degree: int | None = Field(default_factory=_default_auxiliary_degree, ge=1, le=5)
    quadrature_degree: int = Field(default_factory=_default_beam_quadrature_degree, ge=2, le=20)

    @field_validator("auxiliary_degree")
    @classmethod
    def _below_degree(cls, value: int | None, info: ValidationInfo) -> int | None:
        degree, scheme = info.data.get("degree"), info.data.get("scheme")
        if value is not None and scheme == "hinge":
            text = "not allowed in the hinge scheme, which has no auxiliary gradient"
            raise problem_error(Problem(text))
        if value is not None and degree is not None and value >= degree:
            rule = f"be less than discretisation.degree ({degree})"
            raise problem_error(Problem(not_allowed(value, rule)))
        return value


class Discretisation(BeamDiscretisation):
    """Finite elements of a sheet: those of a beam, and smoothed pivots.

    Attributes
    ----------
    quadrature_degree
        Degree integrated exactly; `degree` + 2 by default.
    shear_regularisation
        Angle below which the shear energy is rounded off, rad; not used for an exponent of 2,
        whose energy is smooth.
    """

    degree: Literal[2, 3, 4, 5, 6] = 3
    quadrature_degree: int = Field(default_factory=_default_sheet_quadrature_degree, ge=2, le=20)
    shear_regularisation: float = Field(default=1e-4, gt=0)
