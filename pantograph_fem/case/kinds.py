"""The kinds of cases."""

from __future__ import annotations

from .beam_case import BeamCase, ChainCase
from .lattice_case import LatticeCase
from .model import Case
from .sheet_case import SheetCase

#: The model of each kind of case. Another kind has its own sections and adds its model here.
KINDS: dict[str, type[Case]] = {
    "sheet": SheetCase,
    "lattice": LatticeCase,
    "beam": BeamCase,
    "chain": ChainCase,
}
