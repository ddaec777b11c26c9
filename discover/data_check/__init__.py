"""Judging a campaign before anything is fitted: the records, and what their plan can tell."""

from discover.data_check.check import check_campaign
from discover.data_check.nominal import TELLING
from discover.data_check.result import (
    AddedTest,
    Conditioning,
    DataCheck,
    ExpectedGap,
    Inseparable,
    Pair,
)

__all__ = [
    "TELLING",
    "AddedTest",
    "Conditioning",
    "DataCheck",
    "ExpectedGap",
    "Inseparable",
    "Pair",
    "check_campaign",
]
