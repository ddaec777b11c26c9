"""Terms that join together: of all that only add a force, the set by which these come closest.

One after the other, terms that are needed together may each be worth nothing: a weight that swings
is a spring that softens, and neither half of it helps alone. Terms with a coefficient and nothing
else to fit are linear, so every set of them is compared: structures on their grid of shapes,
friction with one of its curves, and what a device may have besides.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from discover.bands.found import Found
from discover.posterior.assess import Assessed
from discover.posterior.catalogue import starts_of, term_log_prior
from discover.posterior.covariance import Products
from discover.posterior.left_out import predicts_best
from discover.posterior.model import fitted_names
from discover.posterior.own_share import own_lines
from discover.regression.best_subset import Subset, best_subsets
from models.checks import Array, Indices
from models.constitutive import FittedTerm
from models.cores import TELLING, core_of
from models.terms import TERMS

_MOST = 5
"""Terms of a set: a structure's two, friction and two more, say."""


def together(way: Found) -> list[tuple[FittedTerm, float]]:
    """Return the terms that join a way at once, if any, with the log prior (nats) of each.

    Of each number of terms the set with the least misfit is taken, of these the one that predicts
    records left out best; where nothing can be left out the largest, as others than this tell what
    of it is needed.
    """
    if not way.device.extras:
        return []
    now = way.assessed.predicting
    terms = list(_terms(way))
    columns, goal = _white(now, terms)
    ids = [t.id for t in terms]
    path = best_subsets(
        columns.reshape(goal.size, -1), goal.ravel(),
        max_terms=_MOST,
        nonnegative=[i for i, t in enumerate(terms) if _bounds(t)[0] >= 0.0],
        exclusive=[[i for i, own in enumerate(ids) if own == name] for name in dict.fromkeys(ids)],
        keep=1,
    )
    best = _predicting(way, now, columns, goal, [s[0] for s in path.sizes if s])
    among = len(way.device.extras)
    name = core_of([ids[i] for i in best.indices])
    own = TELLING.difference(*(c.beside for c in way.device.cores if c.name == name))
    return [
        (FittedTerm(t.id, float(c), t.shape), term_log_prior(t.term, among))
        for i, c in zip(best.indices, best.coefficients, strict=True)
        if (t := terms[i]).id in way.device.extras and t.id not in own
    ]


def _bounds(fitted: FittedTerm) -> tuple[float, float]:
    return fitted.term.coefficient_bounds(fitted.shape)


def _terms(way: Found) -> Iterator[FittedTerm]:
    """Yield terms of coefficient one: of structures, friction's curves, and linear extras."""
    known = {(t.id, *t.shape.items()): t for v in way.variants for p in v.parts for t in p.terms}
    yield from (FittedTerm(t.id, 1.0, t.shape) for t in known.values())
    assessor = way.device.assessor
    if way.device.with_friction and assessor.friction is not None:
        yield from (
            FittedTerm(t.id, 1.0, t.shape)
            for t in assessor.friction.terms if t.id == assessor.friction.id
        )
    for term in (TERMS[i] for i in way.device.extras if i not in TELLING):
        if term.acts != "force" or term.impacts is not None or term.needs:
            continue
        for start in starts_of(term, assessor.space.scales):
            own = [FittedTerm(term.id, 1.0, dict(shape)) for shape in start.shapes]
            if len(own) == 1 and not fitted_names(own[0]):
                yield own[0]


def _white(now: Assessed, terms: Sequence[FittedTerm]) -> tuple[Array, Array]:
    """Return columns (U, R, K) of terms and the measured force (U, R), over what is missed."""
    space = now.space
    sizes = now.place.sizes(space.own_unit)
    scale = Products(space.sheet, space.own, space.columns, sizes.loud).scale
    columns = [now.assessor.evaluator.unit(t) / scale for t in terms]
    return np.stack(columns, axis=2), np.asarray(space.sheet.target / scale)


def _predicting(
    way: Found, now: Assessed, columns: Array, goal: Array, subsets: Sequence[Subset]
) -> Subset:
    """Return the set that predicts records, or parts of a lone one, best from the others."""
    records = np.array([u.record for u in now.space.sheet.units])
    parts = records if records.max() else np.arange(records.size)
    count = int(parts.max()) + 1
    if count == 1:
        return subsets[-1]
    errors = [_errors(columns[:, :, list(s.indices)], goal, parts) for s in subsets]
    among = len(way.device.extras)
    priors = [len(s.indices) * np.log(1.0 / among) for s in subsets]
    chances = predicts_best(errors, np.array(priors), own_lines(now, count), way.device.seed)
    return subsets[int(np.argmax(chances))]


def _errors(columns: Array, goal: Array, parts: Indices) -> Array:
    """Return what least squares on the others leave (N,) of each part, over its force's square."""
    found = []
    for part in range(int(parts.max()) + 1):
        inside = parts == part
        others, own = (
            c.reshape(c.shape[0] * c.shape[1], -1 if c.size else 0)
            for c in (columns[~inside], columns[inside])
        )
        size = np.maximum(np.linalg.norm(others, axis=0), 1e-300)
        values = np.linalg.lstsq(others / size, goal[~inside].ravel())[0] / size
        with np.errstate(over="ignore", invalid="ignore"):  # of columns the others hardly show
            left = goal[inside].ravel() - own @ values
            error = float(left @ left) / max(float(np.sum(goal[inside] ** 2)), 1e-300)
        found.append(error if np.isfinite(error) else np.inf)
    return np.array(found)
