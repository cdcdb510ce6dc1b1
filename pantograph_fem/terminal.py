"""A bar on a terminal, with lines above it; plain lines where there is no terminal."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Self, TextIO

from rich.console import Console
from rich.progress import BarColumn, ProgressColumn, TextColumn
from rich.progress import Progress as Bar


class Terminal:
    """Shows how far something has come, as a context manager.

    Attributes
    ----------
    first_state
        What the bar says until it is told.

    Parameters
    ----------
    title
        Shown beside the bar.
    columns
        Of the bar, between the bar itself and the state in words.
    total
        At which the bar is full; None: to be told.
    quiet
        Show nothing.
    plain
        Write lines even to a terminal.
    stream
        Where to write; standard output by default.
    """

    first_state = ""

    def __init__(
        self,
        title: str = "",
        columns: tuple[ProgressColumn, ...] = (),
        total: float | None = 1.0,
        *,
        quiet: bool = False,
        plain: bool = False,
        stream: TextIO | None = None,
    ) -> None:
        self._stream = stream or sys.stdout
        self._quiet = quiet
        self._bar: Bar | None = None
        if not quiet and not plain and self._stream.isatty():
            self._bar = Bar(
                TextColumn("{task.description}", markup=False),
                BarColumn(bar_width=None),
                *columns,
                TextColumn("{task.fields[state]}", markup=False),
                console=Console(file=self._stream),
                expand=True,
            )
            self._task = self._bar.add_task(title, total=total, state=self.first_state)

    def __enter__(self) -> Self:
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

    @property
    def has_bar(self) -> bool:
        """Whether a bar is shown."""
        return self._bar is not None

    def show(
        self, state: str | None = None, completed: float | None = None, total: float | None = None
    ) -> None:
        """Change what the bar shows, if there is one."""
        if self._bar is None:
            return
        self._bar.update(self._task, completed=completed, total=total)
        if state is not None:
            self._bar.update(self._task, state=state)

    def note(self, text: str) -> None:
        """Show a line of text."""
        if self._quiet:
            return
        if self._bar:
            self._bar.console.print(text, markup=False, highlight=False)
        else:
            print(text, file=self._stream, flush=True)
