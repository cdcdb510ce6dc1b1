"""A verdict on a run, by what it left behind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..errors import PathError
from .checks import ALWAYS, energy_is_work, finite
from .evidence import Evidence
from .hard_case import HardCase


@dataclass(frozen=True)
class Verdict:
    """What is to be said of a run.

    Attributes
    ----------
    failures
        What does not hold; empty where all does.
    outcome
        How it ended, in words.
    """

    failures: tuple[str, ...]
    outcome: str

    @property
    def passed(self) -> bool:
        """Whether everything holds."""
        return not self.failures


def judge(hard: HardCase, found: Evidence, others: Mapping[str, Evidence] | None = None) -> Verdict:
    """Judge a run.

    Parameters
    ----------
    hard
        What was run, and what must hold.
    found
        What the run left.
    others
        The other runs by name: at least those that the expectations name.
    """
    return Verdict(tuple(_failures(hard, found, others or {})), outcome(found))


def outcome(found: Evidence) -> str:
    """How a run ended and whether its states are stable, in words."""
    if found.timed_out:
        return "ran out of time"
    code = found.ended.code
    if code == PathError.exit_code and found.rows:
        head = f"stopped at load {found.last('load'):.4g}"
    elif code == PathError.exit_code:
        head = "stopped before its first state"
    elif code:
        return f"signal {-code}" if code < 0 else f"exit code {code}"
    elif not found.rows:
        return "done, without a state"
    else:
        head = str(found.summary.get("status", "done"))
    if not found.rows:
        return head
    parts = [head, *(f"{point['kind']} at {point['load']:.4g}" for point in found.critical_points)]
    unstable = ~found.history["stable"]
    if unstable[-1]:
        parts.append("unstable at the end")
    elif unstable.any():
        parts.append("unstable on the way")
    return ", ".join(parts)


def _failures(hard: HardCase, found: Evidence, others: Mapping[str, Evidence]) -> list[str]:
    if broken := _ended_badly(hard, found):
        return [broken]
    if not found.rows:
        return [] if hard.may_stop and not found.done else ["there is no state"]
    if broken := finite(found):
        return [broken]
    failures = [check(found) for check in ALWAYS]
    if hard.balanced:
        failures.append(energy_is_work(found))
    failures += [
        expectation.objection(found, others)
        for expectation in hard.expect
        if found.done or not expectation.of_the_end
    ]
    return [failure for failure in failures if failure]


def _ended_badly(hard: HardCase, found: Evidence) -> str:
    """What is wrong with the way in which it ended."""
    if found.timed_out:
        return f"it did not end within {hard.limit:g} s"
    code, message = found.ended.code, found.ended.message
    if code not in (0, PathError.exit_code) or "Traceback" in message:
        by = f"signal {-code}" if code < 0 else f"exit code {code}"
        return f"it crashed with {by}: {(message.splitlines() or ['no message'])[-1]}"
    if code == 0:
        return ""
    if not message:
        return "exit code 3 without a message"
    return "" if hard.may_stop else f"it stopped: {message.splitlines()[0]}"
