"""Section ``[material]``: the stiffness of each effect in the energy (31)."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from .part import Part, finite_numbers
from .problem import Problem, not_allowed, problem_error


def _stiffness(value: object) -> float | tuple[float, ...] | None:
    """Check a number or a pair; None when it is zero, as zero and absent mean the same."""
    if value is None:
        return None
    is_pair = isinstance(value, list | tuple)
    numbers = finite_numbers(value if is_pair else [value])
    if numbers is None or len(numbers) != (2 if is_pair else 1) or min(numbers) < 0:
        rule = "be a finite number, 0 or greater, or a pair [K1, K2] of such, one per family"
        raise problem_error(Problem(not_allowed(value, rule)))
    if not any(numbers):
        return None
    return numbers if is_pair else numbers[0]


def _shear_exponent(value: float) -> float:
    if value <= 1:
        rule = (
            "be greater than 1 (at 1 or less the shear stress does not vanish with the shear "
            "angle, and the undeformed sheet is not in equilibrium)"
        )
        raise problem_error(Problem(not_allowed(value, rule)))
    return value


#: One stiffness for both families, or one per family; None: the effect is not simulated.
Stiffness = Annotated[float | tuple[float, float] | None, BeforeValidator(_stiffness)]


class Material(Part):
    """Stiffnesses of the sheet; an effect that is absent or zero is not simulated.

    Attributes
    ----------
    stretch
        K_e, N/m, for both families or one per family.
    bending
        K_b, N m, for both families or one per family.
    shear
        K_p, N/m.
    shear_exponent
        Exponent gamma of the shear angle in the energy.
    """

    stretch: Stiffness = None
    bending: Stiffness = None
    shear: Annotated[float | None, Field(ge=0), AfterValidator(lambda value: value or None)] = None
    shear_exponent: Annotated[float, AfterValidator(_shear_exponent)] = 2.0

    @model_validator(mode="after")
    def _has_an_effect(self) -> Material:
        if self.stretch is None and self.bending is None and self.shear is None:
            text = "no effect is given; at least one of stretch, bending, shear must be above 0"
            raise problem_error(Problem(text))
        return self

    @property
    def stretch_pair(self) -> tuple[float, float] | None:
        """K_e of the two families, N/m; None when stretch is not simulated."""
        return _pair(self.stretch)

    @property
    def bending_pair(self) -> tuple[float, float] | None:
        """K_b of the two families, N m; None when bending is not simulated."""
        return _pair(self.bending)

    @property
    def has_shear(self) -> bool:
        """Whether shear is simulated."""
        return self.shear is not None


def _pair(stiffness: float | tuple[float, float] | None) -> tuple[float, float] | None:
    return (stiffness, stiffness) if isinstance(stiffness, float) else stiffness
