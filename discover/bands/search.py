"""The search for bands: from one band on, divided again as long as that is more probable."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from scipy.special import logsumexp

from discover.bands.divisions import (
    Brackets,
    Cut,
    Divisions,
    divided_again,
    finer,
    undivided,
)
from discover.bands.variants import as_choice
from discover.posterior.assess import is_quiet
from discover.posterior.climb import Place, climb
from discover.posterior.space import Part, Space
from discover.posterior.structures import (
    Choice,
    Divided,
    Variant,
    as_started,
    divided,
    sums_of_many,
    sums_of_one,
)
from models.checks import Array, Indices

MOST_BANDS = 5  # that a campaign is divided into
_ROUNDS = 4  # of dividing and climbing
_LOG_2 = float(np.log(2.0))  # nats: what a further band costs, for each band that is there
_CLOSE = 0.01  # of a coordinate's logarithm, below which gradual divisions are one


@dataclass(frozen=True)
class Banded:
    """A number of bands, where they end and what holds in each."""

    cut: Cut
    """The last one."""
    shares: Array
    """(B, U) how much of each unit is in each band."""
    brackets: Brackets
    """(B - 1)."""
    variants: tuple[int, ...]
    """(B,) places of the best ones."""
    by_variant: Array
    """(B, V) log evidence of each variant of a band beside the others' best, nats."""
    value: float
    """Log evidence with priors, nats, summed over sizes and over where the last boundary lies."""
    place: Place
    """Sizes of what is not explained, most probable ones."""
    scale: int
    """Place of the scale of friction's curve."""
    quiet: bool
    """True where all but noise may be explained."""
    at_place: float
    """Log evidence at these sizes and this scale, nats."""
    others: float
    """Nats: log evidence of all divisions, with their priors, over this one's without."""

    @property
    def coordinate(self) -> str:
        """Along which they lie; "" for one band."""
        return self.cut.coordinate

    @property
    def gradual(self) -> bool:
        """True where the last boundary is."""
        return self.cut.width > 0.0

    @property
    def bands(self) -> int:
        """Number of bands."""
        return int(self.shares.shape[0])


@dataclass(frozen=True)
class Way:
    """The best of many divisions, at some sizes."""

    cut: Cut
    """Its last one."""
    shares: Array
    """(B, U)."""
    brackets: Brackets
    """(B - 1)."""
    variants: Indices
    """(B,) of each band."""
    others: float
    """Nats: log evidence of all divisions, with their priors, over this one's without."""


@dataclass
class BandSearch:
    """What bands are searched for with."""

    space: Space
    """Of the records."""
    variants: tuple[Variant, ...]
    """That a band may have."""
    friction: Part | None
    """Shared by all bands; None where no model has it."""
    extras: tuple[Part, ...]
    """What else all bands share."""
    coordinates: Mapping[str, Array]
    """(U,) values of each coordinate along which bands may lie."""
    choice: Choice = field(init=False)
    columns: Indices = field(init=False)

    def __post_init__(self) -> None:
        """Set the variants side by side."""
        self.choice, self.columns = as_choice(self.variants)

    @property
    def common(self) -> tuple[Part, ...]:
        """What all bands share."""
        return (*(() if self.friction is None else (self.friction,)), *self.extras)

    def scales(self) -> Array:
        """Return the scales (S, P) of what all bands share: friction's curve has several."""
        own = [p.scales[0] for p in self.extras]
        if self.friction is None:
            return np.array([own]).reshape(1, len(own))
        return np.array([[s, *own] for s in self.friction.scales])

    def one(
        self, place: Place, shares: Array, start: Indices, *, others: bool = True,
        power: float = 1.0,
    ) -> tuple[float, int, Divided]:
        """Return a division's log evidence at sizes, the place of the best scale, its answer.

        Without `others` each band has the variant that it starts with, and no other. The
        likelihood is taken to a power.
        """
        here = self.space.given(place.sizes(self.space.own_unit))
        sums = sums_of_one(here, self.columns, self.common, self.scales(), shares, power)
        answers = [
            divided(s, self.choice, start[None]) if others else as_started(s, self.choice, start)
            for s in sums
        ]
        values = np.array([float(a.value[0]) for a in answers])
        best = int(values.argmax())
        return float(logsumexp(values)) - float(np.log(values.size)), best, answers[best]

    def many(self, place: Place, scale: int, shares: Array, start: Indices) -> Divided:
        """Return divisions (D, B, U) at sizes and at one of the scales."""
        here = self.space.given(place.sizes(self.space.own_unit))
        sums = sums_of_many(here, self.columns, self.common, self.scales()[scale], shares)
        return divided(sums, self.choice, start)

    def only(self, variants: Sequence[int]) -> BandSearch:
        """Return the search with some variants only."""
        return self.with_variants([self.variants[v] for v in variants])

    def with_variants(self, variants: Sequence[Variant]) -> BandSearch:
        """Return the search with other variants."""
        return BandSearch(
            self.space, tuple(variants), self.friction, self.extras, self.coordinates
        )

    def one_band(self, start: Place) -> Banded:
        """Return what holds where all units are one band."""
        whole = undivided(len(self.space.sheet.units))
        return self._banded(whole, None, np.zeros((1, 1), dtype=int), start)

    def unaided(self, now: Banded) -> Banded:
        """Return a division, its structures weighed where nothing is left to a remainder.

        A remainder as large as the force may stand for a whole law, beside which no structure is
        more probable than another.
        """
        start = np.array(now.variants)
        answers = [self.one(place, now.shares, start)[2] for place in now.place.unaided]
        by_variant = max(answers, key=lambda a: float(a.value[0])).by_variant[0]
        variants = tuple(self.of_best_core(own) for own in by_variant)
        return replace(now, by_variant=by_variant, variants=variants)

    def divided_again(self, now: Banded, *, asked: bool) -> Banded | None:
        """Return the best division with one band more; a gradual one only if it leaves but noise.

        None where there are too few units, or where it is not asked for and can't be more probable.
        """
        ways = divided_again(now.shares, now.brackets, self._along(now))
        if ways is None:
            return None
        start = np.array(
            [[*now.variants[: c.band + 1], *now.variants[c.band :]] for c in ways.cuts]
        )
        ways = replace(ways, log_prior=ways.log_prior - now.bands * _LOG_2)
        if now.quiet and not asked:
            answer = self.many(now.place, now.scale, ways.shares, start)
            most = now.value + float(logsumexp(answer.value + ways.log_prior)) - now.at_place
            if most < now.value:  # nothing is left that one more band could explain
                return None
        found = self._banded(ways, now, start, now.place)
        if found.quiet or not found.gradual:
            return found
        # What changes smoothly along a coordinate may be an error of any kind, as the remainder is.
        kept = [i for i, cut in enumerate(ways.cuts) if not cut.width]
        return self._banded(ways.only(kept), now, start[kept], now.place) if kept else None

    def _along(self, now: Banded) -> Mapping[str, Array]:
        """Return the coordinates along which a division may have one band more."""
        return {
            name: values for name, values in self.coordinates.items()
            if now.coordinate in ("", name)
        }

    def again(self, now: Banded) -> Banded:
        """Return a division with its structures as they are in this search, its sizes climbed."""
        way = Way(now.cut, now.shares, now.brackets, np.array(now.variants), now.others)
        known, place = self._climbed(way, now.place)
        return self._stated(way, known, place)

    def _banded(
        self, ways: Divisions, now: Banded | None, start: Indices, place: Place
    ) -> Banded:
        """Return the best of ways to divide what there is now, its sizes climbed."""
        scale = self.one(place, ways.shares[0], start[0])[1]
        best = Way(ways.cuts[0], ways.shares[0], ways.brackets[0], start[0], 0.0)
        known: dict[Place, tuple[float, int, Divided]] = {}
        for _ in range(_ROUNDS):
            if now is not None:
                best = self._best(ways, now, start, place, scale)
            known, there = self._climbed(best, place)
            scale = known[there][1]
            if there == place:
                break
            place = there
        return self._stated(best, known, place)

    def _climbed(
        self, way: Way, place: Place
    ) -> tuple[dict[Place, tuple[float, int, Divided]], Place]:
        """Return a way's answers at the sizes that were looked at, and the most probable sizes."""
        known: dict[Place, tuple[float, int, Divided]] = {}
        return known, climb(partial(self._seen, way, known), place)

    def _stated(
        self, way: Way, known: dict[Place, tuple[float, int, Divided]], place: Place
    ) -> Banded:
        """Return a way with all variants in each band, at the most probable sizes."""
        self._seen(way, known, self.space.quiet)
        last = self.one(place, way.shares, way.variants)[2]
        best = known[place][0]
        total = float(logsumexp([v for v, _, _ in known.values()])) - best
        total += float(last.value[0]) if way.shares.shape[0] > 1 else best
        return Banded(
            cut=way.cut,
            shares=way.shares,
            brackets=way.brackets,
            variants=tuple(self.of_best_core(own) for own in last.by_variant[0]),
            by_variant=last.by_variant[0],
            value=total + way.others,
            place=place,
            scale=known[place][1],
            quiet=is_quiet({p: v for p, (v, _, _) in known.items()}),
            at_place=float(last.value[0]),
            others=way.others,
        )

    def _best(
        self, ways: Divisions, now: Banded, start: Indices, place: Place, scale: int
    ) -> Way:
        """Return the best way at some sizes; of gradual ones the best place and width."""
        answer = self.many(place, scale, ways.shares, start)
        weighed = answer.value + ways.log_prior
        k = int(weighed.argmax())
        rest = np.delete(weighed, k)
        cut, shares, brackets = ways.cuts[k], ways.shares[k], ways.brackets[k]
        value, best, chosen = answer.value[k], weighed[k], answer.best[k]
        for _ in range(_ROUNDS if cut.width else 0):
            prior, cut = ways.log_prior[k], replace(cut, steps=ways.cuts[k].steps)
            few = self.only(chosen)
            while cut.steps[0] > _CLOSE:
                near = finer(cut, now.shares, now.brackets, self._along(now))
                begun = np.tile(np.arange(chosen.size), (len(near.cuts), 1))
                values = few.many(place, scale, near.shares, begun).value
                around = values + near.log_prior + prior
                i, best = int(around.argmax()), logsumexp(around)
                value, prior = values[i], prior + near.log_prior[i]
                cut, shares, brackets = near.cuts[i], near.shares[i], near.brackets[i]
            before = chosen  # the best variants depend on where the change is, and it on them
            chosen = self.many(place, scale, shares[None], chosen[None]).best[0]
            if np.array_equal(before, chosen):
                break
        others = float(logsumexp([best, *rest]) - value)
        return Way(cut, shares, brackets, chosen, others)

    def of_best_core(self, by_variant: Array) -> int:
        """Return the best variant of the most probable core."""
        cores = np.array([v.core for v in self.variants])
        total = {core: logsumexp(by_variant[cores == core]) for core in dict.fromkeys(cores)}
        best = max(total, key=lambda core: total[core])
        return int(np.argmax(np.where(cores == best, by_variant, -np.inf)))

    def _seen(
        self, way: Way, known: dict[Place, tuple[float, int, Divided]], place: Place
    ) -> float:
        if place not in known:
            one_band = way.shares.shape[0] == 1
            known[place] = self.one(place, way.shares, way.variants, others=one_band)
        return known[place][0]
