"""Gmsh, used without leaving a trace in the process."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

#: Everything that shapes a mesh of triangles, so that a user's own settings do not.
_OPTIONS: dict[str, float] = {
    "General.Terminal": 0,
    "Mesh.Algorithm": 6,  # frontal-Delaunay
    "Mesh.ElementOrder": 1,
    "Mesh.RecombineAll": 0,
    "Mesh.SubdivisionAlgorithm": 0,
    "Mesh.Smoothing": 1,
    "Mesh.Optimize": 1,
    "Mesh.RandomFactor": 1e-9,
    "Mesh.RandomSeed": 1,
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.MeshSizeFactor": 1,
    "Mesh.MeshSizeMin": 0,
    "Mesh.MeshSizeMax": 1e22,
}

#: A seed that no user has, by which a gmsh that was just initialised is known.
_MARK = 795_028_841


@contextmanager
def gmsh_model() -> Iterator[ModuleType]:
    """Yield gmsh with an empty current model and the size field as the only source of sizes.

    Afterwards the model is gone, the handler of Ctrl-C is what it was, and gmsh is as it was:
    finalised, or, if the caller had initialised it, with the same options and current model.
    """
    with _interrupt_handler_kept():
        import gmsh

        ours = _initialize(gmsh)
    previous_model = "" if ours else gmsh.model.getCurrent()
    previous_options = {name: gmsh.option.getNumber(name) for name in _OPTIONS}
    try:
        for name, value in _OPTIONS.items():
            gmsh.option.setNumber(name, value)
        gmsh.model.add("pantograph_fem")
        try:
            yield gmsh
        finally:
            gmsh.model.remove()
    finally:
        if ours:
            with _interrupt_handler_kept():
                gmsh.finalize()
        else:
            for name, value in previous_options.items():
                gmsh.option.setNumber(name, value)
            gmsh.model.setCurrent(previous_model)


@contextmanager
def _interrupt_handler_kept() -> Iterator[None]:
    """Undo what importing, initialising and finalising gmsh do to the handler of Ctrl-C."""
    handler = signal.getsignal(signal.SIGINT)
    try:
        yield
    finally:
        if handler is not None:
            signal.signal(signal.SIGINT, handler)


def _initialize(gmsh: ModuleType) -> bool:
    """Initialise gmsh where it was not, and tell whether it was not."""
    if hasattr(gmsh, "isInitialized"):
        ours = not gmsh.isInitialized()
        if ours:
            gmsh.initialize(readConfigFiles=False)
        return ours
    # Before 4.9 nothing may be asked of a gmsh that is not initialised: what it does about this
    # error it reads from memory that nobody has set, and once in a hundred times it ends the
    # process without a word. Where it was initialised, it ignores what comes with a second time.
    arguments = ["pantograph_fem", "-setnumber", "Mesh.RandomSeed", str(_MARK)]
    with _stderr_off():
        gmsh.initialize(arguments, readConfigFiles=False)
    return bool(gmsh.option.getNumber("Mesh.RandomSeed") == _MARK)


@contextmanager
def _stderr_off() -> Iterator[None]:
    """Without what C libraries write to standard error."""
    saved = os.dup(2)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
