"""The evidence for each support, and the probability of each structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support, SupportFit
from discover.selection.structures import (
    ELASTIC,
    MINOR,
    POWER,
    STRUCTURES,
    TURBULENT_EXPONENT,
    structure_of,
)
from discover.triangle import Triangle


@dataclass(frozen=True)
class Scored:
    """A fit with its log evidence."""

    fit: SupportFit
    """The fit."""
    structure: str
    """Name of its structure."""
    log_evidence: float
    """By the Bayesian information criterion, without the prior over structures; -inf where
    a sign is unphysical."""


@dataclass(frozen=True)
class Contest:
    """Every support's fit on one triangle, best first, and the structures' probabilities."""

    scored: tuple[Scored, ...]
    """By falling log evidence."""
    probabilities: dict[str, float]
    """Of each structure; they add up to one."""

    def best(self, structure: str) -> Scored | None:
        """Return the best fit of a structure."""
        return next((s for s in self.scored if s.structure == structure), None)


def name_of(fit: SupportFit) -> str:
    """Return the name of a fit's structure."""
    families = (*fit.support.free, *(i for i, _ in fit.support.fixed))
    shapes = dict(zip(families, fit.shapes, strict=True))
    ids = [
        i
        for i, share in zip(fit.support.ids, fit.shares, strict=True)
        if i not in ELASTIC or share > MINOR
    ]
    return structure_of(ids, shapes.get(POWER, TURBULENT_EXPONENT))


def penalty(parameters: int, rows: int) -> float:
    """Return half the Bayesian information criterion's penalty, nats."""
    return 0.5 * parameters * float(np.log(max(rows, 2)))


def score(
    engine: ProfiledFit, supports: Sequence[Support], *, rows: int | None = None
) -> list[Scored]:
    """Return every support with its evidence, best first."""
    triangle = engine.triangle
    size = triangle.rows if rows is None else rows
    result = []
    for support in supports:
        fit = engine.fit(support)
        value = -0.5 * (fit.chi2 + triangle.log_determinant) - penalty(support.parameters, size)
        result.append(Scored(fit, name_of(fit), value if fit.valid else -np.inf))
    return sorted(result, key=lambda s: -s.log_evidence)


def contest(
    triangle: Triangle, dictionary: Dictionary, supports: Sequence[Support]
) -> Contest:
    """Return the contest of supports on a triangle.

    Structures are equally probable before the data, and so are the variants of each: having
    many variants does not help a structure.
    """
    scored = score(ProfiledFit(triangle, dictionary), supports)
    groups = {name: [s.log_evidence for s in scored if s.structure == name] for name in STRUCTURES}
    logs = {
        name: float(logsumexp(values) - np.log(len(values)))
        for name, values in groups.items()
        if values and np.isfinite(max(values))
    }
    total = float(logsumexp(list(logs.values()))) if logs else 0.0
    probabilities = {
        name: float(np.exp(logs[name] - total)) if name in logs else 0.0 for name in STRUCTURES
    }
    return Contest(tuple(scored), probabilities)
