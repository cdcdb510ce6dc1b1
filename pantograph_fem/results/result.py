"""What a run has left in its folder, for Python."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..case import Case, load_case
from ..errors import CaseError
from .history import read_history
from .report import REPORT_FILE
from .strict_json import read_json
from .summary import DONE

if TYPE_CHECKING:
    from .states import States


@dataclass(frozen=True)
class Result:
    """Results of a run, finished, stopped or interrupted; each is read when first asked for.

    Attributes
    ----------
    directory
        Their folder.
    """

    directory: Path

    @cached_property
    def case(self) -> Case:
        """What was simulated, with every value used."""
        return load_case(self.directory / "case.resolved.toml")

    @cached_property
    def history(self) -> dict[str, NDArray[Any]]:
        """Columns of ``history.csv`` by name, each of shape (k,) for k states, in SI units."""
        return read_history(self.directory / "history.csv")

    @property
    def last(self) -> dict[str, float | int | bool]:
        """The last row of the history, by column.

        Raises
        ------
        CaseError
            If no state was found.
        """
        if not len(self.history["load"]):
            raise CaseError(f"{self.directory / 'history.csv'} holds no state")
        return {name: values[-1].item() for name, values in self.history.items()}

    @cached_property
    def summary(self) -> dict[str, Any]:
        """``summary.json``; empty while a run goes on and where it was interrupted."""
        return read_json(self.directory / "summary.json") or {}

    @property
    def status(self) -> str:
        """How the run ended, as "done", "stopped at a critical load" or "stopped: " and the reason.

        "not finished" while it goes on and where it was interrupted.
        """
        return str(self.summary.get("status", "not finished"))

    @property
    def done(self) -> bool:
        """Whether the path was followed to its end."""
        return self.status == DONE

    def fields(self) -> States:
        """Return the saved states, as in ``result.fields()[-1]["displacement"]``.

        Raises
        ------
        CaseError
            If the run saved none, as with ``output.fields = "none"``.
        """
        from .fields import read_fields
        from .states import States

        return States(read_fields(self.directory))

    @property
    def figures(self) -> list[Path]:
        """The figures, in the order of their names; none where they were not asked for."""
        return sorted((self.directory / "figures").glob("*.png"))

    @property
    def report(self) -> Path | None:
        """The page ``report.html``; None where it was not asked for."""
        path = self.directory / REPORT_FILE
        return path if path.is_file() else None
