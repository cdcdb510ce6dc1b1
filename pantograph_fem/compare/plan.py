"""What is compared: from folders, case files and study files to a list of runs."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..case import Case, load_case
from ..case.messages import case_error
from ..errors import CaseError
from .study import Study
from .study_file import load_study, read_toml


@dataclass(frozen=True)
class Entry:
    """A run to compare.

    Attributes
    ----------
    label
        Its name in tables and legends.
    directory
        Where its results are, or will be.
    case
        What to simulate; None when the results are only read.
    parameter
        Number by which the runs are ordered; None when it has none.
    reference
        Whether differences are taken against it.
    """

    label: str
    directory: Path
    case: Case | None = None
    parameter: float | None = None
    reference: bool = False


@dataclass(frozen=True)
class Plan:
    """The runs to compare, the study that says how, and where the comparison goes."""

    entries: tuple[Entry, ...]
    study: Study
    directory: Path


def make_plan(what: Sequence[Path], output: Path | None, overrides: Sequence[str]) -> Plan:
    """Find out what is to be compared, and check all of it.

    Without a study the first run is the reference, and a run is called by the name of its case or
    folder.

    Parameters
    ----------
    what
        Folders of results, case files, and at most one study file.
    output
        Where the comparison goes; ``results/<name of the study>`` or ``results/compare`` by
        default.
    overrides
        Values in place of those of every case that is run, each as ``key.path=value``.

    Raises
    ------
    CaseError
        When something is not found or wrong, or two runs cannot be told apart.
    """
    tables = {path: read_toml(path) for path in what if not _is_folder(path)}
    studies = [path for path, data in tables.items() if "runs" in data]
    if len(studies) > 1:
        raise CaseError(
            f"{studies[0]} and {studies[1]} are both study files; at most one can be compared at "
            "a time, beside any folders of results and case files"
        )
    if overrides and not tables:
        raise CaseError(
            f"--set {overrides[0]}: nothing is run here, as only folders of results are given; "
            "give a case file or a study file"
        )
    study = load_study(studies[0], tables[studies[0]]) if studies else Study()
    directory = output or Path("results") / study.name
    entries: list[Entry] = []
    for path in what:
        if path not in tables:
            entries.append(Entry(path.resolve().name, path, None))
        elif path in studies:
            entries += _study_entries(path, study, directory, overrides)
        else:
            case = load_case(path, overrides)
            entries.append(Entry(case.name, path, case))
    entries = _told_apart(entries, directory)
    if not studies and len(entries) > 1:
        entries[0] = replace(entries[0], reference=True)
    return Plan(tuple(entries), study, directory)


def _is_folder(path: Path) -> bool:
    if not path.exists():
        raise CaseError(
            f"{path} is not found; give a folder of results, a case file or a study file"
        )
    return path.is_dir()


def _study_entries(
    path: Path, study: Study, directory: Path, overrides: Sequence[str]
) -> list[Entry]:
    entries, problems = [], []
    for i, run in enumerate(study.runs):
        case_file = Path(os.path.normpath(path.parent / run.case))
        try:
            case = load_case(case_file, (*study.set, *run.set, *overrides))
        except CaseError as error:
            problems.append(f"runs[{i}]: " + str(error).replace("\n", "\n  "))
            continue
        entries.append(Entry(run.label, case_file, case, run.parameter, run.reference))
    if problems:
        raise case_error(str(path), problems)
    return entries


def _told_apart(entries: Sequence[Entry], directory: Path) -> list[Entry]:
    """Give runs of the same name the path they come from, and each that is run its folder."""
    names = Counter(entry.label for entry in entries)
    placed: dict[str, Entry] = {}
    folders: dict[Path, str] = {}
    for entry in entries:
        label, source = entry.label, entry.directory
        if names[label] > 1:
            label = f"{label} ({source})"
        if label in placed:
            raise CaseError(
                f'two runs are called "{label}"; give each a label of its own, or compare it once'
            )
        folder = directory / _folder_name(label) if entry.case else source
        if other := folders.get(folder.resolve()):
            raise CaseError(
                f'the runs "{other}" and "{label}" would share the folder {folder}; their labels '
                "must differ in letters, digits, _ . or -"
            )
        folders[folder.resolve()] = label
        placed[label] = replace(entry, label=label, directory=folder)
    return list(placed.values())


def _folder_name(label: str) -> str:
    """Plain file name like the label: "lattice, 4.8 mm" becomes ``lattice_4.8_mm``."""
    return re.sub(r"[^\w.-]+", "_", label, flags=re.ASCII).strip("_.-") or "run"
