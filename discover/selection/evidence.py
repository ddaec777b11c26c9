"""The evidence for each support, and the probability of each structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.library.dictionary import Dictionary
from discover.regression.support import (
    PLAIN_SHAPES,
    SAME_SHAPE,
    ProfiledFit,
    Support,
    SupportFit,
)
from discover.selection.structures import (
    ELASTIC,
    FRACTIONAL,
    MINOR,
    NUISANCE,
    POWER,
    STRUCTURES,
    TURBULENT_EXPONENT,
    structure_of,
)
from discover.triangle import Triangle

_CANCELS = 5.0  # times the force: stiffness and inertia that take each other back


@dataclass(frozen=True)
class Scored:
    """A fit with its log evidence."""

    fit: SupportFit
    """The fit."""
    structure: str
    """Name of its structure."""
    log_evidence: float
    """By the Bayesian information criterion, without the prior over structures; -inf where
    a sign is unphysical or a term has no identity of its own."""


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


def stands(fit: SupportFit) -> bool:
    """Return whether every term of a fit has an identity of its own.

    A free shape beside other terms that lies on a plain term's shape, to within little, stands for
    that term, and the support that has it is weighed anyway. At a single frequency stiffness is
    inertia with the other sign: where they take back many times the force, neither is measured.
    """
    core = [i for i in fit.support.ids if i not in NUISANCE and i not in ELASTIC]
    for identifier, shape in zip(fit.support.free, fit.shapes, strict=False):
        alone = identifier == FRACTIONAL and len(core) == 1
        if not alone and any(abs(shape - v) < SAME_SHAPE for v in PLAIN_SHAPES[identifier]):
            return False
    elastic = [s for i, s in zip(fit.support.ids, fit.shares, strict=True) if i in ELASTIC]
    return max(elastic, default=0.0) < _CANCELS


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
        result.append(Scored(fit, name_of(fit), value if fit.valid and stands(fit) else -np.inf))
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
