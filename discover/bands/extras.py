"""What a device has beyond its structure, found beside the bands and not after them.

A spring or a friction that depends on place, left out, would turn into a boundary. So terms of the
catalogue join the model with one band as well as that with several, and bands are searched for anew
with what has joined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.bands.as_fitted import as_fitted
from discover.bands.dividing import searched
from discover.bands.found import Device, Found, Joined, held, ids_of
from discover.bands.search import BandSearch
from discover.bands.variants import variants_of
from discover.posterior.assess import Assessed
from discover.posterior.climb import Place
from discover.posterior.grow import chosen_again, grown, weighed
from discover.posterior.left_out import is_needed, predicts_better
from discover.posterior.setup import space_of
from discover.posterior.space import Part, Space, parts_of
from discover.posterior.spread import is_told
from discover.posterior.step import Candidate, Step
from discover.posterior.structures import Variant
from discover.rows import RecordRows, force_rows
from discover.rows.columns import Behind
from models.checks import Array
from models.constitutive import FittedTerm
from models.cores import TELLING


def searched_with(
    device: Device, joined: Sequence[Joined], place: Place | None, behind: Assessed | None = None
) -> Found:
    """Return the bands with what has joined: as it is in the model behind, where there is one."""
    if behind is not None:
        joined = [_as_fitted(j, behind) for j in joined]
    space, curve, parts = _space(device, joined, behind)
    variants = _beside(variants_of(space, device.cores, device.grids), device, joined)
    units = space.sheet.units
    values = {
        "speed": np.array([u.speed for u in units]),
        "frequency": np.array([u.frequency for u in units]),
    }
    search = BandSearch(
        space, tuple(variants), curve if device.with_friction else None, tuple(parts),
        {name: values[name] for name in device.coordinates},
    )
    search, found = searched(search, place, bands=device.bands)
    bands = [held(device, search, b) for b in found]
    space.forget()
    before = None if behind is None else behind.model
    way = Found(device, bands[-1], tuple(bands), search, tuple(joined), None, before)
    return as_fitted(_chosen(way if device.bands is None else replace(way, fewer=way.fewer[-1:])))


def _as_fitted(joined: Joined, behind: Assessed) -> Joined:
    """Return what has joined with the values that a model has for it."""
    own = tuple(p.fitted for p in behind.model.terms if p.fitted.id == joined.id)
    return replace(joined, terms=own) if len(own) == len(joined.terms) else joined


def _chosen(way: Found) -> Found:
    """Return the way with the most probable number of bands.

    Where more than noise is left, more bands have to predict records left out better.
    """
    best = replace(way, banded=max(way.fewer, key=lambda b: b.value))
    if best.banded.bands == 1 or best.quiet:
        return best
    best, *others = (replace(way, banded=b) for b in way.fewer)
    for more in others:
        if predicts_better(best.assessed, more.assessed):
            best = more
    return best


def _space(
    device: Device, joined: Sequence[Joined], behind: Assessed | None
) -> tuple[Space, Part, list[Part]]:
    """Return the space of models beside what has joined, friction, and the parts of the latter."""
    terms = [t for j in joined for t in j.terms]
    if behind is None or all(t.term.acts == "force" for t in terms):
        space, curve = space_of(device.rows, device.friction)
        return space, curve, parts_of(space, [j.terms for j in joined])
    changed = device.assessor.evaluator.behind(behind.model)
    targets = _targets(device.rows, changed)
    space, curve = space_of(
        device.rows, device.friction, columns_of=changed, targets=targets
    )
    return space, curve, parts_of(space, [j.terms for j in joined])


def _targets(rows: Sequence[RecordRows], changed: Behind) -> list[Array]:
    """Return what columns times whole coefficients shall make of each record's force."""
    result = []
    for r in rows:
        model = changed.models[r.file]
        whole = changed(r, model.terms)  # a step of each as far as its column takes it
        result.append(r.target - force_rows(r, model) + whole.sum(axis=0))
    return result


def with_one_more(way: Found, *, least: float = -np.inf) -> Found | Step:
    """Return the bands with the term that makes the records most probable, or why there is none.

    With `least`, log evidence (nats) that is to be reached, terms that can't are not fitted.
    """
    now = way.assessed
    step = _that_predict(now, grown(way.device.assessor, now, _open(way), least=least))
    while step.best.id and step.best.assessed is not None:
        more = _joined(way, step)
        # What was chosen beside other bands is chosen again beside these.
        more = _settled(more, step.best.id if _cores(more) == _cores(way) else "")
        if any(j.id == step.best.id for j in more.joined):
            return more
        step = _that_predict(now, step.without([step.best.id]))
    return step


def _cores(way: Found) -> list[str]:
    return [way.variants[v].core for v in way.banded.variants]


def _open(way: Found) -> list[str]:
    """Return the ids of what may join; of structures' terms what each band's may have beside."""
    chosen = [way.variants[v] for v in way.banded.variants]
    there = {j.id for j in way.joined}.union(*(ids_of(v) for v in chosen))
    held = [set(c.beside) for c in way.device.cores if c.name in _cores(way)]
    return [
        i for i in way.device.extras
        if i not in there and (i not in TELLING or all(i in beside for beside in held))
    ]


def _beside(variants: Sequence[Variant], device: Device, joined: Sequence[Joined]) -> list[Variant]:
    """Return structures, those ruled out that hold or become others with what has joined."""
    there = {j.id for j in joined}
    possible = {c.name for c in device.cores if there & TELLING <= set(c.beside)}
    return [
        v if v.core in possible and there.isdisjoint(ids_of(v)) else replace(v, log_prior=-np.inf)
        for v in variants
    ]


def _joined(way: Found, step: Step) -> Found:
    """Return the bands with the best of what may join."""
    best = step.best
    if best.assessed is None:
        raise ValueError("what joins is fitted")
    terms = best.assessed.model.terms
    new = Joined(tuple(terms[i].fitted for i in best.places), best.log_prior, step)
    return searched_with(way.device, (*way.joined, new), best.assessed.place, best.assessed)


def with_several(way: Found, terms: Sequence[tuple[FittedTerm, float]]) -> Found:
    """Return the bands with terms that join at once, of which each is needed beside the others.

    Parameters
    ----------
    way : Found
        Without them.
    terms : sequence of (FittedTerm, float)
        What joins, and its log prior, nats.
    """
    joined = [Joined((t,), prior, Step(())) for t, prior in terms]
    found = _needed(searched_with(way.device, (*way.joined, *joined), way.banded.place))
    return _needed(_settled(found, "")) if len(found.joined) > 1 else found


def _needed(way: Found) -> Found:
    """Return the bands without what has joined and need not; the rest is weighed against nothing.

    Unless it has been weighed already.
    """
    for identifier in [j.id for j in way.joined]:
        now, joined = way.assessed, next(j for j in way.joined if j.id == identifier)
        own, less = _less(way, joined)
        if not (is_told(now, own) and is_needed(less, now)):
            way = _left_with(way, joined, less)
        elif not joined.step.candidates:
            here = Candidate(joined.id, now.value + joined.log_prior, now, len(own))
            step = weighed((here, Candidate("", less.value, less)), less, way.device.seed)
            new = replace(joined, step=step)
            way = replace(way, joined=tuple(new if j is joined else j for j in way.joined))
    return way


def _settled(way: Found, newest: str) -> Found:
    """Return the bands without what has joined and need not, and all but the newest chosen again.

    Beside what joined later: an offset of every test's own may have joined for what another term
    explains since, and a sensor's drift where an offset is enough now.
    """
    for identifier in [j.id for j in way.joined]:
        now, joined = way.assessed, next(j for j in way.joined if j.id == identifier)
        own, less = _less(way, joined)
        if not (is_told(now, own) and is_needed(less, now)):
            way = _left_with(way, joined, less)
        elif identifier != newest:
            way = _chosen_again(way, joined, less)
    return way


def _chosen_again(way: Found, joined: Joined, less: Assessed) -> Found:
    """Return the bands with something that has joined, chosen again beside all the rest.

    In another shape, or as a term that it may be mistaken for.
    """
    own, prior, now = joined.terms, joined.log_prior, way.assessed
    open_ids = _open(way)
    others = [i for i in own[0].term.mistaken_for if i in open_ids]
    among = len(open_ids) + 1
    best = chosen_again(way.device.assessor, now, less, own, prior, others, among)
    if not best.id or best.assessed is None:
        return way
    terms = tuple(best.assessed.model.terms[i].fitted for i in best.places)
    step = joined.step
    if best.id != joined.id:
        was = Candidate(joined.id, now.value + prior, now, len(own))
        step = weighed((best, was, Candidate("", less.value, less)), less, way.device.seed)
    new = Joined(terms, best.log_prior, step)
    joined_now = [new if j.id == joined.id else j for j in way.joined]
    return searched_with(way.device, joined_now, best.assessed.place, best.assessed)


def without(way: Found, joined: Joined) -> Found:
    """Return the bands without something that has joined."""
    _, less = _less(way, joined)
    return replace(_left_with(way, joined, less), last=way.last)


def _less(way: Found, joined: Joined) -> tuple[list[int], Assessed]:
    """Return the places of terms that joined, and the model without them."""
    now = way.assessed
    own = [k for k, p in enumerate(now.model.terms) if p.fitted.id == joined.id]
    less = now.model
    for place in reversed(own):
        less = less.without(place)
    return own, way.device.assessor.assess(less, now.place)


def _left_with(way: Found, joined: Joined, less: Assessed) -> Found:
    others = [j for j in way.joined if j.id != joined.id]
    return searched_with(way.device, others, less.place, less)


def _that_predict(now: Assessed, step: Step) -> Step:
    """Return a step without what is more probable but does not predict records left out better.

    Nor may it be a term whose sign the records don't tell.
    """
    while step.best.id and step.best.assessed is not None:
        best = step.best.assessed
        if is_told(best, step.best.places) and predicts_better(now, best):
            break
        step = step.without([step.best.id])
    return step
