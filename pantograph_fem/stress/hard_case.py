"""What a hard case is: a case of ``cases/`` with some values replaced, and what must hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..case import Case, load_case
from ..errors import CaseError
from .expectation import Expectation

#: The cases that are shipped, which belong to the sources and not to the installed package.
CASES = Path(__file__).resolve().parents[2] / "cases"

#: Of every hard case: the numbers alone, and the lowest eigenvalue with each state.
_ALWAYS = (
    "output.figures=false",
    'output.fields="none"',
    "output.eigenvalues=true",
    "output.probes=[]",
)


@dataclass(frozen=True)
class HardCase:
    """A case that is hard, as data.

    Attributes
    ----------
    name
        Names its folder and its row of the table.
    hard
        What is hard about it, in a few words.
    base
        Stem of a file in ``cases/``.
    overrides
        Values in place of those of the file, as ``--set`` takes them.
    expect
        What must hold besides what holds of every result.
    may_stop
        Whether exit code 3 with a message is an answer, as where no equilibrium is known to exist.
    balanced
        Whether energy and work are compared; not where steps are too long for that.
    mesh
        Writes a mesh for the case; by default it has a mesh of its own.
    huge
        Whether it is run on demand alone.
    quick
        Whether the tests run it too.
    limit
        Wall time after which it counts as hanging, s.
    """

    name: str
    hard: str
    base: str
    overrides: tuple[str, ...] = ()
    expect: tuple[Expectation, ...] = field(default=())
    may_stop: bool = False
    balanced: bool = True
    mesh: Callable[[Path], None] | None = None
    huge: bool = False
    quick: bool = False
    limit: float = 300.0

    def load(self, directory: Path) -> Case:
        """The case; a mesh of its own is written to the folder.

        Raises
        ------
        CaseError
            If the shipped cases are not there, or an override does not fit.
        """
        if not CASES.is_dir():
            raise CaseError(
                f"the hard cases start from those in {CASES}, which is not there; run "
                "`pantograph stress` in a clone of the sources, installed with pip install -e"
            )
        overrides = [*_ALWAYS, *self.overrides]
        if self.mesh is not None:
            directory.mkdir(parents=True, exist_ok=True)
            path = directory.resolve() / "mesh.msh"
            self.mesh(path)
            overrides.append(f"mesh.file='{path}'")
        return load_case(CASES / f"{self.base}.toml", overrides)
