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
    friction: Sequence[FittedTerm],
    joined: Sequence[FittedTerm],
    before: Composite | None = None,
) -> Composite:
    """Return each band's best variant in its units, and what all bands share.

    A fit of it starts from the coefficients that the same terms had `before`: of one, a joint's
    motion is not that of the device.

    Parameters
    ----------
    banded : Banded
        The division.
    variants : sequence of Variant
        That its places stand for.
    friction : sequence of FittedTerm
        That all bands share: one, or none.
    joined : sequence of FittedTerm
        What else the device has.
    before : Composite, optional
        A model of the device with less.
    """
    known = {} if before is None else {p.fitted.id: p.fitted.coefficient for p in before.terms}

    def begun(term: FittedTerm) -> FittedTerm:
        return FittedTerm(term.id, known.get(term.id) or term.coefficient, term.shape)

    placed = []
    for band, place in enumerate(banded.variants):
        share = None if banded.bands == 1 else tuple(float(s) for s in banded.shares[band])
        for part in variants[place].parts:
            placed += [Placed(begun(t), share) for t in part.terms]
    return Composite((*placed, *map(Placed, joined), *(Placed(begun(t)) for t in friction)))
