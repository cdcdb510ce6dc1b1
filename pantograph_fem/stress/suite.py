"""The hard suite from start to end: select → run → judge."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from fnmatch import fnmatchcase
from pathlib import Path

from ..case import Case, case_to_toml
from ..case.problem import one_of
from ..errors import CaseError
from ..results.atomic import replace_text
from ..study.process import Ended, Runner, run_in_process
from .evidence import Evidence, read_evidence
from .hard_case import HardCase
from .judge import Verdict, judge
from .registry import HARD_CASES
from .time_limit import time_limit

#: File beside the results of a run that keeps how it ended.
ENDED = "ended.json"


@dataclass(frozen=True, eq=False)
class Result:
    """A hard case, what its run left, and the verdict."""

    hard: HardCase
    evidence: Evidence
    verdict: Verdict


def select(patterns: Sequence[str] = (), *, huge: bool = False) -> list[HardCase]:
    """The hard cases whose names match a pattern, or all, with those they are compared with.

    Parameters
    ----------
    patterns
        As of file names: ``d_*``.
    huge
        Whether those that take hours are among them.

    Raises
    ------
    CaseError
        If a pattern matches none.
    """
    known = {hard.name: hard for hard in HARD_CASES if huge or not hard.huge}
    wanted: set[str] = set() if patterns else set(known)
    for pattern in patterns:
        matching = {name for name in known if fnmatchcase(name, pattern)}
        if not matching:
            raise CaseError(
                f"--only {pattern}: there is no such hard case; `pantograph stress --list` "
                f"shows them: {one_of(list(known)[:3])} and others"
            )
        wanted |= matching
    for hard in HARD_CASES:
        if hard.name in wanted:
            wanted.update(other for expectation in hard.expect for other in expectation.others)
    return [hard for hard in HARD_CASES if hard.name in wanted]


def run_suite(
    hard_cases: Sequence[HardCase],
    directory: Path,
    *,
    runner: Runner = run_in_process,
    keep: bool = False,
    tell: Callable[[str], None] = lambda text: None,
) -> list[Result]:
    """Run hard cases, each in a process of its own, one at a time, and judge them.

    Parameters
    ----------
    hard_cases
        Those of :func:`select`.
    directory
        Folder of their folders; earlier results there are replaced.
    runner
        Simulates a case.
    keep
        Whether runs of exactly these cases that are there already are judged as they are.
    tell
        Is told how it goes on.

    Raises
    ------
    CaseError
        If a folder cannot be written to, or the shipped cases are not there.
    """
    found: dict[str, Evidence] = {}
    for number, hard in enumerate(hard_cases, 1):
        found[hard.name] = run_hard_case(hard, directory / hard.name, runner, keep)
        verdict = judge_alone(hard, found)
        words = verdict.outcome if verdict.passed else f"FAIL: {verdict.failures[0]}"
        seconds = found[hard.name].ended.cpu_seconds
        tell(f"{number}/{len(hard_cases)} {hard.name}: {words} ({seconds:.1f} s)")
    return [
        Result(hard, found[hard.name], judge(hard, found[hard.name], found)) for hard in hard_cases
    ]


def judge_alone(hard: HardCase, found: Mapping[str, Evidence]) -> Verdict:
    """The verdict as far as the runs that are there allow it."""
    known = tuple(e for e in hard.expect if all(other in found for other in e.others))
    return judge(replace(hard, expect=known), found[hard.name], found)


def run_hard_case(
    hard: HardCase, directory: Path, runner: Runner = run_in_process, keep: bool = False
) -> Evidence:
    """Run one within its time and read what it leaves.

    Raises
    ------
    CaseError
        If its folder cannot be written to, or the shipped cases are not there.
    """
    case = hard.load(directory)
    kept = _kept(case, directory) if keep else None
    if kept is None:
        for name in ("history.csv", "summary.json", ENDED):
            (directory / name).unlink(missing_ok=True)
        try:
            with time_limit(hard.limit):
                kept = runner(case, directory)
        except TimeoutError:
            return read_evidence(case, Ended(1, hard.limit), directory, timed_out=True)
        directory.mkdir(parents=True, exist_ok=True)
        replace_text(directory / ENDED, json.dumps(asdict(kept), indent=2) + "\n")
    return read_evidence(case, kept, directory)


def _kept(case: Case, directory: Path) -> Ended | None:
    """How a run of exactly this case ended, if there is one."""
    try:
        if (directory / "case.toml").read_text(encoding="utf-8") != case_to_toml(case):
            return None
        return Ended(**json.loads((directory / ENDED).read_text(encoding="utf-8")))
    except (OSError, ValueError, TypeError):
        return None
