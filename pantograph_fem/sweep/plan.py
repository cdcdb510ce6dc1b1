"""What a sweep runs: a case for each point of its design, all of them checked."""

from __future__ import annotations

import copy
import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..case import Case, case_to_toml, load_case
from ..case.messages import case_error
from ..errors import CaseError
from .design import Design, make_design
from .outputs import choose_outputs
from .study import SweepStudy, overlap
from .study_file import load_sweep
from .vary import Value

#: Pictures and fields of every point are much to write; ``set`` may ask for them.
_NO_OUTPUT = ("output.figures=false", "output.report=false", "output.fields=none")


@dataclass(frozen=True, eq=False)
class Point:
    """A point of a sweep.

    Attributes
    ----------
    values
        Of the varied keys.
    case
        What to simulate; None where the values make no case.
    directory
        Where its results are, or will be: a folder named by a hash of the case, so that points
        with the same case share it, and a sweep with more points finds those it had.
    problem
        Why there is no case.
    """

    values: tuple[Value, ...]
    case: Case | None
    directory: Path
    problem: str = ""


@dataclass(frozen=True, eq=False)
class Plan:
    """A sweep that is checked.

    Attributes
    ----------
    study
        The file.
    design
        Values of the varied keys.
    points
        A case for each.
    outputs
        Names of what is tabulated.
    kind
        Kind of the case.
    directory
        Where the sweep goes.
    """

    study: SweepStudy
    design: Design
    points: tuple[Point, ...]
    outputs: tuple[str, ...]
    kind: str
    directory: Path


def make_plan(path: Path, output: Path | None, overrides: Sequence[str]) -> Plan:
    """Make the cases of a sweep.

    A point whose values make no valid case is kept, with what is wrong.

    Raises
    ------
    CaseError
        If anything given is wrong, or no point is a valid case.
    """
    study = load_sweep(path)
    for override in (*study.set, *overrides):
        key = override.partition("=")[0].strip()
        if other := next((v.key for v in study.vary if overlap(key, v.key)), None):
            raise CaseError(f"--set {override}: {other} is varied by {path}; leave one of them out")
    case_file = Path(os.path.normpath(path.parent / study.case))
    base = (*_NO_OUTPUT, *study.set, *overrides)
    lists = _lists(path, study, case_file, base)
    design = make_design(study)
    directory = output or Path("results") / study.name
    points = [_point(v, study, case_file, base, lists, directory) for v in design.values]
    case = next((point.case for point in points if point.case is not None), None)
    if case is None:
        raise CaseError(
            f"{path} has no point that is a valid case. At the first point:\n  {points[0].problem}"
        )
    outputs = choose_outputs(case, study.outputs, study.responses)
    return Plan(study, design, tuple(points), outputs, case.kind, directory)


def _point(
    values: tuple[Value, ...],
    study: SweepStudy,
    case_file: Path,
    base: Sequence[str],
    lists: dict[str, list[Any]],
    directory: Path,
) -> Point:
    tables = copy.deepcopy(lists)
    for vary, value in zip(study.vary, values, strict=True):
        key, place = vary.entry
        if place is None:
            tables[key] = value  # type: ignore[assignment]
        else:
            tables[key][place] = value
    # JSON of numbers, texts and lists is TOML
    chosen = [f"{key}={json.dumps(value, ensure_ascii=False)}" for key, value in tables.items()]
    try:
        case = load_case(case_file, (*base, *chosen))
    except CaseError as error:
        if not case_file.is_file():
            raise
        lines = [line.strip() for line in str(error).splitlines()]
        return Point(values, None, directory, "; ".join(lines[1:] or lines))
    name = hashlib.sha256(case_to_toml(case).encode()).hexdigest()[:12]
    return Point(values, case, directory / "points" / name)


def _lists(
    path: Path, study: SweepStudy, case_file: Path, base: Sequence[str]
) -> dict[str, list[Any]]:
    """Lists of the case of which entries are varied, by their keys."""
    wanted = {vary.entry[0] for vary in study.vary if vary.entry[1] is not None}
    if not wanted:
        return {}
    data = load_case(case_file, base).model_dump(mode="json")
    lists, problems = {}, []
    for i, vary in enumerate(study.vary):
        key, place = vary.entry
        if place is None:
            continue
        value: Any = data
        for name in key.split("."):
            value = value.get(name) if isinstance(value, dict) else None
        if not isinstance(value, list) or place >= len(value):
            has = f"a list of {len(value)}" if isinstance(value, list) else "no list"
            problems.append(
                f"vary[{i}].key: {vary.key} is not allowed; {case_file} has {has} at {key}"
            )
            continue
        lists[key] = value
    if problems:
        raise case_error(str(path), problems)
    return lists
