"""Beams of energy (16) as boundary value problems of ordinary differential equations.

Independent of the package. With the end force P and the direction e of the axis, n a quarter turn
ahead of it: K_e (ρ - 1) = P·e and K_b φ'' + ρ P·n = 0.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve


@dataclass(frozen=True)
class ExactBeam:
    """Force and moment of the right end, its place and direction, and the stored energy."""

    force: np.ndarray
    moment: float
    place: np.ndarray
    angle: float
    energy: float


def cantilever(K_e, K_b, length, force, root_curvature):
    """Integrate from the clamp with a known end force."""

    def rates(_, y):
        _, _, angle, curvature, _ = y
        e = np.array([np.cos(angle), np.sin(angle)])
        n = np.array([-e[1], e[0]])
        rho = 1 + force @ e / K_e
        stored = 0.5 * K_e * (rho - 1) ** 2 + 0.5 * K_b * curvature**2
        return [rho * e[0], rho * e[1], curvature, -rho * (force @ n) / K_b, stored]

    start = [0.0, 0.0, 0.0, root_curvature, 0.0]
    end = solve_ivp(rates, (0, length), start, method="DOP853", rtol=1e-11, atol=1e-11).y[:, -1]
    return ExactBeam(np.asarray(force), K_b * end[3], end[:2], end[2], end[4])


def cantilever_along_an_arc(K_e, K_b, length, angles):
    """Tip on the circle about the middle of the beam, free to turn, at increasing angles (rad).

    Followed from rest in steps of at most two degrees, as there are other solutions.
    """
    unit = np.array([K_b / length**2, K_b / length**2, 1.0 / length])
    unknowns, reached, beams = np.zeros(3), 0.0, []
    for angle in angles:
        for t in np.linspace(reached, angle, 2 + int(np.degrees(angle - reached) / 2))[1:]:
            place = length / 2 * np.array([1 + np.cos(t), np.sin(t)])

            def beam(unknowns):
                return cantilever(K_e, K_b, length, unit[:2] * unknowns[:2], unit[2] * unknowns[2])

            def misfit(unknowns, place=place):
                found = beam(unknowns)
                return [*((found.place - place) / length), found.moment * length / K_b]

            unknowns = fsolve(misfit, unknowns, xtol=1e-11)
            assert np.abs(misfit(unknowns)).max() < 1e-9
        beams.append(beam(unknowns))
        reached = angle
    return beams


def cantilever_with_dead_load(K_e, K_b, length, force, guess):
    """Tip loaded and free to turn; `guess` is the root's curvature."""
    force = np.asarray(force, float)

    def misfit(unknown):
        return cantilever(K_e, K_b, length, force, unknown[0]).moment / (K_b / length)

    solution = fsolve(misfit, [guess], xtol=1e-11)
    assert np.abs(misfit(solution)).max() < 1e-9
    return cantilever(K_e, K_b, length, force, solution[0])
