"""Section ``[output]``: what is written besides the history."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from .beam import Beam
from .part import Part, Point
from .problem import Problem, not_allowed, problem_error
from .sheet import Sheet


def _list(value: object) -> tuple[object, ...]:
    if not isinstance(value, list | tuple):
        rule = "be a list of points [[x, y], ...]"
        raise problem_error(Problem(not_allowed(value, rule)))
    return tuple(value)


class Output(Part):
    """Results to write.

    Attributes
    ----------
    probes
        Reference points whose displacement goes to the history, m.
    fields
        States whose fields are saved: at all accepted steps, at the stops, or none.
    eigenvalues
        Whether the lowest eigenvalue of the tangent and its mode are found at every state.
    elements
        Whether the displacement of these states is also written on the elements themselves, with
        their degree.
    figures
        Whether figures are drawn.
    report
        Whether ``report.html`` is written; as `figures` by default.
    line_spacing
        Distance of the material lines in the figures, m; that of the beams of the paper's
        specimen by default.
    """

    probes: Annotated[tuple[Point, ...], BeforeValidator(_list)] = ()
    fields: Literal["all", "stops", "none"] = "all"
    eigenvalues: bool = False
    elements: bool = False
    figures: bool = True
    report: bool = Field(default_factory=lambda known: known.get("figures", True))
    line_spacing: float = Field(default=0.0048, gt=0)

    def check_no_elements(self, kind: str) -> None:
        """Raise when elements are asked for of springs."""
        if self.elements:
            rule = f"be false: a {kind} is made of springs and has no elements"
            raise problem_error(Problem(not_allowed(self.elements, rule), ("elements",)))

    def check_probes(self, sheet: Sheet) -> None:
        """Raise when a probe lies outside the rectangle."""
        rule = f"lie in the sheet, 0 <= x <= {sheet.width} and 0 <= y <= {sheet.height}"
        problems = [
            Problem(not_allowed([x, y], rule), ("probes", i))
            for i, (x, y) in enumerate(self.probes)
            if not (0 <= x <= sheet.width and 0 <= y <= sheet.height)
        ]
        if problems:
            raise problem_error(*problems)

    def check_probes_on_axis(self, beam: Beam) -> None:
        """Raise when a probe lies off the axis of a beam."""
        rule = f"lie on the beam's axis, 0 <= x <= {beam.length} and y = 0"
        problems = [
            Problem(not_allowed([x, y], rule), ("probes", i))
            for i, (x, y) in enumerate(self.probes)
            if not (0 <= x <= beam.length and y == 0.0)
        ]
        if problems:
            raise problem_error(*problems)
