"""Many campaigns: which they are, their answers as one table, what the fleet has in common."""
