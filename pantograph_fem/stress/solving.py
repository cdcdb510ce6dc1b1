"""Meshes, units and load steps that make things hard for the solver."""

from __future__ import annotations

from .expectation import SameAs
from .hard_case import HardCase
from .meshes import shaken, slivers
from .sheets import (
    BIAS,
    COARSE,
    COMPRESSION_3,
    MICROMORPHIC,
    ROTATION,
    SHEAR,
    pulled,
)

_ONE_STEP = (
    "continuation.stops=[1.0]",
    "continuation.max_step=1.0",
    "continuation.initial_step=1.0",
)


def _one_step(letter: str, base: str) -> tuple[HardCase, HardCase]:
    """In steps and in one: the same state, as both are solved to 1e-8."""
    steps = f"{letter}_in_steps"
    same = tuple(SameAs(steps, what, relative=1e-6) for what in ("force", "energy"))
    return (
        HardCase(steps, f"case {letter}, to compare with", base, COARSE),
        HardCase(
            f"{letter}_in_one_step",
            f"case {letter} in a single load step",
            base,
            (*COARSE, *_ONE_STEP),
            same,
            balanced=False,
            quick=letter == "a",
        ),
    )


#: Case a in mm, N and N mm; its numbers, and the factors of force and energy.
_MILLIMETRES = (
    *("sheet.width=68.0", "sheet.height=204.0"),
    *("material.stretch=134.0", "material.bending=19.2", "material.shear=0.159"),
    "grips.top.translation=[0.0,56.7]",
    *("mesh.size=12.4", "mesh.corner_size=1.0"),
)


def _units(name: str, hard: str, discretisation: tuple[str, ...]) -> tuple[HardCase, HardCase]:
    same = (
        SameAs(f"{name}_in_m", "force", relative=1e-8),
        SameAs(f"{name}_in_m", "energy", relative=1e-8, factor=1e3),
        SameAs(f"{name}_in_m", "lowest_eigenvalue", relative=1e-6),
    )
    sizes = ("mesh.size=0.0124", "mesh.corner_size=0.001")
    return (
        HardCase(f"{name}_in_m", f"{hard}, to compare with", BIAS, (*discretisation, *sizes)),
        HardCase(
            f"{name}_in_mm",
            f"{hard}, in mm and N",
            BIAS,
            (*discretisation, *_MILLIMETRES),
            same,
            quick=name == "units_hinge",
        ),
    )


_HINGE = 'discretisation.scheme="hinge"'
_SAME_SHEET = (
    SameAs("mesh_plain", "force", relative=0.05),
    SameAs("mesh_plain", "energy", relative=0.05),
)

SOLVING = (
    *_one_step("a", BIAS),
    *_one_step("b", SHEAR),
    *_one_step("c", ROTATION),
    *_one_step("d", COMPRESSION_3),
    *_units("units_hinge", "hinge scheme", (_HINGE, "discretisation.degree=2")),
    *_units("units_micromorphic", "micromorphic scheme", ("discretisation.degree=2",)),
    HardCase("mesh_plain", "a plain mesh, to compare with", BIAS, (*COARSE, pulled(0.04))),
    HardCase(
        "mesh_slivers",
        "bands of slivers, 11 : 1",
        BIAS,
        (_HINGE, pulled(0.04)),
        _SAME_SHEET,
        mesh=slivers,
    ),
    HardCase(
        "mesh_slivers_micromorphic",
        "the same, micromorphic scheme",
        BIAS,
        (pulled(0.04),),
        _SAME_SHEET,
        mesh=slivers,
    ),
    HardCase(
        "mesh_shaken",
        "points moved at random",
        BIAS,
        (_HINGE, pulled(0.04)),
        _SAME_SHEET,
        mesh=shaken,
        quick=True,
    ),
    HardCase(
        "mesh_with_hole",
        "imported, with a hole",
        BIAS,
        (
            _HINGE,
            "discretisation.degree=2",
            pulled(0.04),
            'mesh.file="../meshes/specimen_with_hole.msh"',
        ),
    ),
    HardCase(
        "micromorphic_turned",
        "W/2 and 60 degrees, micromorphic scheme",
        ROTATION,
        (*MICROMORPHIC, "grips.top.rotation=60.0"),
        may_stop=True,
    ),
    HardCase(
        "huge",
        "a million unknowns, micromorphic scheme",
        BIAS,
        ("mesh.size=0.0009", "continuation.stops=[1.0]"),
        (SameAs("paper_a", "force", relative=1e-3),),
        huge=True,
        limit=6 * 3600.0,
    ),
)
