"""Dead loads on an end."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class EndLoad:
    r"""A dead force on a node and a couple on a link, both proportional to the load factor t.

    Their potential is :math:`-t\,(\mathbf f\cdot\mathbf u + m\,\varphi)`, with u the displacement
    of the node and φ the direction angle of the link.

    Attributes
    ----------
    end
        Name of the end.
    node
        Number of the node on which the force acts.
    link
        Number of the link on which the couple acts.
    force
        f at load factor 1, N.
    moment
        m at load factor 1, N m, anticlockwise.
    """

    end: str
    node: int
    link: int
    force: tuple[float, float] = (0.0, 0.0)
    moment: float = 0.0
