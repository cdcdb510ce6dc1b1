"""Sheets coarse enough to be run by the dozen."""

from __future__ import annotations

#: Some 700 elements of degree 3 by the hinge scheme: within 1 % of the limit in case a.
COARSE = (
    'discretisation.scheme="hinge"',
    "mesh.size=0.0124",
    "mesh.corner_size=0.0005",
)
#: Degree 2 on a mesh that is coarser still, for series whose members are compared.
COARSEST = (
    'discretisation.scheme="hinge"',
    "discretisation.degree=2",
    "mesh.size=0.0124",
    "mesh.corner_size=0.001",
)
#: The paper's scheme.
MICROMORPHIC = (
    "discretisation.degree=2",
    "mesh.size=0.0124",
    "mesh.corner_size=0.001",
)

BIAS, SHEAR, ROTATION = "a_bias_extension", "b_shear", "c_rotation_45"
COMPRESSION_2, COMPRESSION_3 = "d_compression_2", "d_compression_3"


def pulled(way: float) -> str:
    """Override of case a: the translation of the top along the sheet, m."""
    return f"grips.top.translation=[0.0,{way!r}]"
