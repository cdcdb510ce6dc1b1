"""From a case to the discrete problem: mesh, energy, scheme and ends."""

from __future__ import annotations

from mpi4py import MPI

from dolfinx import fem

from ..case import BeamCase
from ..case.ends import HELD, End
from ..physics.energy import FibreEnergy, beam_energy
from ..physics.rigid_motion import RigidMotion
from ..schemes import Discretisation, Scales, discretise
from .domain import ENDS, Axis, distribute, nodes, piecewise
from .end import EndConditions, EndSupport


def build_axis(case: BeamCase, comm: MPI.Comm) -> Axis:
    """Divide the beam into elements and distribute them; a collective call."""
    assert case.mesh.size is not None  # the case has filled it in
    length = case.beam.length
    breaks = [end for end, _ in case.material.pieces(length)]
    return distribute(comm, nodes(length, case.mesh.size, breaks))


def build_energy(case: BeamCase, axis: Axis) -> FibreEnergy:
    """Energy (16) of the effects that the case names, with coefficients that can change."""
    material = case.material
    pieces = material.pieces(axis.length)
    return beam_energy(
        constant=lambda value: fem.Constant(axis.mesh, float(value)),
        stretch=material.stretch,
        bending=material.bending,
        foundation=piecewise(axis, pieces) if pieces else None,
    )


def discretise_beam(case: BeamCase, axis: Axis) -> Discretisation:
    """Energy (16) by the scheme of the case."""
    options, material = case.discretisation, case.material
    stretch, bending = material.stretch or 0.0, (material.bending or 0.0) / axis.length**2
    return discretise(
        axis.mesh,
        build_energy(case, axis),
        Scales.of(axis.length, 1, stretch, bending),
        scheme=options.scheme,
        degree=options.degree,
        auxiliary_degree=options.auxiliary_degree,
        quadrature_degree=options.quadrature_degree,
    )


def build_supports(case: BeamCase, discretisation: Discretisation, axis: Axis) -> list[EndSupport]:
    """Both ends, in the order of :data:`ENDS`."""
    return [
        EndSupport(
            end_conditions(getattr(case.ends, name), name, axis.length), discretisation, axis
        )
        for name in ENDS
    ]


def end_conditions(end: End, name: str, length: float) -> EndConditions:
    """What a section ``[ends.<name>]`` asks for."""
    place = (length * ENDS.index(name), 0.0)
    return EndConditions(
        name=name,
        held=HELD[end.support],
        clamp=end.support == "clamped",
        motion=RigidMotion.from_degrees(end.translation, end.rotation, end.pivot or place),
        force=end.force,
        moment=end.moment,
    )
