"""Hard cases: run as a user would, and judged by what their results say, not by the solver."""

from .suite import Result, run_suite, select

__all__ = ["Result", "run_suite", "select"]
