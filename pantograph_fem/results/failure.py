"""The file ``failure.json``: why a path ended before its last stop."""

from __future__ import annotations

from pathlib import Path

from ..errors import PathError
from .atomic import replace_text
from .strict_json import to_json

#: Its name in the folder of results.
FAILURE_FILE = "failure.json"


def write_failure(directory: Path, error: PathError) -> None:
    """Write the message and, if there is one, the report.

    The keys are "message" and the attributes of
    :class:`pantograph_fem.solve.failure.FailureReport` and of its diagnosis.
    """
    report = {} if error.report is None else error.report.as_dict()
    replace_text(directory / FAILURE_FILE, to_json({"message": str(error), **report}))
