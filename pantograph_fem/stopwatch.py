"""Seconds spent in each stage of a run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter


class Stopwatch:
    """Adds up wall time by name: ``with clock("assemble"): ...``.

    A stage inside another counts for itself alone, so the stages add up to the total.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._start = perf_counter()
        self._inner: list[float] = []

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Count the time of the block for `stage`."""
        start = perf_counter()
        self._inner.append(0.0)
        try:
            yield
        finally:
            elapsed = perf_counter() - start
            own = elapsed - self._inner.pop()
            self.seconds[stage] = self.seconds.get(stage, 0.0) + own
            if self._inner:
                self._inner[-1] += elapsed

    @property
    def total(self) -> float:
        """Seconds since the stopwatch was made."""
        return perf_counter() - self._start
