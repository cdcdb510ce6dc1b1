"""PETSc's SNES, set up for Newton steps that somebody else computes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from petsc4py import PETSc

#: "bt" shortens steps until the residual, or an objective, is smaller; "l2" seeks the length, be it
#: shorter or longer than Newton's step, at which the residual is smallest.
LineSearch = Literal["bt", "l2"]

#: A bound that is never met in practice: each step with an old factor contracts the error.
_STEPS_PER_TANGENT = 20


def newton_snes(
    matrix: PETSc.Mat,
    step: Any,
    residual: Callable[..., None],
    tangent: Callable[..., None],
    test: Callable[..., int],
    tangents: int,
    *,
    line_search: LineSearch = "bt",
    objective: Callable[..., float] | None = None,
) -> PETSc.SNES:
    """Newton's method with a line search.

    Parameters
    ----------
    matrix
        Gives the layout of vectors.
    step
        Computes Newton's step from the residual, as the context of a PETSc preconditioner.
    residual, tangent, test
        SNES calls these for the residual, at each new iterate, and to know whether to go on.
    tangents
        How many may be factorised.
    line_search
        How steps are shortened.
    objective
        What they shall make smaller in place of the residual.
    """
    snes = PETSc.SNES().create(matrix.comm)
    ksp = snes.getKSP()
    ksp.setType(PETSc.KSP.Type.PREONLY)
    ksp.getPC().setType(PETSc.PC.Type.PYTHON)
    ksp.getPC().setPythonContext(step)
    snes.setFunction(residual, matrix.createVecLeft())
    snes.setJacobian(tangent, matrix)
    if objective is not None:
        snes.setObjective(objective)
    if line_search != "bt":
        _choose(snes, line_search)
    snes.setConvergenceTest(test)
    # The test above replaces the tolerances of SNES, which still holds that on the step against
    # line searches that failed: a state that was not left any more would count as found.
    snes.setTolerances(stol=0.0, max_it=_STEPS_PER_TANGENT * tangents)
    return snes


def _choose(snes: PETSc.SNES, line_search: LineSearch) -> None:
    """By the options database, the only way in petsc4py 3.18."""
    prefix = f"pantograph_{line_search}_"
    PETSc.Options()[f"{prefix}snes_linesearch_type"] = line_search
    snes.setOptionsPrefix(prefix)
    snes.setFromOptions()
