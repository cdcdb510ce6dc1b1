"""Constants of the material over many decades."""

from __future__ import annotations

from .expectation import NoLessThan, SameAs, Says, Without
from .hard_case import HardCase
from .sheets import BIAS, COARSE, COARSEST, pulled

#: Before locking, 0.0563 m.
_WAY = pulled(0.05)
_K_P, _EXPONENT, _AREA = 1.59e2, 1.36, 0.068 * 0.204


def _exponent(value: float) -> HardCase:
    return HardCase(
        f"gamma_{value:g}",
        f"γ = {value:g}",
        BIAS,
        (*COARSEST, f"material.shear_exponent={value!r}"),
        quick=value == 1.05,
    )


def _smoothing(decade: int) -> HardCase:
    """δ = 10^-decade, compared with 1e-7.

    The energy density falls by less than ½ K_p δ^γ everywhere, and so does the least energy.
    """
    delta = 10.0**-decade
    bound = 0.5 * _K_P * delta**_EXPONENT * _AREA
    expect = (
        SameAs("delta_1e-7", "energy", relative=1e-7, absolute=bound),
        NoLessThan(f"delta_1e-{decade - 1}"),
    )
    return HardCase(
        f"delta_1e-{decade}",
        f"δ = 1e-{decade} rad",
        BIAS,
        (*COARSEST, f"discretisation.shear_regularisation={delta!r}"),
        expect[decade == 7 : None if decade > 2 else 1],
    )


def _bending(decade: int) -> HardCase:
    """K_e/K_b over ten decades, with K_e as it is; energy grows with K_b."""
    K_b = 1.34e5 / 10.0**decade
    return HardCase(
        f"ratio_1e{decade}",
        f"K_e/K_b = 1e{decade} m⁻²",
        BIAS,
        (*COARSEST, _WAY, f"material.bending={K_b!r}"),
        () if decade == 13 else (NoLessThan(f"ratio_1e{decade + 2}"),),
        quick=decade == 13,
    )


def _stretch(decade: int) -> tuple[HardCase, ...]:
    """K_e up to where fibres are inextensible, by several degrees on one mesh.

    A mesh that locks has more energy than one that does not. From degree 4 on none is seen; below,
    all agree at the stiffness of the paper, and energies come from above where fibres are stiffer.
    """
    name, K_e = f"stretch_1e{decade}", 10.0**decade
    stiff = (*COARSE, _WAY, f"material.stretch={K_e!r}")
    same = SameAs(f"{name}_degree_6", "energy", relative=0.05)
    low = same if decade <= 5 else NoLessThan(f"{name}_degree_6", slack=1e-6)
    stiffer = (NoLessThan(f"stretch_1e{decade - 3}", slack=1e-6),) if decade > 5 else ()
    hard = f"K_e = 1e{decade} N/m"
    locks = "" if decade <= 5 else ", locks"
    return (
        HardCase(f"{name}_degree_6", f"{hard}, degree 6", BIAS, (*stiff, _degree(6))),
        HardCase(name, f"{hard}, degree 5", BIAS, (*stiff, _degree(5)), (same, *stiffer)),
        HardCase(f"{name}_degree_3", f"{hard}, degree 3{locks}", BIAS, stiff, (low,)),
        # Where it locks, the sheet of degree 2 folds, and the user is told what to do about it.
        HardCase(
            f"{name}_degree_2",
            f"{hard}, degree 2{locks}",
            BIAS,
            (*stiff, _degree(2)),
            (low, Says("discretisation.degree = 5")),
            may_stop=decade > 5,
        ),
        HardCase(
            f"{name}_micromorphic",
            f"{hard}, micromorphic scheme, degree 3{locks}",
            BIAS,
            stiff[1:],
            (low,),
        ),
    )


def _degree(degree: int) -> str:
    return f"discretisation.degree={degree}"


MATERIALS = (
    *(_exponent(value) for value in (1.05, 1.1, 1.2, 2.0)),
    *(_smoothing(decade) for decade in range(2, 8)),
    *(_bending(decade) for decade in range(3, 14, 2)),
    HardCase(
        "without_bending",
        "K_b = 0: first gradient",
        BIAS,
        ("discretisation.degree=2", *COARSEST[2:], _WAY, "material.bending=0.0"),
        (Without("unstable states"),),
        may_stop=True,
    ),
    HardCase(
        "without_bending_fine",
        "K_b = 0, finer mesh",
        BIAS,
        (
            "discretisation.degree=2",
            "mesh.size=0.0062",
            "mesh.corner_size=0.0005",
            _WAY,
            "material.bending=0.0",
        ),
        (Without("unstable states"),),
        may_stop=True,
    ),
    *(hard for decade in (5, 8) for hard in _stretch(decade)),
    HardCase(
        "stretch_1e11",
        "K_e = 1e11 N/m, degree 6",
        BIAS,
        (*COARSE, _WAY, "material.stretch=1e11", _degree(6)),
        # dE/dK_e = E_s/K_e, of a stretch energy E_s that falls from 0.02 J at 1e8 N/m: at most
        # 0.02 J ln(1e3) more than there, which is 15 %.
        (
            SameAs("stretch_1e8_degree_6", "energy", relative=0.15),
            NoLessThan("stretch_1e8_degree_6", slack=1e-6),
        ),
    ),
)
