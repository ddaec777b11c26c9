"""Calibration study of structures: exact devices whose friction, plans and noise vary widely.

Nothing here imports the engine, its terms or their formulas: only the values that a campaign is
made of (`discover.records`, `models.device`). Whoever writes the engine must not read this package.
"""
