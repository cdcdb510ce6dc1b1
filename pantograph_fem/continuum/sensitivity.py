r"""How an equilibrium answers to its material constants, by direct differentiation.

At an equilibrium the gradient of the functional vanishes on the free unknowns,
:math:`\mathbf r(\mathbf x, c) = 0`, whatever the constants c. At a fixed load, therefore,

.. math:: \mathbf K\,\frac{d\mathbf x}{dc} = -\frac{\partial\mathbf r}{\partial c}, \qquad
    \mathbf K = \frac{\partial\mathbf r}{\partial\mathbf x},

with the factor of K that was at hand anyway: a back-substitution for each constant. The energy (31)
is linear in K_e, K_b and K_p, so that :math:`\partial\mathbf r/\partial K` is what the effect alone
gives for K = 1; for γ the density of the pivots is differentiated symbolically.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
import ufl
from numpy.typing import NDArray

from dolfinx import fem

from .. import dolfinx_api as api
from ..physics.energy import FibreEnergy, shear_density
from ..physics.kinematics import shear_angle
from ..schemes import Discretisation, integration
from .equilibrium import ContinuumEquilibrium

Array = NDArray[np.float64]

STIFFNESSES = ("stretch", "bending", "shear")
EXPONENT = "shear_exponent"


class Sensitivity:
    """Derivatives of a sheet's equilibria with respect to some of its constants.

    Constants have the names of the section ``[material]``. One stiffness stands for both families.
    """

    def __init__(self, equilibrium: ContinuumEquilibrium, constants: Sequence[str]) -> None:
        """Compile what is needed for the constants, for stiffnesses nothing.

        Raises
        ------
        KeyError
            If the energy does not have a constant.
        """
        self._equilibrium = equilibrium
        self._all = material_constants(equilibrium.discretisation.energy)
        self._names = tuple(constants)
        if missing := set(constants) - set(self._all):
            raise KeyError(f"the energy has no constants {', '.join(sorted(missing))}")
        self._exponent = None
        if EXPONENT in constants:
            self._exponent = api.form(_exponent_gradient(equilibrium.discretisation))
            self._vector = api.create_vector(equilibrium.discretisation.state.function_space)

    @property
    def constants(self) -> dict[str, float]:
        """Present values of the constants, SI units."""
        return {name: float(self._all[name][0].value) for name in self._names}

    @constants.setter
    def constants(self, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            for constant in self._all[name]:
                constant.value = value

    def force_rates(self, x: Array, load: float) -> Array:
        """∂r/∂c at a fixed state, held dofs included; shape (constants, unknowns)."""
        rates = np.zeros((len(self._names), len(x)))
        with self._only(None):
            rest = self._equilibrium.forces(x, load)
        for name, rate in zip(self._names, rates, strict=True):
            if name == EXPONENT:
                self._equilibrium.load_state(x, load)
                api.assemble_vector(self._vector, self._exponent)
                rate[:] = self._vector.array[: len(x)]
            else:
                with self._only(name):
                    rate[:] = self._equilibrium.forces(x, load) - rest
        return rates

    def state_rates(self, force_rates: Array, solve: Callable[[Array], Array]) -> Array:
        """dx/dc at a fixed load; shape (constants, unknowns).

        Parameters
        ----------
        force_rates
            ∂r/∂c at the equilibrium.
        solve
            Back-substitution with the factor of the tangent there.
        """
        loads = -force_rates
        loads[:, self._equilibrium.held_dofs] = 0.0
        return np.array([solve(load) for load in loads])

    @contextmanager
    def _only(self, effect: str | None) -> Iterator[None]:
        """A stiffness of 1 for one effect, none for the others."""
        kept = {name: [c.value.copy() for c in self._all[name]] for name in self._stiffnesses}
        try:
            for name in self._stiffnesses:
                for constant in self._all[name]:
                    constant.value = 1.0 if name == effect else 0.0
            yield
        finally:
            for name, values in kept.items():
                for constant, value in zip(self._all[name], values, strict=True):
                    constant.value = value

    @property
    def _stiffnesses(self) -> list[str]:
        return [name for name in STIFFNESSES if name in self._all]


def material_constants(energy: FibreEnergy) -> dict[str, list[fem.Constant]]:
    """The constants of an energy by their names in ``[material]``; one for each family."""
    found = {
        "stretch": [K for _, K in energy.stretch],
        "bending": [K for _, K in energy.bending],
        "shear": [energy.shear],
        EXPONENT: [energy.exponent],
    }
    return {name: constants for name, constants in found.items() if constants not in ([], [None])}


def _exponent_gradient(discretisation: Discretisation) -> ufl.Form:
    """Derivative of the gradient of the shear energy with respect to γ."""
    energy = discretisation.energy
    gamma = ufl.variable(energy.exponent)
    psi = shear_angle(*discretisation.fibres)
    density = shear_density(psi, energy.shear, gamma, energy.regularisation)
    dx = integration("dx", discretisation.quadrature_degree)
    return ufl.derivative(ufl.diff(density, gamma) * dx, discretisation.state)
