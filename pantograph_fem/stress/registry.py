"""All hard cases, in the order of the table."""

from __future__ import annotations

from .hard_case import HardCase
from .lines import LINES
from .loadings import LOADINGS
from .materials import MATERIALS
from .paper import PAPER
from .solving import SOLVING

HARD_CASES: tuple[HardCase, ...] = (*PAPER, *LOADINGS, *MATERIALS, *SOLVING, *LINES)
