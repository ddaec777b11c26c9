"""Values of a campaign: records as measured, limits of the rig, what was found on reading."""

from discover.records.campaign import Campaign, CarriedSystem, RigLimits, checked_campaign
from discover.records.finding import Finding
from discover.records.record import EVEN, GAP, LongRecord, Piece, Record, on_grid

__all__ = [
    "EVEN",
    "GAP",
    "Campaign",
    "CarriedSystem",
    "Finding",
    "LongRecord",
    "Piece",
    "Record",
    "RigLimits",
    "checked_campaign",
    "on_grid",
]
