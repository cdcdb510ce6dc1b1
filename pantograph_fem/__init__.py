"""Second-gradient finite elements for pantographic sheets and the beams they are made of.

>>> import pantograph_fem as pf
>>> result = pf.run("cases/beam_arc.toml", set=["continuation.max_step=0.1"])
>>> result.history["force_y"]

Names are imported when they are first used: importing the package loads no numerics.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .api import read, run
    from .case import (
        BeamCase,
        Case,
        ChainCase,
        LatticeCase,
        SheetCase,
        case_from_dict,
        case_to_toml,
        load_case,
    )
    from .errors import CaseError, PantographError, PathError, ResultsError
    from .results.result import Result
    from .results.states import State, States

__version__ = "0.1.0"

__all__ = [
    "BeamCase",
    "Case",
    "CaseError",
    "ChainCase",
    "LatticeCase",
    "PantographError",
    "PathError",
    "Result",
    "ResultsError",
    "SheetCase",
    "State",
    "States",
    "__version__",
    "case_from_dict",
    "case_to_toml",
    "load_case",
    "read",
    "run",
]

_HOMES = {
    ".api": ("read", "run"),
    ".case": (
        "BeamCase",
        "Case",
        "ChainCase",
        "LatticeCase",
        "SheetCase",
        "case_from_dict",
        "case_to_toml",
        "load_case",
    ),
    ".errors": ("CaseError", "PantographError", "PathError", "ResultsError"),
    ".results.result": ("Result",),
    ".results.states": ("State", "States"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOME[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
