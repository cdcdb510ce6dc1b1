"""What is known about a path that could not be followed any further."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from .cause import Cause


@dataclass(frozen=True)
class Diagnosis:
    """What a problem can tell about a state that was not found, and about the last that was.

    Attributes
    ----------
    worst_residual
        Largest entry of the residual of the last try in the measures of Newton's method; None
        where it is no number.
    worst_at
        The unknown whose it is, and its position.
    condition
        Condition of the factorisation at the last accepted state as MUMPS estimates it, that of
        Arioli, Demmel and Duff, which no scaling of rows changes; None on several processes,
        where MUMPS has none, and where there is no factor.
    lowest_eigenvalue
        That of the tangent there, in typical energies; None where it was not found.
    negative_pivots, expected_negative_pivots, zero_pivots
        Inertia there; a stable state has the expected ones and no zero.
    """

    worst_residual: float | None = None
    worst_at: str = ""
    condition: float | None = None
    lowest_eigenvalue: float | None = None
    negative_pivots: int | None = None
    expected_negative_pivots: int | None = None
    zero_pivots: int | None = None


@dataclass(frozen=True)
class Remedies:
    """What can be changed about a problem, in the words of its case.

    Attributes
    ----------
    finer
        What makes its mesh finer.
    missing
        Constants that could resist what nothing resists.
    """

    finer: str = "a finer mesh"
    missing: tuple[str, ...] = ()


@dataclass(frozen=True)
class FailureReport:
    """Why a path ends.

    Attributes
    ----------
    last_load
        Load of the last accepted state.
    load, step
        The last try: its load, and the step to it, in loads or in the length of an arc.
    cause, reason
        Why it failed, as a kind and as a sentence.
    residuals
        Norm of the scaled residual before each step of the last attempt and after it.
    turns_back_at
        Load near which the path seems to turn back; None where it does not.
    diagnosis
        What the problem can tell.
    advice
        One setting to try.
    sentence
        How it ends, where that is not by a smallest step that failed.
    """

    last_load: float
    load: float
    step: float
    cause: Cause
    reason: str
    residuals: tuple[float, ...] = ()
    turns_back_at: float | None = None
    diagnosis: Diagnosis = Diagnosis()
    advice: str = ""
    sentence: str = ""

    @property
    def message(self) -> str:
        """The report as a short paragraph."""
        if self.sentence:
            return f"{self.sentence} Try {self.advice}."
        where = self.diagnosis.worst_at
        if self.cause in (Cause.OBJECTION, Cause.ELSEWHERE):
            where = ""  # forces were in balance
        turns = self.turns_back_at
        return (
            f"No equilibrium was found beyond load factor {self.last_load:.6g}: the smallest step, "
            f"of {self.step:.3g} to {self.load:.6g}, failed because {self.reason}. "
            + (f"Forces are farthest from balance in the {where}. " if where else "")
            + (f"The load seems to turn back at {turns:.6g}. " if turns is not None else "")
            + f"Every state up to {self.last_load:.6g} is saved. Try {self.advice}."
        )

    def as_dict(self) -> dict[str, object]:
        """For a file."""
        report = asdict(self)
        del report["sentence"]  # it is part of the message
        diagnosis = report.pop("diagnosis")
        return {**report, "cause": self.cause.value, **diagnosis}
