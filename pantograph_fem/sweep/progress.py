"""What a sweep shows while it goes on: a bar on a terminal, else a plain line per point."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from .results import PointResult


class SweepProgress:
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
        self._keys = keys
        self._quiet = quiet
        self._stream = stream or sys.stdout
        self.finished = self.total = self.failed = 0
        self._bar: Bar | None = None
        if not quiet and self._stream.isatty():
            self._bar = Bar(
                TextColumn("{task.description}", markup=False),
                BarColumn(bar_width=None),
                MofNCompleteColumn(),
                TimeRemainingColumn(),
                TextColumn("{task.fields[state]}", markup=False),
                console=Console(file=self._stream),
                expand=True,
            )
            self._task = self._bar.add_task(title, total=None, state="")

    def __enter__(self) -> SweepProgress:
        if self._bar:
            self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._bar:
            self._bar.stop()

    def start(self, total: int, before: int) -> None:
        """Show how many points there are to run, and how many were over before."""
        self.total = total
        self._note(f"{total} to run, {before} run before")
        if self._bar:
            self._bar.update(self._task, total=total)

    def compiling(self) -> None:
        """Show that forms are compiled."""
        self._note("compiling the forms")

    def over(self, result: PointResult) -> None:
        """Show a point that is over."""
        self.finished += 1
        self.failed += not result.done
        values = zip(self._keys, result.point.values, strict=True)
        where = ", ".join(f"{key} = {_short(value)}" for key, value in values)
        text = f"{self.finished}/{self.total}  {where}: {result.status}"
        if self._bar:
            state = f"{self.failed} failed" if self.failed else ""
            self._bar.update(self._task, completed=self.finished, state=state)
            if not result.done:
                self._note(text)
        else:
            self._note(f"{text}, {result.cpu_seconds:.1f} s CPU")

    def _note(self, text: str) -> None:
        if self._quiet:
            return
        if self._bar:
            self._bar.console.print(text, markup=False, highlight=False)
        else:
            print(text, file=self._stream, flush=True)


def _short(value: object) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)
