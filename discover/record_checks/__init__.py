"""Judging records before anything is fitted: kind, noise, signs, copies."""

from discover.record_checks.apparent import Apparent, apparent
from discover.record_checks.check import (
    CampaignCheck,
    RecordCheck,
    check_record,
    check_records,
    data_errors,
)
from discover.record_checks.loop_work import LoopWork, loop_work

__all__ = [
    "Apparent",
    "CampaignCheck",
    "LoopWork",
    "RecordCheck",
    "apparent",
    "check_record",
    "check_records",
    "data_errors",
    "loop_work",
]
