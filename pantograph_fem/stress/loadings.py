"""The paper's loadings taken farther, the other reading of case d, and compression."""

from __future__ import annotations

import math

from .critical_loads import CriticalLoad
from .expectation import Without
from .hard_case import HardCase
from .sheets import (
    BIAS,
    COARSE,
    COARSEST,
    COMPRESSION_2,
    COMPRESSION_3,
    MICROMORPHIC,
    ROTATION,
    SHEAR,
    pulled,
)

_BY_ARC = 'continuation.method="arc_length"'
_BRANCH = 'continuation.on_instability="branch"'
_HEIGHT = 0.204
#: Where the force rises by orders of magnitude, for energy and work to be compared.
_SHORT = "continuation.max_step=0.05"


def _farther(name: str, hard: str, base: str, *overrides: str, quick: bool = False) -> HardCase:
    return HardCase(name, hard, base, (*COARSE, *overrides), quick=quick, may_stop=True)


def _turned(degrees: float) -> tuple[str, str]:
    return f"grips.bottom.rotation={-degrees!r}", f"grips.top.rotation={degrees!r}"


def _upright(scheme: str, *overrides: str, quick: bool = False) -> HardCase:
    """Upright fibres, pressed by 1.3 times the way at which they sway: N λ = K_b k² + K_p."""
    resistance = 10.0 * (math.pi / _HEIGHT) ** 2 + 1.59e2
    critical = 0.5 * _HEIGHT * (1 - math.sqrt(1 - 4 * resistance / 1.34e5))
    coarse = COARSEST if scheme == "hinge" else MICROMORPHIC
    what = "branch" if _BRANCH in overrides else "path followed"
    arc = ", by arc length" if _BY_ARC in overrides else ""
    return HardCase(
        f"upright_{scheme}{'_branch' * (_BRANCH in overrides)}{'_arc' * bool(arc)}",
        f"upright fibres pressed until they sway, {what}{arc}, {scheme} scheme",
        BIAS,
        (
            *coarse,
            *("sheet.fibre_angle=0.0", "material.bending=10.0", "material.shear_exponent=2.0"),
            *(pulled(-1.3 * critical), "continuation.stops=[1.0]"),
            *overrides,
        ),
        (CriticalLoad(1 / 1.3, 2e-2, "bifurcation", "N λ = K_b k² + K_p"),),
        quick=quick,
    )


LOADINGS = (
    _farther("a_beyond_locking", "0.075 m, fibres stretch much", BIAS, pulled(0.075), _SHORT),
    HardCase(
        "a_beyond_locking_micromorphic",
        "the same, micromorphic scheme",
        BIAS,
        (*MICROMORPHIC, pulled(0.075), _SHORT),
        may_stop=True,
    ),
    _farther("b_farther", "shear to 5/2 W", SHEAR, "grips.top.translation=[-0.17,0.0]", _SHORT),
    _farther("c_to_90", "W/2 and 90 degrees", ROTATION, "grips.top.rotation=90.0"),
    HardCase(
        "c_to_90_finer",
        "the same, finer mesh",
        ROTATION,
        (*COARSE[:1], "mesh.size=0.0062", "mesh.corner_size=0.0003", "grips.top.rotation=90.0"),
        may_stop=True,
    ),
    _farther(
        "d_farther",
        "75 degrees and 2 W",
        COMPRESSION_3,
        *_turned(75.0),
        "grips.top.translation=[0.0,-0.136]",
    ),
    _farther(
        "d_literal_2",
        "case d read literally, extension by W",
        COMPRESSION_2,
        "grips.top.translation=[0.0,0.068]",
        _SHORT,
    ),
    _farther(
        "d_literal_3",
        "case d read literally, 60 degrees, 3/2 W",
        COMPRESSION_3,
        "grips.top.translation=[0.0,0.102]",
    ),
    HardCase(
        "compressed",
        "compression along the sheet by 0.1 m, half of it",
        BIAS,
        (*COARSE, pulled(-0.1), "continuation.stops=[1.0]"),
        (Without("unstable states"),),
    ),
    HardCase(
        "compressed_until_folded",
        "by 0.15 m: fibres fold onto each other",
        BIAS,
        (*COARSE, pulled(-0.15), "continuation.stops=[1.0]"),
        may_stop=True,
    ),
    HardCase(
        "compressed_soft",
        "by 0.1 m, K_b / 100",
        BIAS,
        (*COARSEST, pulled(-0.1), "continuation.stops=[1.0]", "material.bending=1.92e-4"),
        may_stop=True,
    ),
    _upright("hinge"),
    _upright("hinge", _BRANCH, quick=True),
    _upright("hinge", _BY_ARC),
    _upright("hinge", _BRANCH, _BY_ARC),
    _upright("micromorphic"),
    _upright("micromorphic", _BRANCH),
)
