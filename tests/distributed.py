"""Sums, norms and states of vectors of which each process has a part."""

import numpy as np

from mpi4py import MPI

_WAVES = 12


def total(number):
    """Sum over the processes."""
    return MPI.COMM_WORLD.allreduce(number)


def dot(one, other):
    """Scalar product."""
    return total(float(one @ other))


def norm(vector):
    """Euclidean norm."""
    return np.sqrt(dot(vector, vector))


def largest(values):
    """Largest magnitude."""
    return MPI.COMM_WORLD.allreduce(float(np.abs(values).max(initial=0.0)), MPI.MAX)


def own_blocks(equilibrium, name):
    """Dofs (n, components) and places (n, 2) of the blocks of a field that this process owns."""
    field = equilibrium.discretisation.field(name)
    own = field.dofs[:, 0] < len(equilibrium.undeformed())
    return field.dofs[own], field.coordinates[own]


def rough(places, components, seed, wavelength):
    """Values at places (n, 2) that look random, and are the same however these are distributed.

    A sum of waves of about that length, with a root mean square of about one.
    """
    rng = np.random.default_rng(seed)
    waves = 2.0 * np.pi / wavelength * rng.standard_normal((_WAVES, 2))
    phases = rng.uniform(0.0, 2.0 * np.pi, (_WAVES, components))
    return np.sin((places @ waves.T)[:, :, None] + phases).sum(axis=1) * np.sqrt(2.0 / _WAVES)
