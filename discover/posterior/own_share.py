"""How much of what records seem to say, where a model misses more than noise, they really say."""

from __future__ import annotations

import numpy as np

from discover.posterior.assess import Assessed


def own_share(assessed: Assessed) -> float:
    """Return the share of the lines of records that say something of their own, 0 to 1.

    Where a misfit shows in M lines of a record, of which a share R is no noise and common to them,
    it is 1 / (1 + (M - 1) R): what a sample of clusters is worth (L. Kish, *Survey Sampling*,
    1965).
    """
    left = (assessed.assessor.space.sheet.target - assessed.local.force) ** 2
    whole = left.sum(axis=1)
    common = max(1.0 - _lines(assessed) / max(float(whole.sum()), 1e-300), 0.0)
    shown = whole**2 / np.maximum(np.sum(left**2, axis=1), 1e-300)
    return 1.0 / (1.0 + (float(np.mean(shown)) - 1.0) * common)


def own_lines(assessed: Assessed, parts: int) -> float:
    """Return the number of lines that say something of their own, in the mean of so many parts."""
    return own_share(assessed) * _lines(assessed) / parts


def _lines(assessed: Assessed) -> int:
    """Return the number of lines, of many that models can't tell apart the directions that do."""
    units = assessed.assessor.space.sheet.units
    return sum(u.part.size if u.basis is None else u.basis.shape[1] for u in units)
