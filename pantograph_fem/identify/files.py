"""Files of an identification: ``identify.json``, ``fit.csv`` and the case that was found."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

from ..case import case_to_toml
from ..results.atomic import replace_text
from ..results.summary import package_versions
from .identify import Identification
from .parameters import values_of


def write_files(found: Identification) -> list[Path]:
    """Write to the directory, made if it is not there, and return the paths.

    ``identify.json`` has estimates, intervals, correlations, χ² and the cost; ``fit.csv`` a row
    per value that was measured; ``case.identified.toml`` is the case with the constants found.
    """
    directory = found.directory
    directory.mkdir(parents=True, exist_ok=True)
    names = ("identify.json", "fit.csv", "case.identified.toml")
    paths = [directory / name for name in names]
    replace_text(paths[0], json.dumps(as_dict(found), indent=2, ensure_ascii=False) + "\n")
    replace_text(paths[1], _fit_table(found))
    constants = values_of(found.experiment.parameters, found.fit.q)
    case = found.experiment.case
    material = case.material.model_copy(update=constants)
    replace_text(paths[2], case_to_toml(case.model_copy(update={"material": material})))
    return paths


def as_dict(found: Identification) -> dict[str, object]:
    """The contents of ``identify.json``."""
    names = [e.parameter.name for e in found.estimates]
    return {
        "name": found.study.name,
        "case": found.experiment.case.name,
        "estimates": {
            e.parameter.name: {
                "symbol": e.parameter.symbol,
                "unit": e.parameter.unit,
                "start": e.parameter.start,
                "value": e.value,
                "standard_error": e.standard_error,
                "interval": list(e.interval),
                "known": e.known,
            }
            for e in found.estimates
        },
        "confidence": found.study.confidence,
        "correlation": {
            name: dict(zip(names, row, strict=True))
            for name, row in zip(names, found.correlation.tolist(), strict=True)
        },
        "chi2": found.fit.chi2,
        "values": len(found.observations.values),
        "degrees_of_freedom": len(found.observations.values) - len(names),
        "converged": found.fit.converged,
        "stable": all(found.fit.path.stable),
        "sentences": list(found.sentences),
        "profiles": {
            e.parameter.name: {
                "value": [e.parameter.value(q) for q in profile.q.tolist()],
                "chi2": profile.chi2.tolist(),
            }
            for e, profile in zip(found.estimates, found.profiles, strict=False)
        },
        "cost": {
            "paths": found.cost.paths,
            "paths_from_rest": found.cost.from_rest,
            "tangents": found.cost.tangents[0],
            "tangents_of_a_path_from_rest": found.cost.tangents[1],
            "seconds": found.cost.seconds[0],
            "in_paths_from_rest": found.cost.worth,
        },
        "versions": package_versions(),
    }


def _fit_table(found: Identification) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["load", "displacement", "column", "value", "error", "model", "residual"])
    observed = found.observations
    for i, residual in enumerate(found.fit.residuals.tolist()):
        load = float(observed.loads[observed.load[i]])
        model = float(found.fit.path.values[observed.load[i], observed.column[i]])
        numbers = (float(observed.values[i]), float(observed.errors[i]), model, residual)
        column = found.experiment.columns[observed.column[i]]
        displacement = load * found.experiment.distance
        writer.writerow([repr(load), repr(displacement), column, *map(repr, numbers)])
    return text.getvalue()
