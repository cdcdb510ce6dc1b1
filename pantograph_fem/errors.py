"""Errors that a user can act on; each has its exit code on the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .results.result import Result
    from .solve.failure import FailureReport


class PantographError(Exception):
    """Anything that went wrong and is explained in the message; exit code 1."""

    exit_code = 1


class CaseError(PantographError):
    """The case file, the mesh or the arguments are wrong; exit code 2.

    The message names the key, the value and what is allowed.
    """

    exit_code = 2


class ResultsError(PantographError):
    """Results could not be written; exit code 1. What was written before is complete."""


class PathError(PantographError):
    """The equilibrium path could not be followed to the end; exit code 3.

    The message names the load, the cause and a setting to try. What was accepted before is kept.

    Attributes
    ----------
    report
        All that is known about it, where a path was followed and its end looked into.
    result
        What was found before, where the error comes from `pantograph_fem.run`.
    """

    exit_code = 3

    def __init__(self, message: str, report: FailureReport | None = None) -> None:
        super().__init__(message)
        self.report = report
        self.result: Result | None = None
