"""Schemes: each turns an energy into fields and a functional that is stationary at equilibrium."""

from .choice import SchemeName, discretise
from .discretisation import Discretisation, Scales, integration
from .first_gradient import first_gradient
from .hinge import hinge, hinge_stiffness
from .micromorphic import micromorphic
from .stiff import StiffEnergy

__all__ = [
    "Discretisation",
    "Scales",
    "SchemeName",
    "StiffEnergy",
    "discretise",
    "first_gradient",
    "hinge",
    "hinge_stiffness",
    "integration",
    "micromorphic",
]
