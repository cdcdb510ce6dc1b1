"""What a study file of ``pantograph identify`` may hold."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from ..case.part import Part, finite_numbers
from ..case.problem import Problem, not_allowed, problem_error
from ..compare.study import Strings, Text, _file_name
from .parameters import Parameter

#: Default bounds of a stiffness: the start times these.
_WIDE = (1e-3, 1e3)
#: Default bounds of γ.
_EXPONENTS = (1.01, 4.0)


def _bounds(value: object) -> tuple[float, ...]:
    numbers = finite_numbers(value)
    if numbers is None or len(numbers) != 2 or not 0 < numbers[0] < numbers[1]:
        rule = "be a pair [lower, upper] with 0 < lower < upper"
        raise problem_error(Problem(not_allowed(value, rule)))
    return numbers


def _loads(value: object) -> tuple[float, ...]:
    numbers = finite_numbers(value)
    rising = numbers and list(numbers) == sorted(set(numbers))
    if not numbers or not rising or numbers[0] <= 0 or numbers[-1] > 1:
        rule = "be a list of increasing load fractions above 0 and up to 1"
        raise problem_error(Problem(not_allowed(value, rule)))
    return numbers


def _errors(value: object) -> dict[str, float]:
    numbers = finite_numbers(list(value.values())) if isinstance(value, dict) else None
    if numbers is None or (numbers and min(numbers) <= 0):
        rule = "be a table of standard errors above 0 by column, such as { force_y = 0.5 }"
        raise problem_error(Problem(not_allowed(value, rule)))
    return dict(zip(value, numbers, strict=True))  # type: ignore[call-overload]


class Constant(Part):
    """A constant that is looked for.

    Attributes
    ----------
    start
        Where the search starts, SI units.
    bounds
        Between which it is looked for; from a thousandth to a thousand times the start by default,
        and from 1.01 to 4 for γ.
    scale
        "log": steps are in its logarithm, or in that of γ - 1; "linear": in the value.
    """

    start: float = Field(gt=0)
    bounds: Annotated[tuple[float, float] | None, BeforeValidator(_bounds)] = None
    scale: Literal["log", "linear"] = "log"


class Constants(Part):
    """The constants that are looked for, by their keys in ``[material]``; one for both families."""

    stretch: Constant | None = None
    bending: Constant | None = None
    shear: Constant | None = None
    shear_exponent: Constant | None = None

    def parameters(self) -> tuple[Parameter, ...]:
        """Those that are given."""
        found = []
        for name in Constants.model_fields:
            constant: Constant | None = getattr(self, name)
            if constant is not None:
                found.append(_parameter(name, constant))
        return tuple(found)

    @model_validator(mode="after")
    def _starts_inside(self) -> Constants:
        problems = []
        for parameter in self.parameters():
            lower, start, upper = parameter.lower, parameter.start, parameter.upper
            if lower <= parameter.origin:
                text = not_allowed(lower, f"be greater than {parameter.origin:g}")
                problems.append(Problem(text, (parameter.name, "bounds")))
            elif not lower < start < upper:
                text = not_allowed(start, f"lie between its bounds, {lower:g} and {upper:g}")
                problems.append(Problem(text, (parameter.name, "start")))
        if not self.parameters():
            problems.append(Problem("none is given; at least one constant must be looked for"))
        if problems:
            raise problem_error(*problems)
        return self


class DataFile(Part):
    """A table of measured values.

    Attributes
    ----------
    file
        CSV file, relative to the folder of the study file.
    columns
        Columns to use, ``*`` standing for any letters; all by default.
    errors
        Standard errors by column, likewise, of columns NAME that have no column NAME_error.
    """

    file: Text
    columns: Strings = ()
    errors: Annotated[dict[str, float], BeforeValidator(_errors)] = Field(default_factory=dict)


class Synthetic(Part):
    """How data are made of the case, to try what could be identified.

    Attributes
    ----------
    seed
        Of the normal errors that are added.
    loads
        Load fractions of the states; the stops of the case by default.
    noise
        Factor on the standard errors with which errors are drawn; 0 for exact data.
    """

    seed: int = Field(default=1, ge=0)
    loads: Annotated[tuple[float, ...] | None, BeforeValidator(_loads)] = None
    noise: float = Field(default=1.0, ge=0)


class IdentifyStudy(Part):
    """Constants that are looked for, and data.

    Attributes
    ----------
    name
        Plain file name; results go to ``results/<name>`` by default.
    title
        Title of figures.
    case
        Case file, relative to the folder of the study file: the experiment.
    set
        Values in place of those of the case file, each as ``key.path=value``.
    constants, data, synthetic
        The sections of those names.
    confidence
        Of the intervals.
    """

    name: Annotated[str, AfterValidator(_file_name)] = "identify"
    title: Text = "Identification"
    case: Text
    set: Strings = ()
    confidence: float = Field(default=0.95, gt=0, lt=1)
    constants: Constants
    synthetic: Synthetic = Synthetic()
    data: tuple[DataFile, ...] = ()


def _parameter(name: str, constant: Constant) -> Parameter:
    is_exponent = name == "shear_exponent"
    default = _EXPONENTS if is_exponent else tuple(constant.start * f for f in _WIDE)
    lower, upper = constant.bounds or default
    return Parameter(name, constant.start, lower, upper, constant.scale == "log")
