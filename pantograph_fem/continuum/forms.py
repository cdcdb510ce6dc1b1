"""The forms of a discretised energy between supports, compiled."""

from __future__ import annotations

from collections.abc import Sequence

import ufl

from dolfinx import fem

from .. import dolfinx_api as api
from ..schemes import Discretisation
from ..solve.origin import Origin
from .support import Support


class EquilibriumForms:
    """Functional, its first and second variation, and stored energies, of the present state.

    Attributes
    ----------
    potential
        The functional, J; None where equilibria are no minima of it.
    residual, tangent
        Its first and second variation.
    energies
        Stored energy of each effect, J.
    pull
        Minus the rate of the residual with the load at fixed state; None where there is none.
    """

    def __init__(
        self, discretisation: Discretisation, supports: Sequence[Support], has_minima: bool
    ) -> None:
        """Compile the forms."""
        functional = discretisation.functional
        energies = dict(discretisation.stored)
        for support in supports:
            for name, term in support.stored.items():
                functional += term
                energies[name] += term
            if support.potential is not None:
                functional += support.potential
        state = discretisation.state
        space = state.function_space
        residual = ufl.derivative(functional, state)
        tangent = ufl.derivative(residual, state)
        self._origin, self._step = fem.Function(space), fem.Function(space)
        stiff = (*discretisation.stiff, *(part for one in supports for part in one.stiff))
        for part in stiff:
            tangent += part.correction(state, self._origin, self._step)
        pulls = [support.pull for support in supports if support.pull is not None]
        self._extrapolates = bool(stiff)
        self.potential = api.form(functional) if has_minima else None
        self.residual = api.form(residual)
        self.tangent = api.form(tangent)
        self.energies = {name: api.form(energy) for name, energy in energies.items()}
        self.pull = api.form(ufl.derivative(sum(pulls), state)) if pulls else None

    def extrapolate_from(self, origin: Origin) -> None:
        """Set where the tangent extrapolates stresses from: see `pantograph_fem.schemes.stiff`."""
        if not self._extrapolates:
            return
        for function, values in ((self._origin, origin.x), (self._step, origin.step)):
            function.x.array[: len(values)] = values
            function.x.scatter_forward()
