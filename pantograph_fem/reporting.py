"""The row of ``history.csv`` that a state makes, whatever is simulated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from .physics.reaction import Reaction
from .results.history import HistoryRow
from .solve.continuation import Array, Step

#: Columns of the driven end of a beam or chain: displacement (m) and direction angle (rad).
TIP_COLUMNS = ("tip_ux", "tip_uy", "tip_angle")


def history_row(
    step: Step,
    reaction: Reaction,
    energies: dict[str, float],
    *,
    shear: tuple[float, float] = (0.0, 0.0),
    probes: Iterable[Array] = (),
    extra: Mapping[str, float] | None = None,
) -> HistoryRow:
    """The row of an accepted state; `shear` is the range of the shear angle, rad."""
    return HistoryRow(
        step=step.number,
        load=step.load,
        force=reaction.force,
        moment=reaction.moment,
        energies=energies,
        newton_iterations=step.iterations,
        negative_pivots=step.linearisation.negative_pivots,
        expected_negative_pivots=step.linearisation.expected_negative_pivots,
        stable=step.linearisation.stable,
        shear_min=shear[0],
        shear_max=shear[1],
        probes=tuple((float(ux), float(uy)) for ux, uy in probes),
        extra=dict(extra or {}),
    )


def tip_columns(displacement: Array, angle: float) -> dict[str, float]:
    """Values of :data:`TIP_COLUMNS`."""
    values = (float(displacement[0]), float(displacement[1]), float(angle))
    return dict(zip(TIP_COLUMNS, values, strict=True))
