"""Bands with what a device has besides, and what a search for them starts from."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from discover.bands.composite import as_it_was, composite_of
from discover.bands.search import Banded, BandSearch
from discover.bands.variants import Grids
from discover.posterior.assess import Assessed, Assessor
from discover.posterior.model import Composite, Evaluator
from discover.posterior.own_share import own_share
from discover.posterior.setup import space_of
from discover.posterior.step import Step
from discover.posterior.structures import Variant
from discover.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm
from models.cores import Core, family_of
from models.terms import Term


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
    before: Composite | None = None
    """A model fitted beside what has joined, from which the bands were searched."""
    rivals: tuple[Found, ...] = ()
    """Where other ways ended, with other terms joined, where more than noise is left."""
    fits: dict[Hashable, Assessed] = field(default_factory=dict, repr=False, compare=False)
    """Models fitted with what has joined, by division and structures: which is best is asked of
    several in turn."""

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
        return composite_of(self.search, self.banded, [t for j in self.joined for t in j.terms])

    @property
    def quiet(self) -> bool:
        """True where all but noise may be explained: by the structures on their grid, or fitted."""
        return self.banded.quiet or self.assessed.quiet

    @cached_property
    def power(self) -> float:
        """To which likelihoods of structures and places are taken: 1 where but noise may be left.

        Else the share of the lines that say something of their own (a power posterior: Miller and
        Dunson, *J. Am. Stat. Assoc.* 114 (2019) 1113-1125).
        """
        return 1.0 if self.quiet else own_share(self.assessed.predicting)

    @property
    def assessed(self) -> Assessed:
        """The model, fitted from where the search found it, or as its terms were before.

        From the first, one shape of what changes the motion may not be reached from another.
        """
        banded = self.banded
        key = banded.shares.tobytes(), banded.variants, banded.place
        if key not in self.fits:
            model, assessor = self.model, self.device.assessor
            if self.before is not None:
                before = as_it_was(model, self.before)
                model, _ = assessor.nearest([model, before], banded.place)
            self.fits[key] = assessor.assess(model, banded.place)
        return self.fits[key]

    def with_values(self, by_variant: Array) -> Found:
        """Return the same with other log evidence (B, V) of each band's structures."""
        variants = tuple(self.search.of_best_core(values) for values in by_variant)
        banded = replace(self.banded, by_variant=by_variant, variants=variants)
        return replace(self, banded=banded)


def ids_of(variant: Variant) -> list[str]:
    """Return the ids of a structure's terms."""
    return [t.id for p in variant.parts for t in p.terms]


def held(device: Device, search: BandSearch, banded: Banded) -> Banded:
    """Return a division with the best structures of the device's family, where it has one."""
    if device.family is None:
        return banded
    values = in_family(device, search, banded.by_variant)
    return replace(banded, variants=tuple(int(v.argmax()) for v in values))


def in_family(device: Device, search: BandSearch, by_variant: Array) -> Array:
    """Return log evidence (B, V) of structures, -inf for those of another family than is asked."""
    if device.family is None:
        return by_variant
    other = [family_of(ids_of(v)) != device.family for v in search.variants]
    return np.where(other, -np.inf, by_variant)
