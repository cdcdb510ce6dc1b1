"""What every case has, whatever its kind."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from pydantic import AfterValidator

from .part import Part
from .problem import Problem, not_allowed, problem_error

if TYPE_CHECKING:
    from .continuation import Continuation
    from .output import Output


def _file_name(value: str) -> str:
    """Accept what can safely name a folder of results."""
    if not re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", value):
        rule = "be a plain file name: letters, digits, _ . - and neither . nor - in front"
        raise problem_error(Problem(not_allowed(value, rule)))
    return value


class Case(Part):
    """What is simulated. Each kind of case has its own sections, in a class of its own.

    Attributes
    ----------
    name
        Plain file name; results go to ``results/<name>`` by default.
    title
        Title for figures and the progress bar.
    kind
        What is simulated; see :data:`pantograph_fem.case.kinds.KINDS`.
    """

    name: Annotated[str, AfterValidator(_file_name)]
    title: str = ""
    kind: str

    if TYPE_CHECKING:  # sections that every kind declares, after those on which they depend
        continuation: Continuation
        output: Output

    @property
    def input_files(self) -> tuple[Path, ...]:
        """Files besides the case file that the results depend on."""
        return ()
