"""Runs side by side, each in a process of its own with one thread; all can be ended at once."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import threading
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any

from ..case import Case
from ..study.process import Ended, command_of

#: Signals that end a sweep as Ctrl-C does: from a scheduler, or from a terminal that is closed.
_ENDING = (signal.SIGTERM, signal.SIGHUP)


class Processes:
    """Runs cases, from any number of threads; a :data:`pantograph_fem.study.process.Runner`.

    Use as a context manager: no process outlives it, and what would end the program without a
    word raises KeyboardInterrupt in the main thread.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pids: set[int] = set()
        self._ended = False
        self._handlers: dict[int, Any] = {}

    def __enter__(self) -> Processes:
        if threading.current_thread() is threading.main_thread():
            self._handlers = {number: signal.signal(number, _interrupt) for number in _ENDING}
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.end()
        for number, handler in self._handlers.items():
            signal.signal(number, handler)

    def end(self) -> None:
        """End all processes; none is started any more."""
        with self._lock:
            self._ended = True
            for pid in self._pids:
                os.kill(pid, signal.SIGKILL)

    def __call__(self, case: Case, directory: Path) -> Ended:
        """Run ``pantograph run`` on a case; it is left as ``case.toml`` beside the results.

        Raises
        ------
        CaseError
            If the folder cannot be written to.
        """
        command = command_of(case, directory)
        # each core has a process: threads would only compete
        env = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        with tempfile.TemporaryFile() as errors:
            with self._lock:
                if self._ended:
                    return Ended(-signal.SIGKILL, 0.0, "not started")
                process = subprocess.Popen(
                    command,
                    env=env,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=errors,
                )
                self._pids.add(process.pid)
            try:
                os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
            except BaseException:
                os.kill(process.pid, signal.SIGKILL)
                raise
            finally:
                # Reaped under the lock: a number in the set is of no other process.
                with self._lock:
                    self._pids.discard(process.pid)
                    _, status, usage = os.wait4(process.pid, 0)
                process.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            message = errors.read().decode(errors="replace").strip()
        return Ended(process.returncode, usage.ru_utime + usage.ru_stime, message)


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise KeyboardInterrupt
