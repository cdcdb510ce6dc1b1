"""What a run shows while it goes on: a bar on a terminal, else a plain line per step."""

from __future__ import annotations

import math
import sys
from types import TracebackType
from typing import TextIO

from rich.console import Console
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar

from .history import HistoryRow


class Progress:
    """Report accepted and rejected steps, as a context manager.

    Parameters
    ----------
    title
        Title of the case, shown beside the bar.
    quiet
        Show nothing.
    plain
        Write lines even to a terminal.
    stream
        Where to write; standard output by default.
    """

    def __init__(
        self,
        title: str = "",
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
                TextColumn("{task.fields[state]}", markup=False),
                console=Console(file=self._stream),
                expand=True,
            )
            self._task = self._bar.add_task(title, total=1.0, state="starting")

    def __enter__(self) -> Progress:
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

    def accepted(self, row: HistoryRow, elapsed: float) -> None:
        """Show an accepted step; `elapsed` is the time in s since the run began."""
        force = f"force {math.hypot(*row.force):.4g} N"
        warning = "" if row.stable else "  unstable"
        if self._bar:
            state = (
                f"load {row.load:.4f}  step {row.step}  iterations {row.newton_iterations}"
                f"  {force}  {elapsed:.0f} s{warning}"
            )
            self._bar.update(self._task, completed=row.load, state=state)
        else:
            self.note(
                f"step {row.step}  load {row.load:.4f}  iterations {row.newton_iterations}"
                f"  {force}  energy {row.energy:.4g} J{warning}"
            )

    def rejected(self, load: float, step: float, reason: str) -> None:
        """Show that the load was not reached with a step of this size, and why."""
        self.note(f"cut back: load {load:.4f} not reached with a step of {step:.3g}: {reason}")

    def note(self, text: str) -> None:
        """Show a line of text."""
        if self._quiet:
            return
        if self._bar:
            self._bar.console.print(text, markup=False, highlight=False)
        else:
            print(text, file=self._stream, flush=True)
