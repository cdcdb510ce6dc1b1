"""Compiling the forms of a case before anything is timed."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from ..case import Case
from ..case.continuation import Continuation
from .process import Ended, Runner

#: Sections of a case of which the compiled forms know nothing.
_NOT_IN_FORMS = {"name", "title", "mesh", "continuation", "output"}

#: One step of one iteration: it is rejected, and by then all forms have been compiled.
_ONE_ITERATION = Continuation(initial_step=1.0, min_step=1.0, max_step=1.0, max_iterations=1)


def forms_of(case: Any) -> str:
    """Text that is the same for cases whose forms are the same; empty where there are none."""
    if not hasattr(case, "discretisation"):
        return ""
    return json.dumps(case.model_dump(mode="json", exclude=_NOT_IN_FORMS), sort_keys=True)


def warm_up(case: Any, mesh: Any, runner: Runner) -> Ended:
    """Run a case on a coarse mesh, which compiles what the cache has not yet.

    Parameters
    ----------
    case
        A case with forms.
    mesh
        Its section ``mesh`` for this.
    runner
        Simulates it.
    """
    coarse: Case = case.model_copy(update={"mesh": mesh, "continuation": _ONE_ITERATION})
    with tempfile.TemporaryDirectory() as folder:
        return runner(coarse, Path(folder, "warm_up"))
