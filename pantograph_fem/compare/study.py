"""Studies: labelled runs that are compared with each other."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from ..case.part import Part
from ..case.problem import Problem, not_allowed, problem_error


def _strings(value: object) -> tuple[str, ...]:
    """Check a list of different texts."""
    wrong = not isinstance(value, list | tuple) or not all(
        isinstance(item, str) and item for item in value
    )
    if wrong or len(set(value)) < len(value):  # type: ignore[arg-type, call-overload]
        raise problem_error(Problem(not_allowed(value, "be a list of different strings")))
    return tuple(value)  # type: ignore[arg-type]


def _text(value: str) -> str:
    if not value.strip() or not value.isprintable():
        raise problem_error(Problem(not_allowed(value, "be one line of text that is not empty")))
    return value


def _file_name(value: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", value):
        rule = "be a plain file name: letters, digits, _ . - and neither . nor - in front"
        raise problem_error(Problem(not_allowed(value, rule)))
    return value


Strings = Annotated[tuple[str, ...], BeforeValidator(_strings)]
Text = Annotated[str, AfterValidator(_text)]


class StudyRun(Part):
    """A case, and what is changed in it.

    Attributes
    ----------
    case
        Case file, relative to the folder of the study file.
    label
        What the run is called in tables and legends; its results go to a folder of that name.
    set
        Values in place of those of the case file, each as ``key.path=value``.
    parameter
        Number by which the runs are ordered, such as a mesh size: smaller is finer.
    reference
        Whether differences are taken against this run.
    """

    case: Text
    label: Text
    set: Strings = ()
    parameter: float | None = None
    reference: bool = False


class Mark(Part):
    """Vertical line in the figure of curves.

    Attributes
    ----------
    x
        Place on the axis: a displacement, m, or a load factor where that is the axis.
    label
        Text in the legend.
    """

    x: float
    label: Text


class Study(Part):
    """Runs that are compared.

    Attributes
    ----------
    name
        Plain file name; the comparison goes to ``results/<name>`` by default.
    title
        Title of tables and figures.
    parameter
        What the parameter of the runs is, with its unit.
    quantities
        Columns of ``history.csv``, or "force" for its magnitude; chosen from the results if empty.
    load
        Load fraction at which quantities are compared; the last common one by default.
    set
        Values in place of those of the case files of all runs, before those of each run.
    expected_order
        Order of convergence to show beside the observed ones.
    marks
        Vertical lines in the figure of curves.
    runs
        The runs, with different labels and at most one reference.
    """

    name: Annotated[str, AfterValidator(_file_name)] = "compare"
    title: Annotated[str, AfterValidator(_text)] | None = None
    parameter: Text = "parameter"
    quantities: Strings = ()
    load: float | None = Field(default=None, gt=0, le=1)
    set: Strings = ()
    expected_order: float | None = Field(default=None, gt=0)
    marks: tuple[Mark, ...] = ()
    runs: tuple[StudyRun, ...] = ()

    @model_validator(mode="after")
    def _one_reference(self) -> Study:
        references = [i for i, run in enumerate(self.runs) if run.reference]
        if len(references) > 1:
            rule = f"be false, as runs[{references[0]}] is the reference and there is but one"
            problem = Problem(not_allowed(True, rule), ("runs", references[1], "reference"))
            raise problem_error(problem)
        return self

    @model_validator(mode="after")
    def _different_parameters(self) -> Study:
        seen: list[float] = []
        for i, run in enumerate(self.runs):
            if run.parameter is None or run.reference:
                continue
            if run.parameter in seen:
                rule = "differ from the parameters of the runs before it"
                problem = Problem(not_allowed(run.parameter, rule), ("runs", i, "parameter"))
                raise problem_error(problem)
            seen.append(run.parameter)
        return self
