"""The missing effect: where model and measurement disagree, its name, the mended model."""

from discover.gap.baseline import Baseline, prepare_baseline, term_ids
from discover.gap.fractional import FRACTIONAL
from discover.gap.result import Gap, NamedEffect, RecordGap
from discover.gap.run import close_gap
from discover.gap.verdict import CLOSED

__all__ = [
    "CLOSED",
    "FRACTIONAL",
    "Baseline",
    "Gap",
    "NamedEffect",
    "RecordGap",
    "close_gap",
    "prepare_baseline",
    "term_ids",
]
