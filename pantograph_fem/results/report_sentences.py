"""How a run ended, and what to beware of, in sentences."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .summary import CRITICAL, DONE

History = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class OutcomeSentence:
    """How a run ended: its kind, and a sentence."""

    kind: Literal["done", "critical", "stopped"]
    sentence: str


def outcome(summary: Mapping[str, Any] | None, history: History) -> OutcomeSentence:
    """How a run ended; without a summary it has not."""
    loads, states = history["load"], len(history["load"])
    reached = f"load factor {loads[-1]:.7g}" if states else "no state"
    if summary is None:
        return OutcomeSentence(
            "stopped",
            f"Not finished: summary.json is missing. The run goes on, or it was interrupted; "
            f"{reached} is the last that was found.",
        )
    status = str(summary.get("status", ""))
    if status == DONE:
        return OutcomeSentence("done", f"Done: the path was followed to {reached}.")
    if status == CRITICAL:
        points = summary.get("critical_points") or [{}]
        kind = f", a {points[-1]['kind']}" if "kind" in points[-1] else ""
        return OutcomeSentence(
            "critical", f"Stopped at a critical load, as asked for: {reached}{kind}."
        )
    reason = status.removeprefix("stopped: ") or "the summary does not say why."
    return OutcomeSentence("stopped", f"Stopped before the end. {reason}")


def warnings(summary: Mapping[str, Any] | None, history: History) -> list[str]:
    """What a reader should know before the numbers are used."""
    found = []
    message = str((summary or {}).get("message", ""))
    if message.startswith("Warning"):
        found.append(message)
    unstable = ~history["stable"]
    if unstable.any():
        first = history["load"][int(np.argmax(unstable))]
        found.append(
            f"{unstable.sum()} of {len(unstable)} states are unstable, the first at load factor "
            f"{first:.7g}: equilibria, but no minima of energy. A specimen could give way there."
        )
    if cutbacks := int((summary or {}).get("cutbacks", 0)):
        times = "A step was" if cutbacks == 1 else f"{cutbacks} steps were"
        found.append(f"{times} rejected and tried again with a smaller one.")
    return found
