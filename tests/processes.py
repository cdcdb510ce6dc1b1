"""Tests on several processes, which all run the same tests and pass or fail together.

    mpirun -n 2 .venv/bin/python -m pytest -m core

The first process reports. A test that fails on any process fails on all, so that none goes on
alone; where processes have lost each other the run is aborted, with what is known on stderr. On
one process all of this does nothing.
"""

import faulthandler
import os
import sys
import time

import pytest
from hypothesis import settings

from mpi4py import MPI

#: Apart from what the tests send.
WORLD = MPI.COMM_WORLD.Dup()
SEVERAL = WORLD.size > 1
#: Seconds for one test, with forms to compile; then every process tells where it is.
LIMIT = 240
#: Seconds that a process whose test has failed waits for the others to come out of it.
PATIENCE = 60


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config):
    if not SEVERAL:
        return
    # The tests redirect it.
    config.stash[_STDERR] = os.fdopen(os.dup(2), "w", buffering=1)
    # Every process has to draw the same examples.
    settings.register_profile("same", settings.default, derandomize=True, database=None)
    settings.load_profile("same")
    if WORLD.rank > 0:  # before the terminal plugin looks where to write
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115


_STDERR = pytest.StashKey()


def pytest_collection_modifyitems(config, items):
    """Leave out tests that are for one process, whatever was asked for."""
    if SEVERAL:
        shared = [item for item in items if _for_several(item)]
        config.hook.pytest_deselected(items=[item for item in items if item not in shared])
        items[:] = shared


def _for_several(item):
    """Not those that look at what is printed, which one process alone prints, nor the long ones."""
    marks = {mark.name for mark in item.iter_markers()}
    reads = {"capsys", "capfd"}.intersection(item.fixturenames)
    return "core" in marks and "slow" not in marks and not reads


def pytest_collection_finish(session):
    if not SEVERAL:
        return
    found = WORLD.allgather(([item.nodeid for item in session.items], session.testsfailed))
    if any(one != found[0] for one in found):
        raise pytest.UsageError("the processes do not have the same tests")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    if not SEVERAL:
        return (yield)
    # mpirun ends the other processes when this one ends like that.
    faulthandler.dump_traceback_later(LIMIT, exit=True, file=item.config.stash[_STDERR])
    try:
        return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    report = yield
    if SEVERAL:
        _meet(report, item.config.stash[_STDERR])
        _agree(report)
    return report


def _meet(report, stderr):
    """Wait for the other processes; abort all if this one has failed and they do not come."""
    arrived = WORLD.Ibarrier()
    start = time.monotonic()
    while not arrived.Test():
        time.sleep(1e-3)
        if report.failed and time.monotonic() - start > PATIENCE:
            lines = f"{report.nodeid}: failed on process {WORLD.rank} alone, others are in it yet"
            stderr.write(f"{lines}\n{report.longreprtext}\n")
            stderr.flush()
            WORLD.Abort(1)


def _agree(report):
    """Have the outcome of all processes: failed if one has failed, or if they differ."""
    outcomes = WORLD.allgather((report.outcome, report.longreprtext))
    names = [name for name, _ in outcomes]
    if len(set(names)) == 1 and not report.failed:
        return
    if not report.failed:
        report.outcome = "failed"
        report.longrepr = "on the processes: " + ", ".join(names)
    for rank, (name, text) in enumerate(outcomes):
        if name == "failed" and rank != WORLD.rank:
            report.sections.append((f"process {rank}", text))
