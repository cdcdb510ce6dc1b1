"""The file ``report.html``: a run on one page, from what it left in its folder.

The page needs nothing besides itself: figures are inside it, and it has no script.
"""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..case import Case, load_case
from .atomic import replace_text
from .column_texts import column_texts
from .failure import FAILURE_FILE
from .history import read_history
from .report_numbers import KINDS, last_state
from .report_sentences import outcome, warnings
from .strict_json import read_json
from .units import column_unit

REPORT_FILE = "report.html"

#: More states than these are thinned out in the table of steps.
MOST_ROWS = 400

#: Units of what instruments read; an elongation is a number.
_INSTRUMENT_UNITS = {"marker": "m", "width": "m", "angle": "rad", "shear_angle": "rad"}

#: Figures of the whole run, and of states, by the beginning of their names.
_CURVES = {
    "force_displacement": "Force and displacement",
    "shapes": "Deformed shapes",
    "profiles": "Along the axis",
}
_STATES = {"shear_angle": "Shear angle", "energy_density": "Energy density"}


def write_report(directory: Path) -> Path:
    """Write ``DIR/report.html`` from the other files there, and return its path.

    Parameters
    ----------
    directory
        Results of a run: finished, stopped, or interrupted.

    Raises
    ------
    CaseError
        If the directory holds no results of a run, or they are damaged.
    """
    path = directory / REPORT_FILE
    replace_text(path, report_html(directory))
    return path


def report_html(directory: Path) -> str:
    """The text of the page; raises as `write_report`."""
    from jinja2 import Environment, StrictUndefined  # not before there is a report to write

    settings = directory / "case.resolved.toml"
    case = load_case(settings)
    history = read_history(directory / "history.csv")
    summary = read_json(directory / "summary.json")
    known = summary or {}
    template = resources.files(__package__).joinpath("report.html.j2").read_text("utf-8")
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.from_string(template).render(
        title=case.title or case.name,
        name=case.name,
        kind=KINDS[case.kind][0],
        outcome=outcome(summary, history),
        warnings=warnings(summary, history),
        numbers=last_state(history, case.kind),
        failure=_failure(read_json(directory / FAILURE_FILE)),
        figures=_figures(directory / "figures"),
        critical_points=known.get("critical_points", []),
        accuracy=_accuracy(known.get("accuracy"), str(known.get("message", ""))),
        settings=settings.read_text(encoding="utf-8"),
        facts=_facts(known),
        versions=known.get("versions", {}),
        **_steps(history, case, [point["load"] for point in known.get("critical_points", [])]),
    )


def _steps(
    history: Mapping[str, NDArray[Any]], case: Case, critical_loads: list[float]
) -> dict[str, Any]:
    """The table of steps: columns with units, rows of texts, and how many were left out."""
    units = {name: column_unit(name) for name in history}
    for name, instrument in getattr(case, "measurements", {}).items():
        units |= dict.fromkeys(instrument.columns(name), _INSTRUMENT_UNITS.get(instrument.kind, ""))
    columns = column_texts(history, units)
    number = len(history["load"])
    every = max(1, math.ceil(number / MOST_ROWS))
    critical = np.isin(history["load"], critical_loads)
    shown = [i for i in range(number) if i % every == 0 or i == number - 1 or critical[i]]
    rows = [
        {
            "texts": [column.texts[i] for column in columns],
            "mark": "critical" if critical[i] else "" if history["stable"][i] else "unstable",
        }
        for i in shown
    ]
    note = "All digits are in history.csv."
    if every > 1:
        note = f"{len(shown)} of {number} states; all of them, with all digits, are in history.csv."
    return {"columns": columns, "rows": rows, "rows_note": note}


def _figures(folder: Path) -> list[dict[str, Any]]:
    """The program's figures: curves, then states by load, a group each quantity."""
    groups: dict[str, dict[float, dict[str, str]]] = {name: {} for name in ("curves", *_STATES)}
    for path in folder.glob("*.png"):
        name, _, percent = path.stem.rpartition("_")
        if path.stem in _CURVES:
            group, place = "curves", float(list(_CURVES).index(path.stem))
            caption = _CURVES[path.stem]
        elif name in _STATES and percent.replace(".", "", 1).isdigit():
            group, place = name, float(percent)
            caption = f"{_STATES[name]} at {place:g} % of the load"
        else:  # not of this program
            continue
        data = base64.b64encode(path.read_bytes()).decode()
        groups[group][place] = {"caption": caption, "data": data}
    return [
        {"kind": "curves" if name == "curves" else "states", "figures": figures}
        for name, by_place in groups.items()
        if (figures := [by_place[place] for place in sorted(by_place)])
    ]


def _failure(report: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    """What is known about the end of a path, besides what the message says: that is the outcome."""
    return [
        (key.replace("_", " ").capitalize(), _value_text(value))
        for key, value in (report or {}).items()
        if key not in ("message", "reason", "advice") and value not in (None, "", [])
    ]


def _accuracy(accuracy: Mapping[str, Any] | None, message: str) -> dict[str, Any] | None:
    if accuracy is None:
        return None
    meshes = [
        {
            "cells": mesh["cells"],
            "dofs": mesh["dofs"],
            "force": _error(mesh["estimated_error_force"]),
            "energy": _error(mesh["estimated_error_energy"]),
        }
        for mesh in accuracy["meshes"]
    ]
    return {"sentence": message.removeprefix("Warning: "), "meshes": meshes}


def _facts(summary: Mapping[str, Any]) -> list[dict[str, Any]]:
    size = {**summary.get("dofs", {}), "cells": summary.get("cells", 0)}
    tables = {
        "Unknowns and cells": {name: f"{number:,}" for name, number in size.items()},
        "Seconds": {stage: f"{value:.2f}" for stage, value in summary.get("seconds", {}).items()},
        "Versions": summary.get("versions", {}),
    }
    if not summary:
        return []
    return [{"title": title, "rows": list(rows.items())} for title, rows in tables.items()]


def _value_text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value_text(part)}" for key, part in value.items())
    if isinstance(value, list):
        return ", ".join(_value_text(part) for part in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _error(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.1e}"
