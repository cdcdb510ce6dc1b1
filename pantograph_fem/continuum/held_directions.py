r"""Directions of fibres that a part of the boundary holds weakly.

A clamp holds the direction φ of a fibre but not its stretch, which no linear condition on the
placement gradient does. So it acts as a hinge whose turn J = φ - θ against the imposed direction θ
is closed by the fibre's own moment m = K_b κ (Nitsche's method). With q = D·n it adds

.. math:: -m\,q\,J + \tfrac12 K_b\,s\,q^2 J^2

to the stored energy, which vanishes with the mesh size; s is that of
:func:`pantograph_fem.schemes.hinge.hinge_stiffness`. The couple that the clamp exerts is
:math:`\partial\Pi/\partial\theta = m q - K_b s q^2 J`.
"""

from __future__ import annotations

import numpy as np
import ufl

from mpi4py import MPI

from dolfinx import fem, mesh

from .. import dolfinx_api as api
from ..physics.kinematics import angle_between, fibre
from ..physics.rigid_motion import RigidMotion
from ..schemes import Discretisation, StiffEnergy, hinge_stiffness, integration


class HeldDirections:
    """All fibres that end at some facets, turned with a rigid motion.

    Attributes
    ----------
    stored
        The hinge's energy, J.
    stiff
        The same, for tangents that extrapolate its stresses.
    pull
        Form -∂Π/∂load, J; None where the motion does not turn.
    """

    def __init__(
        self, discretisation: Discretisation, facets: mesh.MeshTags, tag: int, motion: RigidMotion
    ) -> None:
        domain = discretisation.state.function_space.mesh
        energy, F = discretisation.energy, discretisation.bent_gradient
        self._comm = domain.comm
        self._motion = motion
        self._rotation = fem.Constant(domain, np.eye(2))
        ds = integration("ds", discretisation.quadrature_degree, domain, facets)(tag)
        stiffness = hinge_stiffness(domain, discretisation.curvature_degree)
        n = ufl.FacetNormal(domain)
        stored, couple = 0, 0
        self.stiff: list[StiffEnergy] = []
        for family, K_b in energy.bending:
            D = energy.directions[family]
            held = ufl.dot(self._rotation, fibre(energy.reference, D))
            J = angle_between(held, fibre(F, D))
            kappa, q = discretisation.curvatures[family], ufl.dot(D, n)
            moment = K_b * kappa
            rows = ((None, -K_b * q), (-K_b * q, K_b * stiffness * q**2))
            self.stiff.append(StiffEnergy((kappa, J), rows, ds))
            stored += -moment * q * J + 0.5 * K_b * stiffness * (q * J) ** 2
            couple += moment * q - K_b * stiffness * q**2 * J
        self.stored = stored * ds
        self.pull = -fem.Constant(domain, motion.angle) * couple * ds if motion.angle else None
        self._couple = api.form(couple * ds)

    def move(self, load: float) -> None:
        """Turn what holds the directions."""
        self._rotation.value[:] = self._motion.rotation(load)

    def moment(self) -> float:
        """The couple that it exerts, N m; a collective call."""
        return self._comm.allreduce(fem.assemble_scalar(self._couple), MPI.SUM)
