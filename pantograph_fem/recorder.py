"""Writes what a run finds: history, fields, figures, summary; and shows its progress."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from . import checkpoint
from .case import case_to_toml
from .checkpoint import Saved
from .errors import CaseError
from .parallel import at_root
from .results.atomic import replace_text
from .results.fields import FieldGrid
from .results.fields_writer import FieldsWriter
from .results.history import HistoryRow, HistoryWriter
from .results.progress import Progress
from .results.summary import package_versions, write_summary
from .simulation import Simulation
from .solve.continuation import Step
from .stopwatch import Stopwatch

if TYPE_CHECKING:
    from mpi4py import MPI

    from .case import Case


class Recorder:
    """Results of one run. Every method is collective; files are written on rank 0.

    Use as a context manager around the path; call :meth:`finish` after it.
    """

    def __init__(
        self,
        case: Case,
        simulation: Simulation,
        directory: Path,
        clock: Stopwatch,
        comm: MPI.Comm,
        quiet: bool,
        resumed: Saved | None = None,
    ) -> None:
        self._case = case
        self._simulation = simulation
        self._directory = directory
        self._clock = clock
        self._comm = comm
        # Once: it reads the mesh file, which may change while the run goes on.
        self._fingerprint = checkpoint.fingerprint(case)
        self._progress = Progress(
            case.title or case.name,
            quiet=quiet or comm.rank != 0,
            # mpirun gives its processes a terminal even where it has none itself.
            plain=comm.size > 1,
        )
        self._history: HistoryWriter | None = None
        self._fields: FieldsWriter | None = None
        self._kept_rows = resumed.rows if resumed else 0
        self._kept_states = resumed.states if resumed else 0
        self._states = self._kept_states
        self.rows: list[HistoryRow] = []

    def __enter__(self) -> Recorder:
        with self._clock("output"):
            grid = self._simulation.grid()
            at_root(self._comm, lambda: self._open(grid))
        self._progress.__enter__()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._progress.__exit__(kind, error, traceback)
        if self._history is not None:
            self._history.close()

    def accepted(self, step: Step) -> None:
        """Write a state to the history and, if asked for, to the fields."""
        with self._clock("output"):
            observation = self._simulation.observe(step)
            wanted = self._case.output.fields
            keep = wanted == "all" or (wanted == "stops" and step.is_stop)
            before = Saved(step.checkpoint, self._kept_rows + len(self.rows), self._states)

            def write() -> None:
                assert observation is not None
                assert self._history is not None
                self.rows.append(observation.row)
                self._history.write(observation.row)
                if self._fields is not None and keep:
                    self._fields.write(step.load, observation.fields, observation.cell_fields)
                    self._states += 1
                self._progress.accepted(observation.row, self._clock.total)

            at_root(self._comm, write)
            # Last: if the run dies before this, it is taken up one state earlier.
            checkpoint.save(self._directory, self._comm, self._fingerprint, before)

    def rejected(self, load: float, step: float, reason: str) -> None:
        """Show a step that was cut back."""
        self._progress.rejected(load, step, reason)

    def finish(self, status: str) -> None:
        """Draw the figures and write the summary."""
        at_root(self._comm, lambda: self._finish(status))

    def _open(self, grid: FieldGrid | None) -> None:
        try:
            self._directory.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise CaseError(
                f"--output: {self._directory} cannot be made: {error.strerror}; give another"
            ) from None
        self._remove_stale()
        replace_text(self._directory / "case.resolved.toml", case_to_toml(self._case))
        self._history = HistoryWriter(
            self._directory / "history.csv",
            len(self._case.output.probes),
            self._kept_rows,
            self._simulation.extra_columns,
        )
        if self._case.output.fields != "none" and grid is not None:
            self._fields = FieldsWriter(self._directory, grid, self._kept_states)

    def _remove_stale(self) -> None:
        """Remove what an earlier run left and this one does not go on from."""
        stale = [self._directory / "summary.json", *self._directory.glob("figures/*.png")]
        if not self._kept_states:
            stale += [self._directory / "fields.xdmf", self._directory / "fields.h5"]
        if not self._kept_rows:
            stale += [self._directory / checkpoint.NAME]
        for path in stale:
            path.unlink(missing_ok=True)
        figures = self._directory / "figures"
        if figures.is_dir() and not any(figures.iterdir()):
            figures.rmdir()

    def _finish(self, status: str) -> None:
        # Before the figures too: a run is not lost because drawing it failed.
        self._write_summary(status)
        if self._case.output.figures:
            from .plot import plot

            with self._clock("output"):
                plot(self._directory)
            self._write_summary(status)

    def _write_summary(self, status: str) -> None:
        write_summary(
            self._directory / "summary.json",
            status=status,
            last=self.rows[-1] if self.rows else None,
            dofs=self._simulation.dofs,
            cells=self._simulation.cells,
            seconds={**self._clock.seconds, "total": self._clock.total},
            versions=package_versions(),
        )
