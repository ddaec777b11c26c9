"""Studies, models and campaigns side by side: structures, coefficients, errors on records."""

from discover.compare.differences import Difference, differences, homogeneous
from discover.compare.document import comparison_document
from discover.compare.side import Side, side_of_gap, side_of_model, side_of_study

__all__ = [
    "Difference",
    "Side",
    "comparison_document",
    "differences",
    "homogeneous",
    "side_of_gap",
    "side_of_model",
    "side_of_study",
]
