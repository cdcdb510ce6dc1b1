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


@contextmanager
def gmsh_model() -> Iterator[ModuleType]:
    """Yield gmsh with an empty current model and the size field as the only source of sizes.

    Afterwards the model is gone, the handler of Ctrl-C is what it was, and gmsh is as it was:
    finalised, or, if the caller had initialised it, with the same options and current model.
    """
    with _interrupt_handler_kept():
        import gmsh

        ours = not _is_initialized(gmsh)
        if ours:
            gmsh.initialize(readConfigFiles=False)
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


def _is_initialized(gmsh: ModuleType) -> bool:
    if hasattr(gmsh, "isInitialized"):
        return bool(gmsh.isInitialized())
    # Before 4.9 one can only ask for something and see whether it comes: without initialisation
    # gmsh answers with nothing or an exception, and complains on the C library's standard error.
    saved = os.dup(2)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 2)
    try:
        return bool(gmsh.option.getString("General.Version"))
    except Exception:
        return False
    finally:
        os.dup2(saved, 2)
        os.close(saved)
