"""A division into bands as one model to fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from discover.bands.search import Banded, BandSearch
from discover.posterior.evidence import solved
from discover.posterior.metric import Comparison
from discover.posterior.model import Composite, Placed
from discover.posterior.space import Part, begun
from models.checks import Array
from models.constitutive import FittedTerm


def composite_of(
    search: BandSearch, banded: Banded, joined: Sequence[FittedTerm]
) -> Composite:
    """Return each band's best variant in its units, and what all bands share.

    A fit starts where the search found it: behind a joint that yields, coefficients far from that
    would move it otherwise.

    Parameters
    ----------
    search : BandSearch
        That found the division.
    banded : Banded
        The division.
    joined : sequence of FittedTerm
        What the device has besides.
    """
    found = coefficients(search, banded)
    terms = [
        [Placed(begun(t, value), share) for t, value in zip(part.terms, values, strict=False)]
        for part, share, values in found
    ]
    own = len(terms) - int(search.friction is not None)
    shared = [t[0] for t in terms[own:]]
    return Composite((*chain(*terms[:own]), *map(Placed, joined), *shared))


def as_it_was(model: Composite, before: Composite) -> Composite:
    """Return a model with the values that terms had in one fitted before, and no more.

    Of terms alike, as those of several bands, the order counts, and the last stands for those that
    are more. A term that the other had not begins at next to nothing.
    """
    known: dict[str, list[FittedTerm]] = {}
    for placed in before.terms:
        known.setdefault(placed.fitted.id, []).append(placed.fitted)
    terms = []
    for placed in model.terms:
        own = known.get(placed.fitted.id)
        if own is None:
            there = begun(placed.fitted, 0.0)
        else:
            there = own.pop(0) if len(own) > 1 else own[0]
        terms.append(replace(placed, fitted=there))
    return Composite(tuple(terms))


def coefficients(
    search: BandSearch, banded: Banded
) -> list[tuple[Part, tuple[float, ...] | None, Array]]:
    """Return each band's best parts, then friction: share in units, most probable coefficients.

    Signs aside; of a part's terms first, then of its slopes.
    """
    placed: list[tuple[Part, tuple[float, ...] | None]] = []
    for band, place in enumerate(banded.variants):
        share = None if banded.bands == 1 else tuple(float(s) for s in banded.shares[band])
        placed += [(part, share) for part in search.variants[place].parts]
    if search.friction is not None:
        placed.append((search.friction, None))
    if not placed:
        return []
    space, ones = search.space, np.ones(len(search.space.sheet.units))
    parts = [*placed, *((part, None) for part in search.extras)]
    columns = [
        space.columns[:, part.columns] * (ones if share is None else np.array(share))[:, None, None]
        for part, share in parts
    ]
    spread = np.concatenate([part.scales[0] * part.spread for part, _ in parts])
    whole = np.concatenate([*columns, space.sheet.target[:, None]], axis=1)
    gram = Comparison(space, whole, None).at(banded.place.sizes(space.own_unit)).gram[0]
    mean = solved(gram[:-1, :-1], gram[:-1, -1], spread, np.zeros(spread.size), 0.0).mean
    ends = np.cumsum([part.columns.size for part, _ in parts])
    values = np.split(mean, ends[:-1])
    return [(part, share, own) for (part, share), own in zip(placed, values, strict=False)]
