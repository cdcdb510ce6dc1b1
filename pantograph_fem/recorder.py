"""Writes what a run finds: history, fields, figures, summary; and shows its progress."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

import numpy as np

from . import checkpoint
from .case import case_to_toml
from .checkpoint import Saved
from .errors import CaseError, ResultsError
from .leftovers import remove_leftovers
from .parallel import at_root
from .results.atomic import replace_text
from .results.fields import FieldGrid
from .results.fields_writer import FieldsWriter
from .results.history import HistoryRow, HistoryWriter
from .results.progress import Progress
from .results.report import REPORT_FILE, write_report
from .results.summary import package_versions, write_summary
from .simulation import OnElements, Simulation
from .solve.continuation import Array, Step
from .stopwatch import Stopwatch

if TYPE_CHECKING:
    from mpi4py import MPI

    from .adapt.accuracy import Accuracy
    from .case import Case
    from .continuum.element_files import ElementFiles

#: Column of the lowest eigenvalue of the tangent, in typical energies.
EIGENVALUE = "lowest_eigenvalue"


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
        accuracy: Accuracy | None = None,
    ) -> None:
        self._case = case
        self._simulation = simulation
        self._directory = directory
        self._clock = clock
        self._comm = comm
        # Once: it reads the mesh file, which may change while the run goes on.
        self._fingerprint = checkpoint.fingerprint(case)
        self._unknowns = checkpoint.gathered(comm, simulation.unknowns)
        self._progress = Progress(
            case.title or case.name,
            quiet=quiet or comm.rank != 0,
            # mpirun gives its processes a terminal even where it has none itself.
            plain=comm.size > 1,
        )
        self._accuracy = accuracy
        self._critical = list(resumed.critical_points) if resumed else []
        self._cutbacks = 0
        self._history: HistoryWriter | None = None
        self._fields: FieldsWriter | None = None
        self._elements: ElementFiles | None = None
        self._kept_rows = resumed.rows if resumed else 0
        self._kept_states = resumed.states if resumed else 0
        self._states = self._kept_states
        self.rows: list[HistoryRow] = []

    def __enter__(self) -> Recorder:
        with self._clock("output"), self._explained("The first files"):
            grid = self._simulation.grid()
            at_root(self._comm, lambda: self._open(grid))
            output, simulation = self._case.output, self._simulation
            if output.elements and output.fields != "none" and isinstance(simulation, OnElements):
                self._elements = simulation.element_files(self._directory, self._kept_states)
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
        """Write a state to the history and, if asked for, to the fields.

        Raises
        ------
        ResultsError
            If it cannot be written.
        """
        with self._clock("output"), self._explained(f"The state at load factor {step.load:.6g}"):
            observation = self._simulation.observe(step)
            wanted = self._case.output.fields
            marked = step.is_stop or step.critical is not None
            keep = wanted == "all" or (wanted == "stops" and marked)
            mode = self._mode(step) if keep else None
            rows = self._kept_rows + len(self.rows)
            before = Saved(step.checkpoint, rows, self._states, tuple(self._critical))

            def write() -> None:
                assert observation is not None
                assert self._history is not None
                row = self._with_eigenvalue(observation.row, step)
                self.rows.append(row)
                self._history.write(row)
                if self._fields is not None and keep:
                    fields = observation.fields if mode is None else observation.fields | mode
                    self._fields.write(step.load, fields, observation.cell_fields)
                    self._states += 1
                self._progress.accepted(row, self._clock.total)
                self._note_critical(step)

            at_root(self._comm, write)
            if self._elements is not None and keep:
                self._elements.write(step.load)
            if step.critical is None:  # there the tangent is singular, and leads nowhere
                # Last: if the run dies before this, it is taken up one state earlier.
                checkpoint.save(
                    self._directory, self._comm, self._fingerprint, self._unknowns, before
                )

    def rejected(self, load: float, step: float, reason: str) -> None:
        """Count and show a step that was cut back."""
        self._cutbacks += 1
        self._progress.rejected(load, step, reason)

    def finish(self, status: str) -> None:
        """Draw the figures, write the summary and say how accurate the end of the path is."""
        with self._explained("The summary"):
            at_root(self._comm, lambda: self._finish(status))

    @contextmanager
    def _explained(self, what: str) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise ResultsError(
                f"{what} could not be written to {self._directory}: {error.strerror or error}. "
                "What was written before is kept. Make room there, and go on with --resume."
            ) from error

    def _mode(self, step: Step) -> dict[str, Array] | None:
        """The critical mode, or the lowest if it is known, with the largest displacement of one."""
        found = step.linearisation.lowest if step.critical is None else step.critical.mode
        if found is None:
            return None
        mode = self._simulation.displacement(found.shape, step.load)
        return None if mode is None else {"mode": mode / np.hypot(*mode.T).max()}

    def _with_eigenvalue(self, row: HistoryRow, step: Step) -> HistoryRow:
        if not self._case.output.eigenvalues:
            return row
        lowest = step.linearisation.lowest
        value = np.nan if lowest is None else lowest.eigenvalue
        return replace(row, extra={**row.extra, EIGENVALUE: value})

    def _note_critical(self, step: Step) -> None:
        if step.critical is None:
            return
        kind, modes = step.critical.kind, step.critical.modes
        self._critical.append(
            {"step": step.number, "load": step.load, "kind": kind, "modes": modes}
        )
        several = f", {modes} modes at once" if modes > 1 else ""
        self._progress.note(f"critical load {step.load:.7f}: {kind}{several}")

    def _open(self, grid: FieldGrid | None) -> None:
        try:
            self._directory.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise CaseError(
                f"--output: {self._directory} cannot be made: {error.strerror}; give another"
            ) from None
        remove_leftovers(
            self._directory,
            kept_rows=self._kept_rows,
            kept_states=self._kept_states,
            elements=self._case.output.elements,
            adapted=self._accuracy is not None,
        )
        replace_text(self._directory / "case.resolved.toml", case_to_toml(self._case))
        self._history = HistoryWriter(
            self._directory / "history.csv",
            len(self._case.output.probes),
            self._kept_rows,
            (*self._simulation.extra_columns, *([EIGENVALUE] * self._case.output.eigenvalues)),
        )
        if self._case.output.fields != "none" and grid is not None:
            self._fields = FieldsWriter(self._directory, grid, self._kept_states)

    def _finish(self, status: str) -> None:
        if self._accuracy is not None and self.rows:
            last = self.rows[-1]
            end = (last.force, last.energy) if status == "done" else None
            self._accuracy = self._accuracy.at_end(end)
            self._progress.note(self._accuracy.sentence())
        # Before the figures too: a run is not lost because drawing it failed.
        self._write_summary(status)
        if self._case.output.figures:
            with self._clock("output"):
                from .plot import plot

                plot(self._directory)
            self._write_summary(status)
        if self._case.output.report:
            self._write_report()

    def _write_report(self) -> None:
        try:
            write_report(self._directory)
        except Exception as error:  # whatever it is, the results are complete without it
            self._progress.note(f"Warning: {REPORT_FILE} could not be written: {error}")

    def _write_summary(self, status: str) -> None:
        write_summary(
            self._directory / "summary.json",
            status=status,
            last=self.rows[-1] if self.rows else None,
            dofs=self._simulation.dofs,
            cells=self._simulation.cells,
            seconds={**self._clock.seconds, "total": self._clock.total},
            versions=package_versions(),
            message=self._accuracy.sentence() if self._accuracy else "",
            accuracy=self._accuracy.as_dict() if self._accuracy else None,
            critical_points=self._critical,
            cutbacks=self._cutbacks,
        )
