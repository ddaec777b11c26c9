"""Reading campaigns: the only part that opens files, and the edge where units become SI."""

from discover.readers.campaign import CAMPAIGN_FILE, read_campaign
from discover.readers.draft import Answers, Draft, draft_campaign, record_files

__all__ = ["CAMPAIGN_FILE", "Answers", "Draft", "draft_campaign", "read_campaign", "record_files"]
