"""Schemes: each turns an energy into fields and a functional that is stationary at equilibrium."""

from .discretisation import Discretisation, Scales
from .first_gradient import first_gradient
from .micromorphic import micromorphic

__all__ = ["Discretisation", "Scales", "first_gradient", "micromorphic"]
