"""Compiling the forms of a case before anything is timed."""

from __future__ import annotations

import json
import os
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

#: Runs after which the cache counts as full in any case.
_MOST = 10


def forms_of(case: Any) -> str:
    """Text that is the same for cases whose forms are the same; empty where there are none."""
    if not hasattr(case, "discretisation"):
        return ""
    return json.dumps(case.model_dump(mode="json", exclude=_NOT_IN_FORMS), sort_keys=True)


def warm_up(case: Any, mesh: Any, runner: Runner) -> Ended:
    """Run a case on a coarse mesh until nothing more is compiled.

    One run is not enough: UFL numbers coefficients as they are made, compiling makes some, and
    the numbers can change the name under which a later form of the same process is cached.

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
    for _ in range(_MOST):
        before = _compiled()
        with tempfile.TemporaryDirectory() as folder:
            ended = runner(coarse, Path(folder, "warm_up"))
        if _compiled() <= before:
            break
    return ended


def _compiled() -> set[str]:
    """Names of the modules in the cache of dolfinx."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fenics"
    return {path.name for path in cache.glob("*.so")}
