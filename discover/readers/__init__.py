"""Reading campaigns: the only part that opens files, and the edge where units become SI."""

from discover.readers.campaign import read_campaign

__all__ = ["read_campaign"]
