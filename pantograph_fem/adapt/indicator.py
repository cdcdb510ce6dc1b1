r"""A-posteriori error indicator of a state, cell by cell.

Strains that are exact are continuous. So what the strains of an element differ by from their means
over the elements around is an estimate of their error, and the energy of that difference an
estimate of the error in energy norm (Zienkiewicz and Zhu, 1987). With the fibre vectors
:math:`\mathbf a_\alpha` and the curvatures :math:`\kappa_\alpha`,

.. math:: \eta_T^2 = \int_T \sum_\alpha \tfrac12 K_e^\alpha\,\delta\rho_\alpha^2
    + \tfrac12 K_b^\alpha\left(\delta\kappa_\alpha^2
    + \frac{c}{h^2}\,\delta\varphi_\alpha^2\right)
    + \tfrac12 w''(\psi)\,\delta\psi^2\ d\Omega

The turn δφ is half of the jump of a fibre's direction between elements, the turn of a hinge. It
has the stiffness that bending gives it within a layer as thick as the element.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..parallel import at_root
from ..physics.energy import FibreEnergy
from ..schemes import Discretisation
from .recovery import Recovery

Array = NDArray[np.float64]

#: c: of a turn against the curvature that undoes it over the length of an element.
TURN_STIFFNESS = 10.0
#: Shear angle below which the tangent of the pivots is not followed to infinity, rad.
_SMALLEST_ANGLE = 0.05


class ErrorIndicator:
    """The indicator of a discretisation's present state."""

    def __init__(self, discretisation: Discretisation) -> None:
        """Compile the strains; a collective call."""
        domain = discretisation.state.function_space.mesh
        self._comm = domain.comm
        self._energy = discretisation.energy
        a1, a2 = discretisation.fibres
        self._recovery = Recovery(domain, [a1[0], a1[1], a2[0], a2[1], *discretisation.curvatures])
        # The cells as they were numbered before they were distributed.
        self._numbers = np.array(domain.topology.original_cell_index)[: len(self._recovery.areas)]

    def evaluate(self) -> Array | None:
        """η of every cell of the triangulation on rank 0, shape (m,), J^(1/2); None elsewhere.

        A collective call.
        """
        own, mean = self._recovery.evaluate()
        areas = self._recovery.areas
        density = error_density(self._energy, own, mean, areas)
        parts = self._comm.gather((self._numbers, density * areas), root=0)

        def collect() -> Array:
            assert parts is not None
            numbers, squares = (np.concatenate(part) for part in zip(*parts, strict=True))
            eta = np.empty(len(numbers))
            eta[numbers] = np.sqrt(squares)
            return eta

        return at_root(self._comm, collect)


def error_density(energy: FibreEnergy, own: Array, mean: Array, areas: Array) -> Array:
    """Square of the indicator per area of each cell, J/m².

    Parameters
    ----------
    energy
        Stiffnesses of the effects.
    own, mean
        a1, a2 and, where there is bending, κ1, κ2 at the nodes of each cell as the element has
        them and as they are in the mean, shape (cells, nodes, 4 or 6).
    areas
        Area of each cell, m².
    """
    difference = own - mean
    squared_size = (areas * 4.0 / np.sqrt(3.0))[:, None]
    density = np.zeros(own.shape[:2])
    angles, turns = [], []
    for family in range(2):
        a = mean[..., 2 * family : 2 * family + 2]
        d = difference[..., 2 * family : 2 * family + 2]
        rho = np.linalg.norm(a, axis=-1)
        stretch = (a * d).sum(axis=-1) / rho
        turn = (a[..., 0] * d[..., 1] - a[..., 1] * d[..., 0]) / rho**2
        angles.append(np.arctan2(a[..., 1], a[..., 0]))
        turns.append(turn)
        density += 0.5 * _stiffness(energy.stretch, family) * stretch**2
        if energy.bending:
            K_b = _stiffness(energy.bending, family)
            density += 0.5 * K_b * difference[..., 4 + family] ** 2
            density += 0.5 * K_b * TURN_STIFFNESS / squared_size * turn**2
    if energy.shear is not None:
        psi = (angles[0] - angles[1] + 1.5 * np.pi) % (2.0 * np.pi) - np.pi
        density += 0.5 * _shear_tangent(energy, psi) * (turns[0] - turns[1]) ** 2
    return density.mean(axis=1)


def _stiffness(terms: tuple[tuple[int, object], ...], family: int) -> float:
    """Stiffness of a family; 0 where it has none."""
    return next((_value(K) for index, K in terms if index == family), 0.0)


def _shear_tangent(energy: FibreEnergy, psi: Array) -> Array:
    """Second derivative of the pivots' energy, N/m."""
    K_p = _value(energy.shear)
    if energy.exponent is None:
        return np.full_like(psi, K_p)
    gamma = _value(energy.exponent)
    angle = np.maximum(np.abs(psi), _SMALLEST_ANGLE)
    return 0.5 * K_p * gamma * (gamma - 1.0) * angle ** (gamma - 2.0)


def _value(constant: object) -> float:
    return float(constant.value)  # type: ignore[attr-defined]
