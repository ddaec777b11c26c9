"""Every number of bands: divided again as long as that is more probable, shapes put in place.

Shapes are on a grid, with slopes between. What slopes leave of a shape between two places of the
grid would be explained by one band more. So each division's shapes are moved to where it has them
before it is divided again.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.bands.composite import coefficients
from discover.bands.search import MOST_BANDS, Banded, BandSearch
from discover.posterior.climb import Place
from discover.posterior.space import Part, parts_of, unit
from models.checks import Array

_NEAR = 0.1  # of the way between places of the grid, up to which slopes leave next to nothing


def searched(
    search: BandSearch, start: Place | None = None, *, bands: int | None = None
) -> tuple[BandSearch, list[Banded]]:
    """Return the best division for every number of bands, as long as one more is more probable.

    Parameters
    ----------
    search : BandSearch
        Of the records.
    start : Place, optional
        Sizes to start from.
    bands : int, optional
        Number that is asked for; None lets the evidence choose.

    Returns
    -------
    search : BandSearch
        With shapes where the divisions have them.
    found : list of Banded
        By number of bands.
    """
    one = search.one_band(search.space.start if start is None else start)
    search, one = _in_place(search, one)
    found = [one]
    most = MOST_BANDS if bands is None else bands
    while found[-1].bands < most:
        more = search.divided_again(found[-1], asked=bands is not None)
        if more is None:
            break
        search, more = _in_place(search, more)
        found.append(more)
        if bands is None and more.value < found[-2].value:
            break
    return search, found


def _in_place(search: BandSearch, banded: Banded) -> tuple[BandSearch, Banded]:
    """Return a search with a division's shapes where it has them, and the division with these."""
    moved: dict[int, Part] = {}
    for part, _, values in coefficients(search, banded):
        if part.slopes and values[0] != 0.0:
            there = _moved(search, part, values)
            if there is not None:
                moved[id(part)] = there
    if not moved:
        return search, banded
    chosen = set(banded.variants)
    nearer = search.with_variants([
        replace(v, parts=tuple(moved.get(id(p), p) for p in v.parts)) if i in chosen else v
        for i, v in enumerate(search.variants)
    ])  # fmt: skip
    again = nearer.again(banded)
    return (nearer, again) if again.value > banded.value else (search, banded)


def _moved(search: BandSearch, part: Part, values: Array) -> Part | None:
    """Return a part with its shape where its slopes put it; None where that is next to it."""
    (fitted,) = part.terms
    shape = dict(fitted.shape)
    far = False
    for name, slope, (low, high) in zip(part.slopes, values[1:], part.within, strict=True):
        place = float(np.clip(shape[name] + slope / values[0], low, high))
        far = far or abs(place - shape[name]) > _NEAR * (high - low)
        shape[name] = place
    if not far:
        return None
    spread = tuple((n, float(s)) for n, s in zip(part.slopes, part.spread[1:], strict=True))
    (there,) = parts_of(search.space, [(unit(fitted.term, shape),)], [spread])
    return replace(there, within=part.within, log_prior=part.log_prior)
