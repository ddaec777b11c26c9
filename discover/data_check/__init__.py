"""Judging a campaign before anything is fitted: the records, and what their plan can tell."""

from discover.data_check.check import check_campaign
from discover.data_check.result import DataCheck, Inseparable

__all__ = ["DataCheck", "Inseparable", "check_campaign"]
