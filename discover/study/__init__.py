"""Studies: bands, a structure for each, the boundary, the Dean check."""

from discover.study.options import StudyOptions
from discover.study.result import Study, StudyBand, StudyBoundary, TermEstimate
from discover.study.run import run_study
from discover.study.stored import load_study

__all__ = [
    "Study",
    "StudyBand",
    "StudyBoundary",
    "StudyOptions",
    "TermEstimate",
    "load_study",
    "run_study",
]
