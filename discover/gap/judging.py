"""What speaks for a further effect: the gap in N, the records that agree, those left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.gap.accuracy import pooled
from discover.gap.stages import Stage, seen_alike, seen_gap
from discover.naming.contest import Contest
from discover.naming.fit import ModelFit, misfits
from discover.naming.rows import RecordRows
from models.checks import Array

_NOTICED = 0.005  # of the gap, that an effect has to close
_CLEARLY = 0.1  # of the mean square relative gap
_WORSE = 0.02  # of the gap of records that are left out, that an effect may add to it
_BEYOND = 1.5  # times the noise floor, from which a gap is more than noise
_SEVERAL = 4  # records, of which one that stands out may have more noise than was found
_OF_OTHERS = 60.0  # of chi-square, that an effect has to explain in the others then


def helps(rows: Sequence[RecordRows], before: Stage, after: Stage) -> bool:
    """Tell whether the gap falls: pooled in N, or clearly with every record counting alike.

    Where more than one effect is missing, the first may close the quiet records' gaps at the cost
    of the loud ones'.
    """
    if seen_gap(rows, after) <= (1.0 - _NOTICED) * seen_gap(rows, before):
        return True
    was, now = (seen_alike(rows, at) ** 2 for at in (before, after))
    return now < (1.0 - _CLEARLY) * was


def predicts(rows: Sequence[RecordRows], before: Stage, after: Stage) -> bool:
    """Tell whether records that are left out in turn are not predicted worse; those held out judge.

    What a further effect explains of the records that it is fitted to may be their own.
    """
    if any(r.observation.held_out for r in rows) or not before.unseen:
        return True
    if pooled(after.unseen) <= (1.0 + _WORSE) * pooled(before.unseen):
        return True
    # One record alone may show an earlier effect: left out, only chance predicts it.
    was, now = (np.log([max(m.percent, 1e-9) for m in at.unseen]) for at in (before, after))
    return bool(np.mean(now - was) < np.log1p(-_CLEARLY))


def shows(
    rows: Sequence[RecordRows], fitted: Sequence[RecordRows], before: Stage, after: Stage
) -> bool:
    """Tell whether records agree that an effect is there, however little of the gap it makes."""
    gained = misfits(fitted, before.fit) - misfits(fitted, after.fit)
    risen = seen_gap(rows, after) > (1.0 + _NOTICED) * seen_gap(rows, before)
    return _by_several(gained) and not risen


def _by_several(gained: Array) -> bool:
    """Tell whether chi-square that records gain is no single record's."""
    return gained.size >= _SEVERAL and float(gained.sum() - gained.max()) >= _OF_OTHERS


def beyond(rows: Sequence[RecordRows], at: Stage) -> bool:
    """Tell whether some record's gap is more than noise."""
    return any(
        m.percent > _BEYOND * m.noise_percent
        for r, m in zip(rows, at.misfits, strict=True)
        if not r.observation.held_out
    )


def one_stands_out(
    fitted: Sequence[RecordRows], at: Stage, contest: Contest, fits: Mapping[str, ModelFit]
) -> bool:
    """Tell whether one record has all misfit beyond the noise, which no name has in others too."""
    if len(fitted) < _SEVERAL:
        return False
    before = misfits(fitted, at.fit)
    above = before - np.array([r.target.size for r in fitted])
    if contest.excess >= float(above.max()):
        return False
    named = fits.get(contest.ranked[0][0])
    if named is None:
        return True
    return not _by_several(before - misfits(fitted, named))
