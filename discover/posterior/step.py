"""What may join a model, with the probability of each."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.special import log_expit, softmax

from discover.posterior.assess import Assessed
from discover.posterior.left_out import predicts_best
from models.checks import Array


@dataclass(frozen=True)
class Candidate:
    """A term beside a model."""

    id: str
    """Of the term; "" for the model as it is."""
    value: float
    """Log evidence with the prior, nats."""
    assessed: Assessed | None
    """The model with it; None where it was weighed in a straight line only."""
    count: int = 0
    """Number of terms that were added."""
    left: Array | None = None
    """(N,) what it leaves of each record, or each part of a lone one, predicted by the others: mean
    square over that of its force. None where evidence decides, or rules it out."""

    @property
    def log_prior(self) -> float:
        """Nats, of its term and of its shape among the term's."""
        return 0.0 if self.assessed is None else self.value - self.assessed.value

    @property
    def places(self) -> range:
        """Places of its terms in the model with it: the last ones."""
        count = 0 if self.assessed is None else len(self.assessed.model.terms)
        return range(count - self.count, count)


@dataclass(frozen=True)
class Step:
    """What may join a model, weighed."""

    candidates: tuple[Candidate, ...]
    """Most probable first; the model as it is among them."""
    seed: int = 0
    """Of the draws of records."""
    lines: float = 1.0
    """Number of lines of a record, or a part, that say something of their own."""

    @property
    def best(self) -> Candidate:
        """The most probable."""
        return self.candidates[0]

    def without(self, ids: Collection[str]) -> Step:
        """Return the step without some candidates, refused as they do not predict."""
        kept = tuple(c for c in self.candidates if c.id not in ids)
        return ordered(replace(self, candidates=kept))

    @cached_property
    def probabilities(self) -> dict[str, float]:
        """Of every id, and of "" for the model as it is.

        By evidence where one leaves but noise, or nothing can be left out. Else by how well each
        predicts; a name has to make the records more probable beside a remainder, too, which may be
        all that there is.
        """
        weighed = [c for c in self.candidates if c.left is not None and c.left.size > 1]
        if not weighed:
            shares = softmax([c.value for c in self.candidates])
            return {c.id: float(p) for c, p in zip(self.candidates, shares, strict=True)}
        now = max(c.value for c in self.candidates if not c.id)
        priors = [c.log_prior + log_expit(c.value - now) if c.id else 0.0 for c in weighed]
        left = [c.left for c in weighed if c.left is not None]
        found = predicts_best(left, np.array(priors), self.lines, self.seed)
        known = {c.id: float(p) for c, p in zip(weighed, found, strict=True)}
        return {c.id: known.get(c.id, 0.0) for c in self.candidates}


def ordered(step: Step) -> Step:
    """Return a step with the most probable first; the model as it is before its equals."""
    known = step.probabilities
    order = sorted(step.candidates, key=lambda c: (-known[c.id], bool(c.id), -c.value))
    return replace(step, candidates=tuple(order))
