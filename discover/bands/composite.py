"""A division into bands as one model to fit."""

from __future__ import annotations

from collections.abc import Sequence

from discover.bands.search import Banded
from discover.posterior.model import Composite, Placed
from discover.posterior.structures import Variant
from models.constitutive import FittedTerm


def composite_of(
    banded: Banded,
    variants: Sequence[Variant],
    shared: Sequence[FittedTerm],
) -> Composite:
    """Return each band's best variant in its units, and what all bands share.

    Parameters
    ----------
    banded : Banded
        The division.
    variants : sequence of Variant
        That its places stand for.
    shared : sequence of FittedTerm
        Friction, and what else the device has.
    """
    placed = []
    for band, place in enumerate(banded.variants):
        share = None if banded.bands == 1 else tuple(float(s) for s in banded.shares[band])
        for part in variants[place].parts:
            placed += [Placed(t, share) for t in part.terms]
    return Composite((*placed, *(Placed(t) for t in shared)))
