"""Structures whose terms the records tell: none is stated for a term that predicts nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.bands.extras import Found
from discover.posterior.spread import idle


def told(found: Found) -> Found:
    """Return the answer with the most probable structures all of whose terms are told.

    Beside a remainder a structure may be probable for terms that, where terms alone predict, may
    as well be nothing: they stand for a part of the remainder. Structures that have them in a
    band are left out there, one term at a time, as those that are alike hide each other. Where no
    more than noise is left, evidence has weighed this already.
    """
    while not found.banded.quiet:
        banded = found.banded
        doubtful = idle(found.assessed.predicting)
        by_variant = banded.by_variant.copy()
        first = 0
        for band, place in enumerate(banded.variants):
            own = [t.id for p in found.variants[place].parts for t in p.terms]
            worst = [own[k - first] for k in doubtful if first <= k < first + len(own)][:1]
            first += len(own)
            held = np.array([
                bool(set(worst) & {p.id for p in variant.parts}) for variant in found.variants
            ])
            if np.any(np.isfinite(by_variant[band, ~held])):  # else nothing may take its place
                by_variant[band, held] = -np.inf
        if np.array_equal(by_variant, banded.by_variant):
            break
        variants = tuple(found.search.of_best_core(values) for values in by_variant)
        found = replace(found, banded=replace(banded, by_variant=by_variant, variants=variants))
    return found
