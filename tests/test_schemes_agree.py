"""Two schemes that approximate in different ways find the same sheets in cases a to d."""

import math
from pathlib import Path

import pytest

from pantograph_fem.case import load_case
from pantograph_fem.running import run

CASES = Path(__file__).parents[1] / "cases"


def found(case, folder, scheme, size):
    """Force (magnitude) and energy at full load, on a mesh of that size inside."""
    overrides = (
        f"discretisation.scheme={scheme}",
        f"mesh.size={size}",
        f"mesh.corner_size={size / 20}",
        "continuation.stops=[1.0]",
        "output.figures=false",
        "output.fields=none",
    )
    last = run(load_case(CASES / f"{case}.toml", overrides), folder, quiet=True).rows[-1]
    assert last.stable
    return math.hypot(*last.force), last.energy


@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "force", "energy"),
    [
        # largest relative differences on the finer of two meshes
        ("a_bias_extension", 2e-3, 5e-4),
        ("b_shear", 2e-3, 5e-4),
        ("c_rotation_45", 2e-3, 5e-4),
        ("d_compression_1", 2e-3, 5e-4),
    ],
)
def test_hinge_and_micromorphic_agree_the_better_the_finer_the_mesh(case, force, energy, tmp_path):
    differences = []
    for size in (0.017, 0.0085):
        hinge, micromorphic = (
            found(case, tmp_path / f"{scheme}_{size}", scheme, size)
            for scheme in ("hinge", "micromorphic")
        )
        differences.append([abs(a / b - 1.0) for a, b in zip(hinge, micromorphic, strict=True)])
    coarse, fine = differences
    assert fine[0] < force, differences
    assert fine[1] < energy, differences
    assert fine[0] < coarse[0] / 1.5, differences
    assert fine[1] < coarse[1] / 1.5, differences
