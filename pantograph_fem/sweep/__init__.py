"""One case at many values of its keys: designs, runs in parallel, one table, sensitivities."""

from .sweep import SweepResult, sweep, write

__all__ = ["SweepResult", "sweep", "write"]
