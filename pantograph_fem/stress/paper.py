"""The paper's cases as they are shipped, by both schemes on their default mesh."""

from __future__ import annotations

from .expectation import SameAs, Without
from .hard_case import HardCase

_BASES = ("a_bias_extension", "b_shear", "c_rotation_45", "d_compression_3")


def _both_schemes(base: str) -> tuple[HardCase, HardCase]:
    letter = base[0]
    plain = (Without("cut-backs"), Without("unstable states"))
    # The difference of the schemes on this mesh: docs/accuracy.md.
    same = tuple(SameAs(f"paper_{letter}", what, relative=5e-3) for what in ("force", "energy"))
    return (
        HardCase(f"paper_{letter}", f"case {letter} as it is", base, expect=plain),
        HardCase(
            f"paper_{letter}_hinge",
            f"case {letter}, hinge scheme",
            base,
            ('discretisation.scheme="hinge"',),
            (*plain, *same),
        ),
    )


PAPER = tuple(hard for base in _BASES for hard in _both_schemes(base))
