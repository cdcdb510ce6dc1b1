"""Case files: what is simulated, checked before anything is computed.

Nothing here imports numpy or dolfinx, so that a case is checked in a fraction of a second.
"""

from .beam_case import BeamCase, ChainCase
from .lattice_case import LatticeCase
from .loading import case_from_dict, case_to_toml, load_case
from .model import Case
from .sheet_case import SheetCase

__all__ = [
    "BeamCase",
    "Case",
    "ChainCase",
    "LatticeCase",
    "SheetCase",
    "case_from_dict",
    "case_to_toml",
    "load_case",
]
