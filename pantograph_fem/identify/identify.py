"""Constants from measured data: study → experiment and data → fit → what is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .advice import advice, advice_sentence
from .data import Observations, collect
from .estimates import Estimate, correlation_of, estimates_of, sentences
from .fit import Fit, fit
from .paths import Cost, Paths
from .problem import Experiment, experiment_of, measured
from .profile import Profile, profile_of
from .quantities import quantities_of
from .study import IdentifyStudy
from .study_file import load_identify_study
from .synthetic import in_folder, write_synthetic

Array = NDArray[np.float64]
Tell = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Identification:
    """What was found.

    Attributes
    ----------
    study, experiment, observations, directory
        What was asked for, and where it goes.
    paths
        The model, for figures of its states.
    fit, estimates, correlation
        The best constants and how well they are known.
    sentences
        That in words.
    cost
        Of the fit, without profiles.
    profiles
        χ² along each constant; empty where not asked for.
    """

    study: IdentifyStudy
    experiment: Experiment
    observations: Observations
    directory: Path
    paths: Paths
    fit: Fit
    estimates: tuple[Estimate, ...]
    correlation: Array
    sentences: tuple[str, ...]
    cost: Cost
    profiles: tuple[Profile, ...]


def identify(
    study_file: Path,
    directory: Path | None = None,
    *,
    synthetic: bool = False,
    profiles: bool = True,
    tell: Tell = lambda text: None,
) -> Identification:
    """Find the constants of a study.

    Parameters
    ----------
    study_file
        TOML file; see :class:`~pantograph_fem.identify.study.IdentifyStudy`.
    directory
        Where results go; ``results/<name>`` by default.
    synthetic
        Whether data are first made of the case, and used in place of the files of the study.
    profiles
        Whether χ² is followed along each constant.
    tell
        Is told how the search goes.

    Raises
    ------
    CaseError
        If the study, its case or its data are wrong.
    PathError
        If there is no equilibrium path with the constants at their start.
    """
    study = load_identify_study(study_file)
    directory = directory or Path("results") / study.name
    folder = study_file.resolve().parent
    experiment = experiment_of(study, folder)
    if synthetic:
        made = directory / "synthetic"
        write_synthetic(study, experiment, made, tell)
        files = tuple(in_folder(file, made) for file in study.data)
        study = study.model_copy(update={"data": files})
    observations = collect(measured(study, folder, experiment), experiment.columns)
    paths = Paths(experiment.model_case, experiment.parameters, observations.loads.tolist())
    best = fit(paths, observations, tell=tell)
    cost = paths.cost.copy()
    estimates = estimates_of(best, experiment.parameters, study.confidence)
    correlation = correlation_of(best)
    told = sentences(best, estimates, study.confidence, correlation)
    told += _advice(best, observations, experiment, estimates)
    curves = [
        profile_of(paths, observations, best, i, tell)
        for i in range(len(experiment.parameters) if profiles else 0)
    ]
    return Identification(
        study=study,
        experiment=experiment,
        observations=observations,
        directory=directory,
        paths=paths,
        fit=best,
        estimates=tuple(estimates),
        correlation=correlation,
        sentences=tuple(told),
        cost=cost,
        profiles=tuple(curves),
    )


def _advice(
    best: Fit, observations: Observations, experiment: Experiment, estimates: list[Estimate]
) -> list[str]:
    """A measurement for each constant that is not known."""
    units = quantities_of(experiment.case)
    told = []
    for number, estimate in enumerate(estimates):
        if estimate.known:
            continue
        if one := advice(best, observations, experiment.columns, number):
            told.append(advice_sentence(estimate, one, units[one.column].unit))
    return told
