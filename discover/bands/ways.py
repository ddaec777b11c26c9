"""The ways to what a device has besides its structure, and which of them is taken.

Bands may stand for what a device has besides, and the other way round; so may the wrong family.
Evidence decides between the ways where one leaves but noise, else prediction.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from discover.bands.extras import searched_with, with_one_more, with_several
from discover.bands.found import Device, Found, held, ids_of
from discover.bands.idle import without_idle
from discover.bands.together import together
from discover.posterior.left_out import is_told_from_noise, predicts_better
from discover.posterior.step import Step
from models.cores import OTHER, family_of

MOST = 4
"""Terms that may join."""


def found(device: Device) -> Found:
    """Return the most probable bands, with what the device has besides.

    Bands may stand for what a device has besides, and the other way round. So what may join is
    looked for with bands, with one band throughout, and beside the other family, until a way is
    found whose terms are all told and leave but noise.
    """
    best = _or_plainer(searched_with(device, (), None))
    if best.quiet:
        return best
    ends, seen = list[Found](), set[tuple[object, ...]]()
    for start in _starts(best):
        if ends and not is_told_from_noise(best.assessed):
            break
        end = _grown(start, seen)
        if end is None:
            continue
        end = _or_plainer(end) if end.quiet else _or_fewer_terms(without_idle(end))
        ends.append(end)
        if len(ends) == 1 or (_names(end) != _names(best) and _is_better(end, best)):
            best = end
        if best.quiet:
            return best
    return replace(best, rivals=tuple(e for e in ends if _names(e) != _names(best)))


def _or_plainer(way: Found) -> Found:
    """Return a way that leaves but noise, or a plainer one with one term more where that is better.

    One band, or structures of fewer terms.
    """
    one = _or_one_band(way)
    return _or_fewer_terms(one) if one.quiet else one


def _or_fewer_terms(way: Found) -> Found:
    """Return a way, or structures of fewer of its terms with one more besides where that is better.

    What a structure's own terms explain may be what a device has besides: friction that falls
    with speed makes a power law of viscous damping.
    """
    fewer = _fewer_terms(way)
    if fewer is None or len(way.joined) == MOST:
        return way
    more = with_one_more(fewer, least=way.value if way.quiet else -np.inf)
    return more if not isinstance(more, Step) and _is_better(more, way) else way


def _fewer_terms(way: Found) -> Found | None:
    """Return a way whose bands each have the best named structure of fewer of its terms.

    None where no band has one.
    """
    chosen = list(way.banded.variants)
    for band, place in enumerate(chosen):
        own, none = set(ids_of(way.variants[place])), (way.variants[place].core, OTHER)
        parts = [
            k for k, v in enumerate(way.variants) if v.core not in none and set(ids_of(v)) < own
        ]
        if parts:
            chosen[band] = max(parts, key=lambda k: float(way.banded.by_variant[band, k]))
    if tuple(chosen) == way.banded.variants:
        return None
    return replace(way, banded=replace(way.banded, variants=tuple(chosen)))


def _or_one_band(way: Found) -> Found:
    """Return a way that leaves but noise, or one band with one term more where that is better.

    As bands may stand for terms, they are weighed against each, and those that join together.
    """
    if not way.quiet or way.banded.bands == 1 or way.device.bands is not None:
        return way
    for one in _one_band(way):
        new = _names(one) - _names(way)
        more = one if new else with_one_more(one, least=way.value)
        if not isinstance(more, Step) and _is_better(more, way):
            return searched_with(way.device, more.joined, more.banded.place, more.assessed)
    return way


def _one_band(way: Found) -> Iterator[Found]:
    """Yield one band throughout: with terms that join together, and as it is."""
    one = _in_one_band(way)
    bare = searched_with(one.device, (), None) if one.joined else one
    several = together(bare)
    if several:
        yield with_several(bare, several)
    yield one


def _of_each_family(way: Found) -> Iterator[Found]:
    """Yield one band throughout with the structure of each family that explains most by itself.

    What a device has besides, a delay say, may be what makes the wrong family more probable, or a
    remainder that stands for all of it.
    """
    one = _in_one_band(way)
    unaided = way.search.unaided(one.banded)
    for family in sorted({family_of(ids_of(v)) for v in one.variants}):
        device = replace(one.device, family=family)
        own = held(device, way.search, unaided)
        if own.variants != one.banded.variants:
            yield replace(one, device=device, banded=own, fewer=(own,))


def _in_one_band(way: Found) -> Found:
    """Return a way whose records are one band throughout."""
    device, banded = replace(way.device, bands=1), way.fewer[0]
    return replace(way, device=device, banded=banded, fewer=(banded,))


def _names(way: Found) -> set[str]:
    """Return the ids of what has joined: beside the same, a way weighs all structures itself."""
    return {j.id for j in way.joined}


def _starts(now: Found) -> Iterator[Found]:
    """Yield what terms join: the bands as they are found, one band, and one of each family."""
    yield now
    if now.device.bands in (None, 1):
        yield from _one_band(now)
        yield from _of_each_family(now)


def _grown(way: Found, seen: set[tuple[object, ...]]) -> Found | None:
    """Return a way with all that may join, its bands searched for anew.

    None where it comes to one band with what another has had there, as `seen` tells.
    """
    path = list[Found]()
    while not way.quiet and len(way.joined) < MOST:
        if _sign(way) in seen:
            return None
        path.append(way)
        more = with_one_more(way)
        if isinstance(more, Step):
            way = replace(way, last=more)
            break
        way = more
    if all(w.banded.bands == 1 for w in path):
        seen.update(_sign(w) for w in path)
    return way


def _sign(way: Found) -> tuple[object, ...]:
    """Return by what a way goes on: its bands, their structures and what has joined."""
    structures = tuple(tuple(ids_of(way.variants[v])) for v in way.banded.variants)
    joined = tuple((j.id, len(j.terms)) for j in way.joined)
    return structures, way.banded.shares.tobytes(), joined


def _is_better(now: Found, was: Found) -> bool:
    """Tell whether a way is better: by evidence where one leaves but noise, else by prediction."""
    if now.quiet or was.quiet:
        return now.value > was.value
    return predicts_better(was.assessed, now.assessed)
