"""Further columns of time, which are not the one that a record is read by."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from discover.readers.columns import find_column, split_header, stated_unit
from discover.readers.names import name_score
from discover.readers.source import Source
from discover.readers.units import measures
from models.checks import InputError, shown


def other_times(source: Source, names: Mapping[str, str]) -> list[str]:
    """Return what to tell of columns that are times too, and others than the record's.

    Each channel may have its own beside it, from clocks that began apart.

    Parameters
    ----------
    source : Source
        The table.
    names : mapping
        Headers by quantity.

    Examples
    --------
    >>> t = np.arange(20) / 100.0
    >>> table = Source("a.csv", ("time [s]", "time B [s]"), lambda ids: [t, t + 0.1][: len(ids)])
    >>> other_times(table, {})
    ["column 'time B [s]' is a time too, but another one: 'time [s]' is taken for all channels"]
    """
    taken = find_column(source, "time", names.get("time", "time"))
    if taken is None:
        return []
    told = []
    for index, header in enumerate(source.headers):
        unit = stated_unit(source, index)
        named = name_score(split_header(header)[0], "time") > 0.0
        if index == taken or not (named and unit is not None and measures(unit, "time")):
            continue
        try:
            own, other = source.read([taken, index])
        except InputError:
            continue
        if (np.diff(other) > 0.0).all() and np.ptp(other - own) + abs(other[0] - own[0]) > 0.0:
            told.append(
                f"column {shown(header)} is a time too, but another one:"
                f" {shown(source.headers[taken])} is taken for all channels"
            )
    return told
