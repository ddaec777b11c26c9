"""Structures count with what they are when fitted, where their linear form promises more.

Between places of their grid, shapes are weighed by slopes. A term of next to no size may have a
slope as large as another term's force: no shape of it makes that, and a fit leaves what it made.
Behind a joint, other coefficients move the device otherwise, which no linear form shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.special import logsumexp

from discover.bands.found import Found, ids_of
from discover.posterior.structures import Variant

_MORE = 10.0
"""Nats, by which slopes may promise more than a fit holds: priors and rounded shapes are less."""


def as_fitted(found: Found) -> Found:
    """Return the answer with structures weighed as they are when fitted.

    Behind a joint all of them, else those with slopes that leave but noise. A fit is more probable
    than its grid's linear form, or less, as shapes of friction are rounded too: by as much as for
    the best structure without slopes it may be.
    """
    simulated = any(t.term.simulated for j in found.joined for t in j.terms)
    seen = set[tuple[int, ...]]()
    while (simulated or found.banded.quiet) and found.banded.variants not in seen:
        banded = found.banded
        seen.add(banded.variants)
        bands = [
            b for b, k in enumerate(banded.variants) if simulated or _has_slopes(found.variants[k])
        ]
        promised = _promised(found) if bands else 0.0
        if promised <= _MORE:
            return found
        values, value = banded.by_variant.copy(), banded.value
        for band in bands:
            alike, more = [banded.variants[band]], promised
            if simulated:  # a fit finds the best of its shapes
                own = ids_of(found.variants[alike[0]])
                alike = [k for k, v in enumerate(found.variants) if ids_of(v) == own]
            else:
                more -= _promised(_without_slopes(found, band))
            before = logsumexp(values[band])
            values[band, alike] -= max(more, 0.0)
            value += float(logsumexp(values[band]) - before)
        found = found.with_values(values)
        found = replace(found, banded=replace(found.banded, value=value))
    return found


def _has_slopes(variant: Variant) -> bool:
    return any(p.slopes for p in variant.parts)


def _without_slopes(found: Found, band: int) -> Found:
    """Return the answer with the best structure in a band that is weighed by no slope."""
    plain = [k for k, v in enumerate(found.variants) if not _has_slopes(v)]
    if not plain:
        return found
    best = max(plain, key=lambda k: found.banded.by_variant[band, k])
    variants = list(found.banded.variants)
    variants[band] = best
    return replace(found, banded=replace(found.banded, variants=tuple(variants)))


def _promised(found: Found) -> float:
    """Return by how much an answer's structures are more probable than their fit, nats.

    At the same sizes; where the fit has others, at its most probable ones.
    """
    banded, visited = found.banded, found.assessed.visited
    held = visited.get(banded.place, max(visited.values()))
    held += sum(_prior(found.variants, place) for place in banded.variants)
    return max(
        float(banded.by_variant[band, place]) - held
        for band, place in enumerate(banded.variants)
    )


def _prior(variants: Sequence[Variant], place: int) -> float:
    """Return the log prior of a structure in all its shapes, nats: a fit has that of a shape."""
    ids = ids_of(variants[place])
    return variants[place].log_prior + float(np.log(sum(ids_of(v) == ids for v in variants)))
