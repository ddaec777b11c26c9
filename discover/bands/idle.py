"""Structures whose terms may as well be nothing are left out where more than noise is left."""

from __future__ import annotations

import numpy as np

from discover.bands.found import Found, ids_of
from discover.posterior.spread import idle


def without_idle(found: Found) -> Found:
    """Return the answer with the most probable structures all of whose terms are told.

    Beside a remainder a structure may be probable for terms that, where terms alone predict, may
    as well be nothing: they stand for a part of the remainder. Structures that have them in a
    band are left out there, one term at a time, as those that are alike hide each other.
    """
    while True:
        banded = found.banded
        doubtful = idle(found.assessed.predicting)
        by_variant = banded.by_variant.copy()
        first = 0
        for band, place in enumerate(banded.variants):
            own = ids_of(found.variants[place])
            worst = [own[k - first] for k in doubtful if first <= k < first + len(own)][:1]
            first += len(own)
            held = np.array([
                bool(set(worst) & {p.id for p in variant.parts}) for variant in found.variants
            ])
            if np.any(np.isfinite(by_variant[band, ~held])):  # else nothing may take its place
                by_variant[band, held] = -np.inf
        if np.array_equal(by_variant, banded.by_variant):
            return found
        found = found.with_values(by_variant)
