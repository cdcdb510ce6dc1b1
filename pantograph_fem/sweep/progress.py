"""What a sweep shows while it goes on: a bar on a terminal, else a plain line per point."""

from __future__ import annotations

from typing import TextIO

from rich.progress import MofNCompleteColumn, TimeRemainingColumn

from ..terminal import Terminal
from .results import PointResult


class SweepProgress(Terminal):
    """Report points that are over, as a context manager.

    Parameters
    ----------
    title
        Title of the sweep, shown beside the bar.
    keys
        The varied keys.
    quiet
        Show nothing.
    stream
        Where to write; standard output by default.
    """

    def __init__(
        self,
        title: str = "",
        keys: tuple[str, ...] = (),
        *,
        quiet: bool = False,
        stream: TextIO | None = None,
    ) -> None:
        columns = MofNCompleteColumn(), TimeRemainingColumn()
        super().__init__(title, columns, None, quiet=quiet, stream=stream)
        self._keys = keys
        self.finished = self.total = self.failed = 0

    def start(self, total: int, before: int) -> None:
        """Show how many points there are to run, and how many were over before."""
        self.total = total
        self.note(f"{total} to run, {before} run before")
        self.show(total=total)

    def compiling(self) -> None:
        """Show that forms are compiled."""
        self.note("compiling the forms")

    def over(self, result: PointResult) -> None:
        """Show a point that is over."""
        self.finished += 1
        self.failed += not result.done
        values = zip(self._keys, result.point.values, strict=True)
        where = ", ".join(f"{key} = {_short(value)}" for key, value in values)
        text = f"{self.finished}/{self.total}  {where}: {result.status}"
        self.show(f"{self.failed} failed" if self.failed else "", self.finished)
        if not self.has_bar:
            self.note(f"{text}, {result.cpu_seconds:.1f} s CPU")
        elif not result.done:
            self.note(text)


def _short(value: object) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)
