"""The work of grips and loads along a path, which the energy has to account for."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from ..case import BeamCase, Case, ChainCase, LatticeCase, SheetCase
from ..case.ends import End
from ..physics.rigid_motion import RigidMotion
from .evidence import Array, Evidence

#: Fewer states than this do not tell how the force goes between them.
_FEWEST = 6
#: Where the interpolation is uncertain by this share of the energy, nothing is told either.
_VAGUE = 0.25
#: Relative difference that is no difference: what iterations and the arithmetic leave.
_ROUNDING = 1e-6

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True)
class Balance:
    r"""Energy against work, summed over steps, as shares of the largest energy.

    Along a path the potential Π of the body and its dead loads changes by what the moving grips
    do, and by the growth of the loads: :math:`d\Pi/dt = F\cdot v + M\omega - P\cdot u - M_P\theta`.

    Attributes
    ----------
    defect
        Sum over steps of the difference between the change of Π and its integral, the rate being
        interpolated by a spline between the states.
    uncertainty
        Sum over steps of the difference between that spline and straight lines: the bound.
    """

    defect: float
    uncertainty: float

    @property
    def holds(self) -> bool:
        """Whether the difference is no more than the interpolation explains."""
        return self.defect <= self.uncertainty + _ROUNDING


def balance(found: Evidence) -> Balance | None:
    """Energy against work of a run, or None where its history does not tell the work."""
    if found.rows < _FEWEST:
        return None
    known = _rate(found)
    if known is None:
        return None
    potential, rate = known
    load = found.column("load")
    scale = found.energy_scale
    defect = uncertainty = 0.0
    for piece in _smooth_pieces(found):
        smooth, straight = _integrals(load[piece], rate[piece])
        defect += float(np.abs(np.diff(potential[piece]) - smooth).sum())
        uncertainty += float(np.abs(smooth - straight).sum())
    if uncertainty > _VAGUE * scale:
        return None
    return Balance(defect / scale, uncertainty / scale)


def _integrals(load: Array, rate: Array) -> tuple[Array, Array]:
    """∫ rate dload between states, by a parametric spline and by straight lines.

    The parameter is the length of the curve in the plane of both, each as a share of its range:
    loads may turn back, and forces set out from rest with an infinite slope.
    """
    straight = 0.5 * (rate[1:] + rate[:-1]) * np.diff(load)
    chords = np.hypot(np.diff(load) / (np.ptp(load) or 1.0), np.diff(rate) / (np.ptp(rate) or 1.0))
    if len(load) < 3 or chords.min() <= 0.0:
        return straight, straight
    s = np.concatenate([[0.0], np.cumsum(chords)])
    x, y = CubicSpline(s, load), CubicSpline(s, rate)
    half = 0.5 * np.diff(s)[:, None]
    at = 0.5 * (s[1:] + s[:-1])[:, None] + half * _NODES
    smooth = (y(at) * x(at, 1) * half * _WEIGHTS).sum(axis=1)
    return smooth, straight


def _smooth_pieces(found: Evidence) -> list[slice]:
    """The history between the states at which the path may have a kink: its critical points."""
    critical = [point["step"] for point in found.critical_points]
    inner = np.flatnonzero(np.isin(found.history["step"], critical))
    edges = [0, *(int(i) for i in inner if 0 < i < found.rows - 1), found.rows - 1]
    return [slice(a, b + 1) for a, b in pairwise(edges)]


def _rate(found: Evidence) -> tuple[Array, Array] | None:
    """Π and dΠ/dt at each state, J."""
    motions = _motions(found.case)
    if motions is None:
        return None
    near, far, far_end = motions
    load, energy = found.column("load"), found.column("energy")
    force = np.column_stack([found.column("force_x"), found.column("force_y")])
    moment = found.column("moment")
    if far_end is not None:
        # Held by loads: their work is that of dead forces along the displacement of the tip.
        if near.moves:
            return None
        tip = np.column_stack([found.column("tip_ux"), found.column("tip_uy")])
        work = tip @ np.asarray(far_end.force) + found.column("tip_angle") * far_end.moment
        return energy - load * work, -work
    rate = far.power(load, force, moment)
    if near.moves:
        arm = far.place(load) - near.place(load)
        back = -moment - (arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0])
        rate = rate + near.power(load, -force, back)
    return energy, rate


@dataclass(frozen=True)
class _Moved:
    """A grip or end that is moved: its motion and the reference point of its moment."""

    motion: RigidMotion
    centre: tuple[float, float]

    @property
    def moves(self) -> bool:
        return self.motion.angle != 0.0 or self.motion.translation != (0.0, 0.0)

    def place(self, load: Array) -> Array:
        X = np.array([self.centre])
        return np.array([X[0] + self.motion.displacement(X, t)[0] for t in load])

    def power(self, load: Array, force: Array, moment: Array) -> Array:
        X = np.array([self.centre])
        velocity = np.array([self.motion.displacement_rate(X, t)[0] for t in load])
        return np.asarray((force * velocity).sum(axis=1) + moment * self.motion.angle)


def _motions(case: Case) -> tuple[_Moved, _Moved, End | None] | None:
    """The end that balances the reported one, that one, and its loads where it has any.

    Of a sheet on a mesh from a file it takes the grips to be those of the case's rectangle.
    """
    if isinstance(case, SheetCase | LatticeCase):
        moved = []
        for grip, y in ((case.grips.bottom, 0.0), (case.grips.top, case.sheet.height)):
            width = case.sheet.width
            pivots = {"left": (0.0, y), "right": (width, y), "centre": (0.5 * width, y)}
            pivot = pivots[grip.pivot] if isinstance(grip.pivot, str) else grip.pivot
            motion = RigidMotion.from_degrees(grip.translation, grip.rotation, pivot)
            moved.append(_Moved(motion, pivots["centre"]))
        return moved[0], moved[1], None
    if isinstance(case, BeamCase | ChainCase):
        left, right = case.ends.left, case.ends.right
        if left.moment or any(left.force):
            return None
        near, far = _end(left, 0.0), _end(right, case.beam.length)
        if near.moves and case.material.foundation is not None:
            return None
        return near, far, right if right.support in ("free", "roller") else None
    return None


def _end(end: End, x: float) -> _Moved:
    motion = RigidMotion.from_degrees(end.translation, end.rotation, end.pivot or (x, 0.0))
    return _Moved(motion, (x, 0.0))
