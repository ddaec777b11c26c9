"""A model assessed: fitted, and its evidence summed over the sizes of what it does not explain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
from scipy.special import logsumexp

from discover.posterior.climb import Place, climb
from discover.posterior.evidence import Solved
from discover.posterior.local import Judged, Local, fit_of, fitted, judged, local_of
from discover.posterior.metric import Comparison
from discover.posterior.model import Composite, Evaluator
from discover.posterior.setup import behind
from discover.posterior.space import Part, Space, departures

_ROUNDS = 3  # of fitting and climbing
_SMALL = -10
"""Power of two, of the force: what is left below it is nothing that a model need explain."""
_ORDINARY = -3
"""Power of two, of what would make the whole force: by no more does dry friction differ from record
to record where nothing else is behind it."""
FEW_STEPS = 3
"""Of a fit from each of several places, of which the best goes on."""
_SPACES = 3
"""Spaces behind sensors that are kept."""
_POSSIBLE = 0.05
"""Probability from which it may be that no more is left."""


@dataclass(frozen=True, repr=False)
class Assessed:
    """A model with its evidence."""

    local: Local
    """Fitted."""
    place: Place
    """Sizes of what it does not explain, most probable ones."""
    value: float
    """Log evidence, nats, summed over the sizes."""
    judged: Judged
    """At that place."""
    visited: dict[Place, float]
    """Log evidence at every place that was looked at."""
    quiet: bool
    """True where all but noise may be explained."""
    assessor: Assessor
    """By which it is."""

    def __repr__(self) -> str:
        """Return the model's terms and its log evidence."""
        terms = ", ".join(p.fitted.id for p in self.model.terms)
        return f"<Assessed {terms}: {self.value:.1f} nats at {self.place.powers}>"

    @property
    def model(self) -> Composite:
        """The model at its best values."""
        return self.local.model

    @property
    def space(self) -> Space:
        """Of the records, friction's curve as the model's sensors pass it on."""
        return self.assessor.behind(self.model)

    @property
    def curve(self) -> Part | None:
        """Departures of friction's curve, where the model has that friction."""
        return self.assessor.curve_of(self.model)

    def density(self, model: Composite) -> float:
        """Return the log density of a model as it is at this one's sizes, nats; on the coarse rows.

        With friction's curve as this one's sensors pass it on.
        """
        force = self.assessor.evaluator.coarse.force(model)
        return fit_of(self.space, force, self.place.sizes(self.space.own_unit), self.curve)

    @cached_property
    def predicting(self) -> Assessed:
        """The model at the numbers that predict best, where nothing is left to a remainder.

        What no term explains is not known in other records. Numbers that lean on a remainder are
        right only beside it; these are the ones by which the terms alone come closest.
        """
        if self.place.remainder <= _SMALL or not self.local.numbers or self.value == -np.inf:
            return self
        local, place, space = self.local, self.place, self.space
        visited: dict[Place, float] = {}
        for _ in range(_ROUNDS):
            visited, beside = {}, local.beside(space, self.curve)
            for flat in place.unaided:
                _at(space, local, beside, visited, flat)
            before, place = place, max(visited, key=lambda p: visited[p])
            if place == before:
                break
            sizes = place.sizes(space.own_unit)
            local = fitted(space, self.assessor.evaluator, local, sizes, self.curve)
        best = judged(local, local.beside(space, self.curve), place.sizes(space.own_unit))
        return replace(self, local=local, place=place, judged=best, visited=visited)


@dataclass(frozen=True)
class Assessor:
    """What models are assessed with."""

    space: Space
    """Of the records."""
    evaluator: Evaluator
    """Of models."""
    friction: Part | None
    """Friction with all its curves; None where models hold none."""
    named: bool = True
    """Whether curves of friction count that have a name among effects."""
    seed: int = 0
    """Of what is drawn."""
    _behind: dict[tuple[object, ...], Space] = field(
        default_factory=dict, repr=False, compare=False
    )

    def glance(
        self, model: Composite, place: Place, *, iterations: int
    ) -> tuple[Composite, float]:
        """Return a model after a few steps of a fit, and its log evidence at these sizes, nats.

        On the coarse rows.
        """
        space, curve = self.behind(model), self.curve_of(model)
        sizes = place.sizes(space.own_unit)
        here = local_of(space, self.evaluator.coarse, model)
        local = fitted(space, self.evaluator.coarse, here, sizes, curve, iterations=iterations)
        value = judged(local, local.beside(space, curve), sizes).value
        if space is not self.space:
            space.forget()
        return local.model, value

    def promised(self, near: Local, model: Composite, place: Place) -> float:
        """Return the log evidence of a model at some sizes, nats, with the slopes of one near by.

        On the coarse rows. It has other shapes, and no numbers that the other has not.
        """
        local = replace(near, model=model, force=self.evaluator.coarse.force(model))
        if not np.all(np.isfinite(local.force)):
            return -np.inf
        space, curve = self.behind(model), self.curve_of(model)
        return judged(local, local.beside(space, curve), place.sizes(space.own_unit)).value

    def nearest(self, models: Sequence[Composite], place: Place) -> tuple[Composite, float]:
        """Return the model that a few steps of a fit make most probable, after these steps.

        And its log evidence at these sizes, nats; on the coarse rows.
        """
        begun = [self.glance(m, place, iterations=FEW_STEPS) for m in models]
        return max(begun, key=lambda b: b[1])

    def assess(self, model: Composite, start: Place, *, refit: bool = True) -> Assessed:
        """Return a model fitted and assessed, from sizes to start from."""
        place = start
        local = local_of(self.space, self.evaluator, model, None if refit else ())
        if not np.all(np.isfinite(local.force)):
            return self._impossible(local, place)
        for number in range(_ROUNDS):
            before, space, curve = local, self.behind(local.model), self.curve_of(local.model)
            local = fitted(space, self.evaluator, local, place.sizes(space.own_unit), curve)
            visited: dict[Place, float] = {}
            beside = local.beside(space, curve)
            value = partial(_at, space, local, beside, visited)
            found = climb(value, place, near=number > 0)
            stays = found == place and (space is self.space or local is before)
            place = found
            if stays:
                break
        _at(space, local, beside, visited, space.quiet)
        best = judged(local, beside, place.sizes(space.own_unit))
        if space is not self.space:
            space.forget()
        return Assessed(
            local, place, float(logsumexp(list(visited.values()))), best, visited,
            is_quiet(visited), self,
        )

    def _impossible(self, local: Local, place: Place) -> Assessed:
        """Return a model whose force is not finite, as a joint that shakes itself apart."""
        count = len(local.numbers)
        nothing = Solved(np.array(-np.inf), np.zeros(count), np.diag(local.spread**2))
        judged_so = Judged(-np.inf, 1.0, nothing, np.zeros((count, count)), np.zeros(count))
        return Assessed(
            local, place, -np.inf, judged_so, {place: -np.inf}, quiet=False, assessor=self,
        )

    def behind(self, model: Composite) -> Space:
        """Return the space with friction's curve as a model's sensors pass it on.

        Behind a joint it stays as it is: each column would have to be simulated in time. A space is
        large: of the latest models only it is kept.
        """
        if self.friction is None or not model.changes_force:
            return self.space
        key = tuple(
            (t.id, t.coefficient, *t.shape.items(), p.share)
            for p in model.terms for t in (p.fitted,)
        )
        space = self._behind.pop(key, None)
        if space is None:
            space = behind(self.space, self.friction, self.evaluator.behind(model))
        while len(self._behind) >= _SPACES:
            del self._behind[next(iter(self._behind))]
        self._behind[key] = space
        return space

    def curve_of(self, model: Composite) -> Part | None:
        """Return the departures of friction's curve where a model has that friction.

        Friction of several terms has a curve of its own: what departs from it would not be stated.
        Curves that have a name among effects are open to models that hold such an effect.
        """
        if self.friction is None:
            return None
        others = tuple(t.fitted for t in model.terms if t.fitted.id != self.friction.id)
        if len(others) + 1 != len(model.terms):
            return None
        curve = departures(self.friction, None if self.named else others)
        return curve if curve.terms else None


def _at(
    space: Space, local: Local, beside: Comparison, visited: dict[Place, float], place: Place
) -> float:
    if place not in visited:
        visited[place] = judged(local, beside, place.sizes(space.own_unit)).value
    return visited[place]


def is_quiet(visited: Mapping[Place, float]) -> bool:
    """Tell whether it may be that no more than noise is left, from log evidence by sizes, nats."""
    small = [
        v for p, v in visited.items()
        if p.remainder <= _SMALL and p.loudest <= _SMALL and p.own <= _ORDINARY
    ]
    if not small:
        return False
    return bool(logsumexp(small) - logsumexp(list(visited.values())) > np.log(_POSSIBLE))
