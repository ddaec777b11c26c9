"""What a device has beyond its structure, found beside the bands and not after them.

A spring or a friction that depends on place, left out, would turn into a boundary. So terms of the
catalogue join the model with one band as well as that with several, bands are searched for anew
with what has joined. Evidence decides between the ways where one leaves but noise, else prediction.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from discover.bands.composite import composite_of
from discover.bands.search import Banded, BandSearch, searched
from discover.bands.variants import Grids, variants_of
from discover.posterior.assess import Assessed, Assessor
from discover.posterior.climb import Place
from discover.posterior.grow import chosen_again, grown
from discover.posterior.left_out import is_needed, is_told_from_noise, predicts_better
from discover.posterior.model import Composite, Evaluator
from discover.posterior.setup import space_of
from discover.posterior.space import Part, Space, parts_of
from discover.posterior.spread import is_told
from discover.posterior.step import Step
from discover.posterior.structures import Variant
from discover.rows import RecordRows, force_rows
from discover.rows.columns import Behind
from models.checks import Array
from models.constitutive import FittedTerm
from models.cores import Core, family_of
from models.terms import Term

MOST = 4
"""Terms that may join."""


@dataclass(frozen=True)
class Joined:
    """A term that has joined."""

    terms: tuple[FittedTerm, ...]
    """One, or several of the same id."""
    log_prior: float
    """Nats."""
    step: Step
    """What else might have joined in its place."""

    @property
    def id(self) -> str:
        """Id of its terms."""
        return self.terms[0].id


@dataclass(frozen=True)
class Device:
    """What a search for bands and for what a device has besides starts from."""

    rows: tuple[RecordRows, ...]
    """Of the records that are fitted."""
    friction: Term
    """That every structure may have."""
    with_friction: bool
    """Whether models hold it."""
    cores: tuple[Core, ...]
    """Structures that a band may have."""
    grids: Grids
    """Bounds of their shapes, where given."""
    extras: tuple[str, ...]
    """Ids of what may join."""
    coordinates: tuple[str, ...]
    """Along which bands may lie: "speed", "frequency"."""
    bands: int | None
    """Number that is asked for; None lets the evidence choose."""
    seed: int = 0
    """Of what is drawn."""
    family: str | None = None
    """Whose best structure what joins is looked for beside; None for any."""

    @cached_property
    def assessor(self) -> Assessor:
        """What assesses models of its records."""
        space, curve = space_of(self.rows, self.friction)
        return Assessor(space, Evaluator(space.sheet, space.scales), curve, seed=self.seed)


@dataclass(frozen=True)
class Found:
    """Bands, what holds in each, and what the device has besides."""

    device: Device
    """That was searched."""
    banded: Banded
    """The most probable division."""
    fewer: tuple[Banded, ...]
    """All that were weighed beside it with the same terms joined, by number of bands."""
    search: BandSearch
    """That found it."""
    joined: tuple[Joined, ...]
    """What the device has besides its structure."""
    last: Step | None
    """What might have joined and did not; None where nothing but noise was left."""
    rivals: tuple[Found, ...] = ()
    """Where other ways ended, with other terms joined, where more than noise is left."""

    @property
    def value(self) -> float:
        """Log evidence with priors, nats."""
        return self.banded.value + sum(j.log_prior for j in self.joined)

    @property
    def variants(self) -> tuple[Variant, ...]:
        """That a band may have."""
        return self.search.variants

    @property
    def model(self) -> Composite:
        """Each band's best variant, friction, and what has joined."""
        shared = [t for j in self.joined for t in j.terms]
        if self.device.with_friction:
            shared.append(FittedTerm(self.device.friction.id, 1.0, {}))
        return composite_of(self.banded, self.variants, shared)

    @property
    def quiet(self) -> bool:
        """True where all but noise may be explained: by the structures on their grid, or fitted."""
        return self.banded.quiet or self.assessed.quiet

    @cached_property
    def assessed(self) -> Assessed:
        """The model, fitted."""
        return self.device.assessor.assess(self.model, self.banded.place)


def found(device: Device) -> Found:
    """Return the most probable bands, with what the device has besides.

    Bands may stand for what a device has besides, and the other way round. So what may join is
    looked for with bands, and with one band throughout.
    """
    best = _searched(device, (), None)
    if best.quiet:
        return best
    ends, seen = list[Found](), set[tuple[object, ...]]()
    for start in _starts(best):
        if ends and not is_told_from_noise(best.assessed):
            break
        end = _grown(start, seen)
        if end is None:
            continue
        ends.append(end)
        if len(ends) == 1 or (_names(end) != _names(best) and _is_better(end, best)):
            best = end
        if best.quiet:
            return best
    return replace(best, rivals=tuple(e for e in ends if _names(e) != _names(best)))


def _names(way: Found) -> set[str]:
    """Return the ids of what has joined: beside the same, a way weighs all structures itself."""
    return {j.id for j in way.joined}


def _starts(now: Found) -> Iterator[Found]:
    """Yield what terms join: the bands as they are found, one band, and one of each other family.

    What a device has besides, a delay say, may be what makes the wrong family more probable.
    """
    yield now
    if now.device.bands in (None, 1):
        device, banded = replace(now.device, bands=1), now.fewer[0]
        one = replace(now, device=device, banded=banded, fewer=(banded,))
        yield one
        for other in sorted({family_of(_ids(v)) for v in one.variants} - {_family(one)}):
            device = replace(one.device, family=other)
            held = _held(device, now.search, banded)
            yield replace(one, device=device, banded=held, fewer=(held,))


def _grown(way: Found, seen: set[tuple[object, ...]]) -> Found | None:
    """Return a way with all that may join, its bands searched for anew.

    None where it comes to one band with what another has had there, as `seen` tells.
    """
    path = list[Found]()
    while not way.quiet and len(way.joined) < MOST:
        if _sign(way) in seen:
            return None
        path.append(way)
        more = _with_one_more(way)
        if isinstance(more, Step):
            way = replace(way, last=more)
            break
        way = more
    if all(w.banded.bands == 1 for w in path):
        seen.update(_sign(w) for w in path)
    return way


def _sign(way: Found) -> tuple[object, ...]:
    """Return by what a way goes on: its bands, what they have and what has joined."""
    joined = tuple((j.id, len(j.terms)) for j in way.joined)
    return way.banded.variants, way.banded.shares.tobytes(), joined


def _is_better(now: Found, was: Found) -> bool:
    """Tell whether a way is better: by evidence where one leaves but noise, else by prediction."""
    if now.quiet or was.quiet:
        return now.value > was.value
    return predicts_better(was.assessed, now.assessed)


def _family(way: Found) -> str:
    """Return the family of the structure in the lowest band."""
    return family_of(_ids(way.variants[way.banded.variants[0]]))


def _ids(variant: Variant) -> list[str]:
    return [t.id for p in variant.parts for t in p.terms]


def _searched(device: Device, joined: Sequence[Joined], place: Place | None,
              behind: Assessed | None = None) -> Found:
    """Return the bands with what has joined."""
    space, curve, parts = _space(device, joined, behind)
    variants = variants_of(space, device.cores, device.grids)
    units = space.sheet.units
    values = {
        "speed": np.array([u.speed for u in units]),
        "frequency": np.array([u.frequency for u in units]),
    }
    search = BandSearch(
        space, variants, curve if device.with_friction else None, tuple(parts),
        {name: values[name] for name in device.coordinates},
    )
    bands = [_held(device, search, b) for b in searched(search, place, bands=device.bands)]
    space.forget()
    way = Found(device, bands[-1], tuple(bands), search, tuple(joined), None)
    return _chosen(way if device.bands is None else replace(way, fewer=way.fewer[-1:]))


def _held(device: Device, search: BandSearch, banded: Banded) -> Banded:
    """Return a division with the best structures of the device's family, where it has one."""
    if device.family is None:
        return banded
    other = [family_of(_ids(v)) != device.family for v in search.variants]
    values = np.where(other, -np.inf, banded.by_variant)
    return replace(banded, variants=tuple(int(v.argmax()) for v in values))


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
    sheet = device.assessor.space.sheet
    changed = Behind(
        behind.model.by_record(sheet), {r.file: i for i, r in enumerate(device.rows)}
    )
    targets = _targets(device.rows, changed)
    space, curve = space_of(
        device.rows, device.friction, columns_of=changed, targets=targets
    )
    return space, curve, parts_of(space, [j.terms for j in joined])


def _targets(rows: Sequence[RecordRows], changed: Behind) -> list[Array]:
    """Return what columns times whole coefficients shall make of each record's force."""
    result = []
    for r in rows:
        model = changed.models[changed.places[r.file]]
        whole = changed(r, model.terms)  # a step of each as far as its column takes it
        result.append(r.target - force_rows(r, model) + whole.sum(axis=0))
    return result


def _with_one_more(way: Found) -> Found | Step:
    """Return the bands with the term that makes the records most probable, or why there is none."""
    now = way.assessed
    there = {j.id for j in way.joined}
    open_ids: Collection[str] = [i for i in way.device.extras if i not in there]
    step = _that_predict(now, grown(way.device.assessor, now, open_ids))
    while step.best.id and step.best.assessed is not None:
        more = _settled(_joined(way, step))
        if any(j.id == step.best.id for j in more.joined):
            return more
        step = _that_predict(now, step.without([step.best.id]))
    return step


def _joined(way: Found, step: Step) -> Found:
    """Return the bands with the best of what may join."""
    best = step.best
    if best.assessed is None:
        raise ValueError("what joins is fitted")
    terms = best.assessed.model.terms
    new = Joined(tuple(terms[i].fitted for i in best.places), best.log_prior, step)
    fitted = {t.fitted.id: t.fitted for t in terms}
    old = [
        replace(j, terms=tuple(fitted.get(t.id, t) for t in j.terms)) if len(j.terms) == 1 else j
        for j in way.joined
    ]
    return _searched(way.device, (*old, new), best.assessed.place, best.assessed)


def _settled(way: Found) -> Found:
    """Return the bands without what has joined and need not, and the rest in its best shape.

    Beside what joined later: an offset of every test's own may have joined for what another term
    explains since.
    """
    newest = way.joined[-1]
    for joined in way.joined:
        now = way.assessed
        own, less = _less(way, joined)
        if not (is_told(now, own) and is_needed(less, now)):
            way = _left_with(way, joined, less)
        elif joined is not newest:
            way = _in_best_shape(way, joined, less)
    return way


def _in_best_shape(way: Found, joined: Joined, less: Assessed) -> Found:
    """Return the bands with something that has joined, chosen again beside all the rest."""
    own, prior = joined.terms, joined.log_prior
    best = chosen_again(way.device.assessor, way.assessed, less, own, prior)
    if not best.id or best.assessed is None:
        return way
    terms = tuple(best.assessed.model.terms[i].fitted for i in best.places)
    others = [replace(j, terms=terms) if j is joined else j for j in way.joined]
    return _searched(way.device, others, best.assessed.place, best.assessed)


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
    others = [j for j in way.joined if j is not joined]
    return _searched(way.device, others, less.place, less)


def _that_predict(now: Assessed, step: Step) -> Step:
    """Return a step without what is more probable but does not predict records left out better.

    Nor may it be a term whose sign the records don't tell.
    """
    refused = []
    for candidate in step.candidates:
        if not candidate.id or candidate.assessed is None:
            break
        told = is_told(candidate.assessed, candidate.places)
        if told and predicts_better(now, candidate.assessed):
            break
        refused.append(candidate.id)
    return step.without(refused)
