"""Judging records before anything is fitted: kind, noise, signs, copies."""

from discover.record_checks.apparent import Apparent, apparent
from discover.record_checks.asked_once import (
    apparent_of,
    digest_of,
    force_deviation,
    returns,
    turns,
    work_of,
)
from discover.record_checks.check import (
    CampaignCheck,
    RecordCheck,
    check_record,
    check_records,
    data_errors,
    one_direction,
)
from discover.record_checks.loop_work import LoopWork, loop_work
from discover.record_checks.together import Differing, differing_records

__all__ = [
    "Apparent",
    "CampaignCheck",
    "Differing",
    "LoopWork",
    "RecordCheck",
    "apparent",
    "apparent_of",
    "check_record",
    "check_records",
    "data_errors",
    "differing_records",
    "digest_of",
    "force_deviation",
    "loop_work",
    "one_direction",
    "returns",
    "turns",
    "work_of",
]
