"""Sections ``[measurements.NAME]``: what instruments read on the sheet at every state."""

from __future__ import annotations

import math
import re
from typing import Annotated, Literal, NamedTuple

from pydantic import BeforeValidator, Field, ValidationError

from .messages import problems_of
from .part import Part, Point, finite_numbers
from .problem import Problem, not_allowed, one_of, problem_error
from .sheet import Sheet

#: Distance of neighbouring beams of the paper's specimen, m.
BEAM_SPACING = 0.0048

Line = tuple[Point, Point]

#: Columns that ``history.csv`` has in any case, and the first ones of files of measured data.
_TAKEN = re.compile(
    r"step|load|displacement|force_[xy]|moment|energy(_.*)?|newton_iterations|stable|shear_m(in|ax)"
    r"|(expected_)?negative_pivots|lowest_eigenvalue|probe\d+_u[xy]|.*_error"
)


class Place(NamedTuple):
    """A material point that is followed, and the key that names it."""

    key: str
    point: tuple[float, float]


def _line(value: object) -> Line | None:
    """Two different points, or None where it is something else."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        return None
    ends = [finite_numbers(point) for point in value]
    if any(end is None or len(end) != 2 for end in ends) or ends[0] == ends[1]:
        return None
    return ends[0], ends[1]  # type: ignore[return-value]


def _two_points(value: object) -> Line:
    if (line := _line(value)) is None:
        rule = "be two different points [[x, y], [x, y]]"
        raise problem_error(Problem(not_allowed(value, rule)))
    return line


def _two_lines(value: object) -> tuple[Line, ...]:
    lines = [_line(line) for line in value] if isinstance(value, list | tuple) else []
    if len(lines) != 2 or None in lines:
        rule = "be two lines of two different points each, [[[x, y], [x, y]], [[x, y], [x, y]]]"
        raise problem_error(Problem(not_allowed(value, rule)))
    return tuple(line for line in lines if line)


class Marker(Part):
    """A mark on the sheet; it reads its current position, m: the columns NAME_x and NAME_y."""

    kind: Literal["marker"] = "marker"
    point: Point

    def columns(self, name: str) -> tuple[str, ...]:
        """Columns of the history."""
        return f"{name}_x", f"{name}_y"

    def places(self, sheet: Sheet) -> tuple[Place, ...]:
        """The mark."""
        return (Place("point", self.point),)


class Angle(Part):
    """The angle from one material line to another, each from its first point to its second, rad."""

    kind: Literal["angle"] = "angle"
    lines: Annotated[tuple[Line, Line], BeforeValidator(_two_lines)]

    def columns(self, name: str) -> tuple[str, ...]:
        """Columns of the history."""
        return (name,)

    def places(self, sheet: Sheet) -> tuple[Place, ...]:
        """Ends of the first line, then of the second."""
        return tuple(Place("lines", point) for line in self.lines for point in line)


class ShearAngle(Part):
    """ψ over a gauge length: by how much the angle of two crossing fibres has decreased, rad.

    The fibres cross at `point`, which is the middle of both gauge lengths `gauge`, m. A camera
    sees the chords of the fibres; where they are bent a gauge length of none has another ψ, and
    next to a corner no limit at all.
    """

    kind: Literal["shear_angle"] = "shear_angle"
    point: Point
    gauge: float = Field(default=BEAM_SPACING, gt=0)

    def columns(self, name: str) -> tuple[str, ...]:
        """Columns of the history."""
        return (name,)

    def places(self, sheet: Sheet) -> tuple[Place, ...]:
        """Ends of the gauge length along the first family, then along the second."""
        x, y = self.point
        angle = math.radians(sheet.fibre_angle)
        c, s = 0.5 * self.gauge * math.cos(angle), 0.5 * self.gauge * math.sin(angle)
        ends = ((x - c, y - s), (x + c, y + s), (x + s, y - c), (x - s, y + c))
        return tuple(Place("gauge", end) for end in ends)


class Elongation(Part):
    """Relative elongation of the chord between two material points."""

    kind: Literal["elongation"] = "elongation"
    points: Annotated[Line, BeforeValidator(_two_points)]

    def columns(self, name: str) -> tuple[str, ...]:
        """Columns of the history."""
        return (name,)

    def places(self, sheet: Sheet) -> tuple[Place, ...]:
        """Both ends."""
        return tuple(Place("points", point) for point in self.points)


class Width(Part):
    """Horizontal distance of the two material points of the free sides at a reference height, m."""

    kind: Literal["width"] = "width"
    height: float

    def columns(self, name: str) -> tuple[str, ...]:
        """Columns of the history."""
        return (name,)

    def places(self, sheet: Sheet) -> tuple[Place, ...]:
        """The point on the left side, then on the right."""
        return (
            Place("height", (0.0, self.height)),
            Place("height", (sheet.width, self.height)),
        )


Measurement = Marker | Angle | ShearAngle | Elongation | Width
_KINDS: dict[str, type[Measurement]] = {
    "marker": Marker,
    "angle": Angle,
    "shear_angle": ShearAngle,
    "elongation": Elongation,
    "width": Width,
}


def _measurements(value: object) -> dict[str, Measurement]:
    """Validate each table by its kind, as the keys that are allowed are those of the kind."""
    if not isinstance(value, dict):
        raise problem_error(Problem(not_allowed(value, "be tables [measurements.NAME]")))
    found: dict[str, Measurement] = {}
    problems: list[Problem] = []
    for name, table in value.items():
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
            rule = "be called by letters, digits and _, a letter in front: it names a column"
            problems.append(Problem(not_allowed(name, rule), (name,)))
        elif isinstance(table, Measurement):
            found[name] = table
        elif not isinstance(table, dict):
            rule = f"be a table [measurements.{name}]"
            problems.append(Problem(not_allowed(table, rule), (name,)))
        elif "kind" not in table:
            text = f"missing; it is required and must be {one_of(_KINDS)}"
            problems.append(Problem(text, (name, "kind")))
        elif (model := _KINDS.get(str(table["kind"]))) is None:
            text = not_allowed(table["kind"], f"be {one_of(_KINDS)}")
            problems.append(Problem(text, (name, "kind")))
        else:
            try:
                found[name] = model.model_validate(table)
            except ValidationError as error:
                wrong = problems_of(error, model)
                problems += [Problem(p.text, (name, *p.keys)) for p in wrong]
    if not problems:
        problems = _name_clashes(found)
    if problems:
        raise problem_error(*problems)
    return found


def _name_clashes(found: dict[str, Measurement]) -> list[Problem]:
    problems: list[Problem] = []
    owner: dict[str, str] = {}
    for name, measurement in found.items():
        for column in measurement.columns(name):
            other = "history.csv itself" if _TAKEN.fullmatch(column) else owner.get(column)
            if other:
                text = f"the column {column} would be that of {other}; choose another name"
                problems.append(Problem(text, (name,)))
            owner[column] = f"measurements.{name}"
    return problems


#: Measurements by name.
Measurements = Annotated[dict[str, Measurement], BeforeValidator(_measurements)]


def check_places(measurements: dict[str, Measurement], sheet: Sheet) -> None:
    """Raise when a measurement looks for material outside the rectangle."""
    inside = f"0 <= x <= {sheet.width} and 0 <= y <= {sheet.height}"
    problems = []
    for name, measurement in measurements.items():
        for key, (x, y) in measurement.places(sheet):
            if 0 <= x <= sheet.width and 0 <= y <= sheet.height:
                continue
            rule = f"lie in the sheet, {inside}"
            text = not_allowed([x, y], rule)
            if isinstance(measurement, ShearAngle):
                rule = f"end in the sheet, {inside}; [{x:.6g}, {y:.6g}] is outside"
                text = not_allowed(measurement.gauge, rule)
            elif isinstance(measurement, Width):
                text = not_allowed(y, f"be from 0 to {sheet.height}, the height of the sheet")
            problems.append(Problem(text, (name, key)))
            break
    if problems:
        raise problem_error(*problems)
