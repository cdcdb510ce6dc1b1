"""Data made of a case with known constants: what a test would give, errors included."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..errors import CaseError
from ..results.atomic import replace_text
from .data import error_of, selected
from .parameters import Parameter
from .paths import Paths
from .problem import Experiment
from .study import DataFile, IdentifyStudy


def write_synthetic(
    study: IdentifyStudy,
    experiment: Experiment,
    folder: Path,
    tell: Callable[[str], None] = lambda text: None,
) -> list[Path]:
    """Write a file for each of the study's files, with its columns and standard errors.

    The constants are those of the case; the errors that are drawn are normal and independent.

    Raises
    ------
    CaseError
        If the study gives no standard errors for a file, or the case lacks an effect.
    PathError
        If the case has no path.
    """
    loads = study.synthetic.loads or tuple(experiment.case.continuation.stops)
    values = _true_values(experiment, loads)
    rng = np.random.default_rng(study.synthetic.seed)
    written = []
    for number, file in enumerate(study.data):
        columns = selected(file.errors, experiment.columns)
        if not columns:
            raise CaseError(
                f"data[{number}].errors: synthetic data are made of the columns that have standard "
                f"errors here, and these match none of {', '.join(experiment.columns)}"
            )
        errors = np.array([error_of(file.errors, column) for column in columns], dtype=float)
        exact = values[:, [experiment.columns.index(column) for column in columns]]
        noisy = exact + study.synthetic.noise * errors * rng.standard_normal(exact.shape)
        path = folder / Path(file.file).name
        folder.mkdir(parents=True, exist_ok=True)
        replace_text(path, _table(loads, experiment.distance, columns, noisy, errors))
        tell(f"{len(loads)} states of {len(columns)} columns are in {path}")
        written.append(path)
    return written


def in_folder(file: DataFile, folder: Path) -> DataFile:
    """The study's table of a file, for what was made of it in a folder."""
    return file.model_copy(update={"file": str((folder / Path(file.file).name).resolve())})


def _true_values(experiment: Experiment, loads: tuple[float, ...]) -> np.ndarray:
    material = experiment.case.material
    parameters = []
    for p in experiment.parameters:
        true = getattr(material, p.name)
        if not isinstance(true, float):
            raise CaseError(
                f"material.{p.name}: synthetic data need one number for both families, that which "
                "is to be found again"
            )
        parameters.append(Parameter(p.name, true, min(p.lower, true), max(p.upper, true)))
    truth = Experiment(experiment.case, tuple(parameters), experiment.columns, experiment.distance)
    return Paths(truth.model_case, parameters, loads).at(np.zeros(len(parameters))).values


def _table(
    loads: tuple[float, ...],
    distance: float,
    columns: list[str],
    values: np.ndarray,
    errors: np.ndarray,
) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    drive, full = ("displacement", distance) if distance else ("load", 1.0)
    writer.writerow([drive, *(part for name in columns for part in (name, f"{name}_error"))])
    for load, row in zip(loads, values.tolist(), strict=True):
        pairs = zip(row, errors.tolist(), strict=True)
        cells = [f"{cell:.10g}" for pair in pairs for cell in pair]
        writer.writerow([f"{load * full:.10g}", *cells])
    return text.getvalue()
