"""What accuracy costs: runs of many discretisations, their errors and their time."""

from .study import StudyResult, study, write

__all__ = ["StudyResult", "study", "write"]
