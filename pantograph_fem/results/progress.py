"""What a run shows while it goes on: a bar on a terminal, else a plain line per step."""

from __future__ import annotations

import math

from ..terminal import Terminal
from .history import HistoryRow


class Progress(Terminal):
    """Report accepted and rejected steps; the bar is full at full load."""

    first_state = "starting"

    def accepted(self, row: HistoryRow, elapsed: float) -> None:
        """Show an accepted step; `elapsed` is the time in s since the run began."""
        force = f"force {math.hypot(*row.force):.4g} N"
        warning = "" if row.stable else "  unstable"
        if self.has_bar:
            state = (
                f"load {row.load:.4f}  step {row.step}  iterations {row.newton_iterations}"
                f"  {force}  {elapsed:.0f} s{warning}"
            )
            self.show(state, row.load)
        else:
            self.note(
                f"step {row.step}  load {row.load:.4f}  iterations {row.newton_iterations}"
                f"  {force}  energy {row.energy:.4g} J{warning}"
            )

    def rejected(self, load: float, step: float, reason: str) -> None:
        """Show that the load was not reached with a step of this size, and why."""
        self.note(f"cut back: load {load:.4f} not reached with a step of {step:.3g}: {reason}")
