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

from discover.bands.found import Found, held, ids_of, in_family
from discover.posterior.structures import Variant
from models.checks import Array

_MORE = 10.0
"""Nats, by which a linear form may be off before a fit is asked: priors and rounded shapes are
less."""


def as_fitted(found: Found) -> Found:
    """Return the answer with structures weighed as they are when fitted.

    Behind a joint all that may be, else those with slopes that leave but noise. A fit is more
    probable than its grid's linear form, or less, as shapes of friction are rounded too: by as much
    as for the best structure without slopes it may be.
    """
    if any(t.term.simulated for j in found.joined for t in j.terms):
        return _each_fitted(found)
    seen = set[tuple[int, ...]]()
    while found.banded.quiet and found.banded.variants not in seen:
        banded = found.banded
        seen.add(banded.variants)
        shaped = [b for b, k in enumerate(banded.variants) if _has_slopes(found.variants[k])]
        promised = _promised(found) if shaped else 0.0
        if promised <= _MORE:
            return found
        values = banded.by_variant.copy()
        for band in shaped:
            more = promised - _promised(_without_slopes(found, band))
            values[band, banded.variants[band]] -= max(more, 0.0)
        found = _weighed(found, values)
    return found


def _each_fitted(found: Found) -> Found:
    """Return the answer with every band's structures weighed by a fit, those that may be best."""
    seen = set[tuple[int, tuple[str, ...]]]()
    while True:
        values = found.banded.by_variant.copy()
        possible = in_family(found.device, found.search, values)
        likely = possible > possible.max(axis=1, keepdims=True) - _MORE
        structures = [(int(b), tuple(ids_of(found.variants[k]))) for b, k in np.argwhere(likely)]
        one = next((s for s in structures if s not in seen), None)
        if one is None:
            return found
        seen.add(one)
        band, own = one
        alike = [k for k, v in enumerate(found.variants) if tuple(ids_of(v)) == own]
        variants = list(found.banded.variants)
        variants[band] = max(alike, key=lambda k: float(values[band, k]))
        trial = replace(found, banded=replace(found.banded, variants=tuple(variants)))
        values[band, alike] += _fitted_value(trial) - logsumexp(values[band, alike])
        found = _weighed(found, values)


def _weighed(found: Found, values: Array) -> Found:
    """Return the answer with other log evidence (B, V) of its structures, and its own by it."""
    banded = found.banded
    gained = logsumexp(values, axis=1) - logsumexp(banded.by_variant, axis=1)
    found = found.with_values(values)
    banded = replace(found.banded, value=banded.value + float(gained.sum()))
    return replace(found, banded=held(found.device, found.search, banded))


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
    banded, value = found.banded, _fitted_value(found)
    return max(
        float(banded.by_variant[band, place]) - value
        for band, place in enumerate(banded.variants)
    )


def _fitted_value(found: Found) -> float:
    """Return the log evidence of an answer's structures when fitted, with their prior, nats."""
    banded, visited = found.banded, found.assessed.visited
    value = visited.get(banded.place, max(visited.values()))
    return value + sum(_prior(found.variants, place) for place in banded.variants)


def _prior(variants: Sequence[Variant], place: int) -> float:
    """Return the log prior of a structure in all its shapes, nats: a fit has that of a shape."""
    ids = ids_of(variants[place])
    return variants[place].log_prior + float(np.log(sum(ids_of(v) == ids for v in variants)))
