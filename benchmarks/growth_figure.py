"""The figure cost_growth.png: CPU time of a tangent, and memory, against unknowns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from pantograph_fem.study.machine import machine

if TYPE_CHECKING:
    from cost_growth import Cost

_STAGES = {"assemble": ("s", ":"), "solve": ("^", "--"), "tangent": ("o", "-")}


def draw(costs: Sequence[Cost], exponents: Mapping[tuple[str, str], float], path: Path) -> None:
    """Draw a colour per scheme and a dash per stage; the exponents stand in the legend."""
    figure = Figure(figsize=(8.4, 4.4))
    figure.set_layout_engine("constrained")
    times, memory = figure.subplots(1, 2)
    for colour, scheme in enumerate(dict.fromkeys(cost.scheme for cost in costs)):
        mine = [cost for cost in costs if cost.scheme == scheme]
        dofs = [cost.dofs for cost in mine]
        for name, (marker, dash) in _STAGES.items():
            label = f"{scheme}, {name}: {exponents[scheme, name]:.2f}"
            values = [getattr(cost, name) for cost in mine]
            times.loglog(dofs, values, dash, color=f"C{colour}", marker=marker, label=label)
        label = f"{scheme}: {exponents[scheme, 'memory']:.2f}"
        memory.loglog(dofs, [cost.memory for cost in mine], "o-", color=f"C{colour}", label=label)
    times.set_ylabel("CPU time of one tangent (s)")
    memory.set_ylabel("memory of the process (GiB)")
    for axes in (times, memory):
        for line in axes.lines:
            line.set(markersize=4.0, linewidth=1.2)
        axes.set_xlabel("unknowns")
        axes.grid(which="major", color="0.9", linewidth=0.7)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, fontsize="x-small", title="exponent", title_fontsize="x-small")
    figure.supxlabel(f"one core; {machine()}", fontsize=6, color="0.35", parse_math=False)
    figure.savefig(path, dpi=200)
