"""Sweeps: which keys of a case are varied, by which design, and what is looked at."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from ..case.part import Part
from ..case.problem import Problem, not_allowed, problem_error
from ..compare.study import Strings, Text
from .vary import Vary

#: Designs from which sensitivity indices follow.
SENSITIVITY = ("morris", "saltelli")


class SweepStudy(Part):
    """A sweep.

    Attributes
    ----------
    name
        The stem of the file; results go to ``results/<name>`` by default.
    title
        Title of tables and figures.
    case
        Case file, relative to the folder of the study file.
    set
        Values in place of those of the case file, each as ``key.path=value``.
    design
        "grid": every combination of the values; "latin_hypercube" and "sobol": points that fill
        the ranges evenly; "morris": trajectories along which one key changes at a time, for
        elementary effects; "saltelli": pairs of points with columns exchanged, for Sobol indices.
    samples
        Number of points of a Latin hypercube or a Sobol sequence; of trajectories for "morris",
        each of k + 1 points for k keys; "saltelli" takes k + 2 times as many points.
    seed
        Of what is drawn at random: the same seed gives the same points.
    outputs
        Columns of ``history.csv`` to tabulate, and "force" for its magnitude; by default force
        and its components, energy and its parts, whether the state is stable, and the responses.
    at_stops
        Whether outputs are tabulated at every stop, too.
    responses
        Outputs that are drawn, and whose sensitivity indices are found.
    vary
        The keys.
    """

    name: Text = "sweep"
    title: Text | None = None
    case: Text
    set: Strings = ()
    design: Literal["grid", "latin_hypercube", "sobol", "morris", "saltelli"] = "grid"
    samples: int | None = Field(default=None, ge=2)
    seed: int = Field(default=0, ge=0, lt=2**32 - 1)
    outputs: Strings = ()
    at_stops: bool = False
    responses: Strings = ("force", "energy")
    vary: tuple[Vary, ...]

    @model_validator(mode="after")
    def _different_keys(self) -> SweepStudy:
        for i, vary in enumerate(self.vary):
            for other in self.vary[:i]:
                if overlap(vary.key, other.key):
                    rule = f"be a key apart from {other.key}, which is varied already"
                    raise problem_error(Problem(not_allowed(vary.key, rule), ("vary", i, "key")))
        return self

    @model_validator(mode="after")
    def _samples_fit(self) -> SweepStudy:
        if self.design == "grid":
            if self.samples is not None:
                text = "not allowed in a grid, whose points are all combinations of the values"
                raise problem_error(Problem(text, ("samples",)))
            return self
        if self.samples is None:
            raise problem_error(
                Problem("missing; it must be a whole number, 2 or greater", ("samples",))
            )
        if self.design in ("sobol", "saltelli") and self.samples & (self.samples - 1):
            rule = "be a power of 2, for which a Sobol sequence fills the ranges evenly"
            raise problem_error(Problem(not_allowed(self.samples, rule), ("samples",)))
        return self

    @model_validator(mode="after")
    def _values_fit(self) -> SweepStudy:
        problems = []
        for i, vary in enumerate(self.vary):
            if self.design == "grid" and vary.values is None and vary.count is None:
                text = "missing; a grid needs values, or the count of them between low and high"
                problems.append(Problem(text, ("vary", i, "count")))
            if self.design != "grid" and vary.count is not None:
                text = "not allowed; only a grid counts the values of a key"
                problems.append(Problem(text, ("vary", i, "count")))
            if self.design == "morris" and vary.values is not None:
                text = "not allowed; elementary effects need a range, low and high"
                problems.append(Problem(text, ("vary", i, "values")))
        if problems:
            raise problem_error(*problems)
        return self

    @model_validator(mode="after")
    def _responses_are_outputs(self) -> SweepStudy:
        wrong = [name for name in self.responses if self.outputs and name not in self.outputs]
        if wrong:
            rule = f"be among the outputs, {', '.join(self.outputs)}"
            raise problem_error(*(Problem(not_allowed(n, rule), ("responses",)) for n in wrong))
        return self


def overlap(key: str, other: str) -> bool:
    """Whether two keys are the same, or one is within the other."""
    a, b = (tuple(text.replace("[", ".[").split(".")) for text in (key, other))
    shared = min(len(a), len(b))
    return a[:shared] == b[:shared]
