"""Fields of a net on its nodes and links."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .couples import shear_angles
from .energy import NetEnergy
from .links import LinkState
from .net import Net
from .quadrants import all_quadrants, links_at_nodes

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class NetFields:
    """Fields by name: on nodes (n,) or (n, 2), and on links (m,)."""

    nodes: dict[str, Array]
    links: dict[str, Array]


class NetSampler:
    """What every net shows: displacements, stretches of links and energy densities.

    A link's energy is shared by its nodes; a rotational spring's is that of the node where its
    links meet. The density of a node is its energy over the part of the continuum that it stands
    for: J/m² of a lattice, J/m of a chain.
    """

    def __init__(self, net: Net, parts: Array) -> None:
        self._net = net
        self._energy = NetEnergy(net)
        self._parts = parts
        self._rest = self._energy.state(np.zeros((net.size, 2))).length

    def sample(self, u: Array, rotations: Array) -> NetFields:
        """Fields at displacements u (n, 2) and rotations of the ends (rad)."""
        state = self._energy.state(u)
        densities = {
            name: energy / self._parts
            for name, energy in self._energy.nodal_energies(u, rotations).items()
        }
        nodes = {"displacement": u} | self._kinematics(state)
        nodes["energy_density"] = np.sum(list(densities.values()), axis=0)
        nodes |= {f"energy_density_{name}": density for name, density in densities.items()}
        return NetFields(nodes, {"stretch": state.length / self._rest})

    def _kinematics(self, state: LinkState) -> dict[str, Array]:
        raise NotImplementedError


class LatticeSampler(NetSampler):
    """A lattice shows the mean shear angle of the quadrants at each node."""

    def __init__(self, net: Net, parts: Array) -> None:
        super().__init__(net, parts)
        at = links_at_nodes(net.links, net.family, net.size)
        self._pairs, self._at = all_quadrants(at)

    def _kinematics(self, state: LinkState) -> dict[str, Array]:
        n = self._net.size
        total = np.bincount(self._at, shear_angles(state, self._pairs), n)
        count = np.bincount(self._at, minlength=n)
        psi = total / np.maximum(count, 1)
        # Ends of fibres have no quadrant of their own; they show that of their neighbours.
        known = count > 0
        first, second = self._net.links.T
        near = np.bincount(first, psi[second] * known[second], n)
        near += np.bincount(second, psi[first] * known[first], n)
        neighbours = np.bincount(first, known[second], n) + np.bincount(second, known[first], n)
        return {"shear_angle": np.where(known, psi, near / np.maximum(neighbours, 1))}


class ChainSampler(NetSampler):
    """A chain shows its direction and curvature at the nodes.

    The curvature is the turn over the length that the node stands for, as in (7) to (12), and at
    the ends what two nodes inside extrapolate to.
    """

    def _kinematics(self, state: LinkState) -> dict[str, Array]:
        links = np.unwrap(np.arctan2(state.tangent[:, 1], state.tangent[:, 0]))
        turns = np.diff(links)
        angle = np.empty(self._net.size)
        angle[1:-1] = links[:-1] + 0.5 * turns
        angle[[0, -1]] = links[0] - 0.5 * turns[0], links[-1] + 0.5 * turns[-1]
        curvature = np.empty(self._net.size)
        curvature[1:-1] = turns / self._parts[1:-1]
        curvature[0] = 2.0 * curvature[1] - curvature[min(2, len(turns))]
        curvature[-1] = 2.0 * curvature[-2] - curvature[-1 - min(2, len(turns))]
        return {"angle": angle, "curvature": curvature}
