"""A model assessed: fitted, and its evidence summed over the sizes of what it does not explain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy.special import logsumexp

from discover.posterior.climb import Place, climb
from discover.posterior.local import Judged, Local, fitted, judged
from discover.posterior.model import Composite, Evaluator
from discover.posterior.space import Part, Space, departures

_ROUNDS = 3  # of fitting and climbing
_SMALL = -9
"""Power of two, of the force: what is left below it is nothing that a model need explain."""
_POSSIBLE = 0.05
"""Probability from which it may be that no more is left."""


@dataclass(frozen=True)
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

    @property
    def model(self) -> Composite:
        """The model at its best values."""
        return self.local.model


@dataclass(frozen=True)
class Assessor:
    """What models are assessed with."""

    space: Space
    """Of the records."""
    evaluator: Evaluator
    """Of models."""
    friction: Part | None
    """Friction with all its curves; None where models hold none."""
    path: bool = True
    """Whether curves count that remember the path."""

    @cached_property
    def curve(self) -> Part | None:
        """Departures of friction's curve."""
        return None if self.friction is None else departures(self.friction, path=self.path)

    @cached_property
    def coarse(self) -> Evaluator:
        """Evaluator of what may join a model, where a quarter of a cycle's points is enough."""
        return Evaluator(self.space.sheet, self.space.scales, coarse=True)

    def assess(
        self, model: Composite, start: Place, *, refit: bool = True, iterations: int = 12,
        coarse: bool = False,
    ) -> Assessed:
        """Return a model fitted and assessed, from sizes to start from.

        In a hurry with a quarter of a cycle's points (`coarse`), or few `iterations`.
        """
        evaluator = self.coarse if coarse else self.evaluator
        place = start
        local = Local(model, (), *[np.zeros(0)] * 4)
        visited: dict[Place, float] = {}
        for turn in range(_ROUNDS):
            sizes = place.sizes(self.space.own_unit)
            numbers = None if refit else ()
            local = fitted(
                self.space, evaluator, model, sizes, self.curve_of(model),
                numbers=numbers, iterations=iterations,
            )
            visited = {}
            found = climb(partial(self._at, local, visited), place)
            model = local.model
            if found == place and turn > 0:
                break
            stays, place = found == place, found
            if stays:
                break
        self._at(local, visited, self.space.quiet)
        best = judged(self.space, local, place.sizes(self.space.own_unit), self.curve_of(model))
        return Assessed(
            local, place, float(logsumexp(list(visited.values()))), best, visited, is_quiet(visited)
        )

    def predicting(self, assessed: Assessed) -> Assessed:
        """Return a model at the numbers that predict best, where nothing is left to a remainder.

        What no term explains is not known in other records. Numbers that lean on a remainder are
        right only beside it; these are the ones by which the terms alone come closest.
        """
        if assessed.place.remainder <= _SMALL or not assessed.local.numbers:
            return assessed
        local, curve = assessed.local, self.curve_of(assessed.model)
        visited: dict[Place, float] = {}
        place = assessed.place
        for _ in range(_ROUNDS):
            visited = {}
            for flat in assessed.place.unaided:
                self._at(local, visited, flat)
            before, place = place, max(visited, key=lambda p: visited[p])
            if place == before:
                break
            sizes = place.sizes(self.space.own_unit)
            local = fitted(self.space, self.evaluator, local.model, sizes, curve)
        best = judged(self.space, local, place.sizes(self.space.own_unit), curve)
        return Assessed(local, place, assessed.value, best, visited, assessed.quiet)

    def _at(self, local: Local, visited: dict[Place, float], place: Place) -> float:
        if place not in visited:
            sizes = place.sizes(self.space.own_unit)
            visited[place] = judged(
                self.space, local, sizes, self.curve_of(local.model)
            ).value
        return visited[place]

    def curve_of(self, model: Composite) -> Part | None:
        """Return the departures of friction's curve where a model has that friction."""
        if self.curve is None or not self.curve.terms:
            return None
        name = self.curve.id
        return self.curve if any(t.fitted.id == name for t in model.terms) else None


def is_quiet(visited: Mapping[Place, float]) -> bool:
    """Tell whether it may be that no more than noise is left, from log evidence by sizes, nats."""
    small = [v for p, v in visited.items() if p.remainder <= _SMALL and p.loudest <= _SMALL]
    if not small:
        return False
    return bool(logsumexp(small) - logsumexp(list(visited.values())) > np.log(_POSSIBLE))
