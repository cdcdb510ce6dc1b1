"""Beams, chains and a lattice through their critical loads, and rolled up."""

from __future__ import annotations

import math

from .critical_loads import CriticalLoad, CriticalLoads
from .expectation import SameAs, Value, Without
from .hard_case import HardCase
from .sheets import pulled

_K_E, _K_B = 4.05e8, 7.59e5
_BRANCH = 'continuation.on_instability="branch"'
_BY_ARC = 'continuation.method="arc_length"'


def _critical_force(mu: float, K_e: float = _K_E) -> float:
    """N_cr = (K_e/2)(1 - sqrt(1 - 4 K_b k²/K_e)), k = π/(μL), of the extensible column, N."""
    ratio = 4 * _K_B * (math.pi / mu) ** 2 / K_e
    # without the difference of two numbers that are nearly equal
    return 0.5 * K_e * ratio / (1 + math.sqrt(1 - ratio))


def _critical_loads(number: int, times: float, K_e: float) -> tuple[float, ...]:
    """Load fractions at which a cantilever buckles that is pressed by so many times its load."""
    modes = range(1, number + 1)
    forces = [_critical_force(2.0 / (2 * n - 1), K_e) for n in modes]  # k_n = (n - ½) π/L
    return tuple(force / (times * forces[0]) for force in forces)


def _pressed(times: float, mu: float, K_e: float = _K_E) -> str:
    return f"ends.right.force=[{-times * _critical_force(mu, K_e)!r},0.0]"


_PINNED = ('ends.left.support="pinned"', 'ends.right.support="roller"')


def _column(name: str, hard: str, mu: float, *overrides: str, quick: bool = False) -> HardCase:
    """Pressed by 1.5 times its critical load, which is found at load 2/3."""
    source = "closed form of the extensible column"
    return HardCase(
        name,
        hard,
        "beam_euler",
        (_pressed(1.5, mu), *overrides),
        (CriticalLoad(2 / 3, 1e-5, "bifurcation", source),),
        quick=quick,
    )


def _elastica(times: float, angle: float, x: float, y: float) -> HardCase:
    """Tip angle and place of the inextensible cantilever beyond buckling, to three digits.

    With fibres a hundred times as stiff, N/K_e is some 1e-4.
    """
    source, K_e = "Timoshenko and Gere, table 2-4", 1e2 * _K_E
    return HardCase(
        f"elastica_{angle:.0f}",
        f"buckled until the tip points to {angle:.0f} degrees, K_e × 100",
        "beam_euler",
        (_pressed(times, 2.0, K_e), f"material.stretch={K_e!r}", _BRANCH),
        (
            Value("tip_angle", math.radians(angle), 0.0, 2e-2, source, size=True),
            Value("tip_ux", x - 1.0, 0.0, 5e-3, source),
            Value("tip_uy", y, 0.0, 5e-3, source, size=True),
            Without("unstable states"),
        ),
    )


def _rolled(turns: int, *overrides: str) -> HardCase:
    """ρ = 1 and φ = M S/K_b: a circle, run through so many times."""
    energy = 0.5 * _K_B * (2 * math.pi * turns) ** 2
    source = "arc of a circle"
    return HardCase(
        f"rolled_{turns}",
        f"end moment rolls it up {turns} times",
        "beam_moment",
        (f"ends.right.moment={2 * math.pi * _K_B * turns!r}", *overrides),
        (
            Value("tip_angle", 2 * math.pi * turns, 1e-6, source=source),
            Value("tip_ux", -1.0, 1e-6, source=source),
            Value("energy", energy, 1e-6, source=source),
        ),
    )


#: A rod whose clamp is turned while its pinned tip is pushed in: it snaps at a limit point.
_TURNING = (
    "ends.left.rotation=360.0",
    "ends.right.rotation=0.0",
    "ends.right.pivot=[1.0,0.0]",
    "ends.right.translation=[-0.5,0.0]",
    "continuation.stops=[1.0]",
)

LINES = (
    _column("column", "cantilever, straight through its buckling load", 2.0),
    _column("column_arc", "the same by arc length", 2.0, _BY_ARC),
    _column("column_branch", "the same, onto its branch", 2.0, _BRANCH, quick=True),
    _column("column_arc_branch", "the same, branch by arc length", 2.0, _BRANCH, _BY_ARC),
    _column("column_pinned_branch", "pinned column, onto its branch", 1.0, *_PINNED, _BRANCH),
    _column(
        "column_hinge",
        "cantilever, hinge scheme",
        2.0,
        'discretisation.scheme="hinge"',
        _BRANCH,
    ),
    HardCase(
        "column_to_four_modes",
        "straight to 60 times its load: four modes are lost",
        "beam_euler",
        (_pressed(60.0, 2.0, 100 * _K_E), f"material.stretch={100 * _K_E!r}"),
        (CriticalLoads(_critical_loads(4, 60.0, 100 * _K_E), 1e-5, "bifurcation", "closed form"),),
    ),
    _elastica(1.518, 100.0, 0.349, 0.792),
    _elastica(9.116, 176.0, -0.577, 0.421),
    HardCase(
        "column_stiff_branch",
        "onto its branch, K_e L²/K_b = 5e6",
        "beam_euler",
        (_pressed(1.5, 2.0, 1e4 * _K_E), f"material.stretch={1e4 * _K_E!r}", _BRANCH),
        (CriticalLoad(2 / 3, 1e-5, "bifurcation", "closed form"), Without("unstable states")),
    ),
    HardCase(
        "column_stiff_hinge_branch",
        "K_e L²/K_b = 5e8, hinge scheme",
        "beam_euler",
        (
            _pressed(1.5, 2.0, 1e6 * _K_E),
            f"material.stretch={1e6 * _K_E!r}",
            'discretisation.scheme="hinge"',
            _BRANCH,
        ),
        (CriticalLoad(2 / 3, 1e-5, "bifurcation", "closed form"), Without("unstable states")),
    ),
    HardCase(
        "column_stiff_hinge_between",
        "the same, critical load at no stop: eigenvalues near round-off",
        "beam_euler",
        (
            _pressed(1.518, 2.0, 1e6 * _K_E),
            f"material.stretch={1e6 * _K_E!r}",
            'discretisation.scheme="hinge"',
            _BRANCH,
        ),
        (Without("unstable states"),),
        may_stop=True,
    ),
    _rolled(3),
    _rolled(10, "continuation.max_step=0.02", "mesh.size=0.0078125"),
    HardCase(
        "turning_clamp_arc",
        "snap of a rod with a turning clamp, by arc length",
        "beam_arc",
        (*_TURNING, _BY_ARC),
        (CriticalLoad(0.9708982, 1e-6, "limit point", "exact beam, test_stability_cases"),),
        may_stop=True,
        quick=True,
    ),
    HardCase(
        "turning_clamp",
        "the same by load: no way past the limit point",
        "beam_arc",
        _TURNING,
        may_stop=True,
    ),
    HardCase(
        "beam_arc_in_one_step",
        "Fig. 5 in a single step",
        "beam_arc",
        (
            "continuation.stops=[1.0]",
            "continuation.max_step=1.0",
            "continuation.initial_step=1.0",
        ),
        (SameAs("beam_arc", "energy", relative=1e-6), SameAs("beam_arc", "force", relative=1e-6)),
        balanced=False,
    ),
    HardCase("beam_arc", "Fig. 5, to compare with", "beam_arc"),
    HardCase("chain_arc", "a chain on the same arc", "chain_arc"),
    HardCase(
        "lattice_beyond_locking",
        "lattice pulled by 0.075 m",
        "lattice_bias_extension",
        ("lattice.spacing=0.0096", pulled(0.075), "continuation.max_step=0.05"),
    ),
    HardCase(
        "lattice_compressed",
        "lattice compressed by 40 mm",
        "lattice_bias_extension",
        ("lattice.spacing=0.0096", pulled(-0.04), "continuation.stops=[1.0]"),
        may_stop=True,
    ),
    HardCase(
        "lattice_compressed_arc",
        "the same by arc length, onto a branch",
        "lattice_bias_extension",
        ("lattice.spacing=0.0096", pulled(-0.04), "continuation.stops=[1.0]", _BY_ARC, _BRANCH),
        may_stop=True,
    ),
)
