"""Reading campaigns: the only part that opens files, and the edge where units become SI."""

from discover.readers.campaign import CAMPAIGN_FILE, read_campaign
from discover.readers.draft import Draft, draft_campaign
from discover.readers.draft_tables import Answers, record_files

__all__ = ["CAMPAIGN_FILE", "Answers", "Draft", "draft_campaign", "read_campaign", "record_files"]
