r"""Energies that are quadratic in strains, and tangents that extrapolate their stresses.

A part of the functional that is a quadratic form of strains q(u), which themselves are nonlinear,

.. math:: \int \tfrac12 C_{ij}\,q_i q_j, \qquad \sigma_i = C_{ij} q_j,

has the tangent :math:`\int C_{ij}\,Dq_i Dq_j + \sigma_i D^2 q_i`. Where C is large, a step that is
good to first order leaves strains of second order whose stresses are wild. They spoil the
geometric stiffness, the second term, and Newton's method crawls: the more, the finer the mesh.

So the stresses of the second term are those of the state u₀ before, extrapolated by the linear
step that was taken from there,

.. math:: \hat\sigma_i = C_{ij}\,(q_j(u_0) + Dq_j(u_0)[\delta u]),

as if stresses were unknowns of their own in Newton's method (Magisano, Leonetti and Garcea, 2017,
the mixed integration point). The residual is what it was; at a solution so is the tangent.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING

import ufl
from ufl.algorithms import expand_derivatives

from dolfinx import fem

from ..physics.energy import FibreEnergy
from ..physics.kinematics import Expr, fibre, stretch

if TYPE_CHECKING:
    from .discretisation import Scales

#: By trials with the cases of the paper and with columns of K_e L²/K_b = 500 to 5e6.
_NEAREST, _SHARE = 1e-2, 0.3


@dataclass(frozen=True)
class StiffEnergy:
    """One integral of ½ C q·q.

    Attributes
    ----------
    strains
        q, scalars that depend on the state.
    stiffness
        Rows of C; None where there is nothing.
    measure
        Of the integral.
    """

    strains: tuple[Expr, ...]
    stiffness: tuple[tuple[Expr | None, ...], ...]
    measure: ufl.Measure

    def correction(self, state: fem.Function, origin: fem.Function, step: fem.Function) -> ufl.Form:
        """What extrapolated stresses, less those of the state, add to the tangent."""
        space = state.function_space
        v, w = ufl.TestFunction(space), ufl.TrialFunction(space)
        excess = [_extrapolated(q, state, origin, step) - q for q in self.strains]
        terms = [
            sum(C * e for C, e in zip(row, excess, strict=True) if C is not None)
            * ufl.derivative(ufl.derivative(q, state, v), state, w)
            for q, row in zip(self.strains, self.stiffness, strict=True)
        ]
        return sum(terms) * self.measure


def near(scales: Scales) -> float:
    """Errors, in typical sizes, up to which an old factor serves where stretch is extrapolated.

    A step with it leaves stretches of second order in the error e. Their stresses, some K_e e²,
    enter the next tangent, and must be small against what resists where nothing stretches.
    """
    return min(_NEAREST, _SHARE * sqrt(scales.softness))


def stretching(energy: FibreEnergy, F: Expr, dx: ufl.Measure) -> list[StiffEnergy]:
    """Stretch of the fibres, whose placement gradient is F."""
    return [
        StiffEnergy((stretch(fibre(F, energy.directions[family])) - 1,), ((K_e,),), dx)
        for family, K_e in energy.stretch
    ]


def bending(energy: FibreEnergy, F: Expr, dx: ufl.Measure) -> list[StiffEnergy]:
    """Bending of the fibres, whose placement gradient is F."""
    kappas = energy.curvatures(F)
    return [StiffEnergy((kappas[family],), ((K_b,),), dx) for family, K_b in energy.bending]


def _extrapolated(q: Expr, state: fem.Function, origin: fem.Function, step: fem.Function) -> Expr:
    linear = expand_derivatives(q + ufl.derivative(q, state, step))
    return ufl.replace(linear, {state: origin})
