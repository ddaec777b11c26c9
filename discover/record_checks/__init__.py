"""Judging records before anything is fitted: kind, noise floors, signs, copies."""

from discover.record_checks.apparent import Apparent, apparent
from discover.record_checks.check import (
    CampaignCheck,
    RecordCheck,
    check_record,
    check_records,
    data_errors,
)
from discover.record_checks.noise import noise_floor

__all__ = [
    "Apparent",
    "CampaignCheck",
    "RecordCheck",
    "apparent",
    "check_record",
    "check_records",
    "data_errors",
    "noise_floor",
]
