"""Friction as one curve: which alone are most probable, and a model whose friction is one of them.

Departures from a curve add up to every other. But they are columns of the motion as it is. What a
joint or a sensor changes are the model's terms, and friction is changed as the curve of its term.
"""

from __future__ import annotations

import numpy as np

from discover.posterior.assess import Assessed, Assessor
from discover.posterior.covariance import Sizes
from discover.posterior.metric import Comparison
from discover.posterior.model import Composite
from discover.posterior.space import Part, Space
from models.checks import Array
from models.constitutive import FittedTerm

_BETTER = 1.0  # nats, by which a curve is to be more probable than the one that a model has
_LIKELIEST = 3  # curves behind a joint, from which a fit starts


def curves(space: Space, curve: Part) -> Array:
    """Return the columns (U, K, R) of a term's curves, each as it is.

    In a space the first is, and the others stand as differences from it.
    """
    columns = space.columns[:, curve.columns]
    return np.concatenate([columns[:, :1], columns[:, 1:] + columns[:, :1]], axis=1)


def each_alone(space: Space, sizes: Sizes, left: Array, whole: Array, power: float = 1.0) -> Array:
    """Return the log evidence (K,) of columns, each alone with a coefficient of its own, nats.

    Parameters
    ----------
    space : Space
        Of the records.
    sizes : Sizes
        Of what no term explains.
    left : ndarray, shape (U, R)
        What they shall make.
    whole : ndarray, shape (U, K, R)
        The columns.
    power : float
        To which the likelihood is taken.
    """
    stacked = np.concatenate([whole, left[:, None]], axis=1)
    gram = Comparison(space, stacked, None).at(sizes).gram[0]
    size = space.sheet.scale(whole)
    grown = 1.0 + power * size**2 * np.maximum(np.diagonal(gram)[:-1], 1e-300)
    gained = 0.5 * (power * size * gram[:-1, -1]) ** 2 / grown
    return np.asarray(gained - 0.5 * np.log(grown))


def likely_curves(assessor: Assessor, assessed: Assessed) -> list[FittedTerm]:
    """Return friction's most probable curve of each kind, of speed and of path, the best first.

    None where it has a curve that a fit may change, where it is held, or where the model has no
    friction of that kind.
    """
    curve, model = assessor.friction, assessed.model
    if curve is None or assessed.curve is None:
        return []
    placed = model.terms[place_of(curve, model)]
    if placed.held or any(placed.fitted.shape.values()):
        return []
    own = [k for k, t in enumerate(curve.terms) if t.id == curve.id]
    space, whole = assessed.space, curves(assessed.space, curve)[:, own]
    left = space.sheet.target - assessed.local.force + placed.fitted.coefficient * whole[:, 0]
    values = each_alone(space, assessed.place.sizes(space.own_unit), left, whole)
    best: dict[str, FittedTerm] = {}
    for k in np.argsort(-values):
        if values[k] < values[0] + _BETTER and k > 0:
            continue
        fitted = curve.terms[own[k]]
        best.setdefault(fitted.term.remembers(fitted.shape), fitted)
    return list(best.values())


def place_of(curve: Part, model: Composite) -> int:
    """Return the place of friction among a model's terms."""
    return next(i for i, p in enumerate(model.terms) if p.fitted.id == curve.id)


def with_curve(assessor: Assessor, assessed: Assessed, fitted: FittedTerm) -> Assessed:
    """Return a model whose friction has another curve."""
    model, curve = assessed.model, assessor.friction
    if curve is None or not any(fitted.shape.values()):
        return assessed
    turned = model.with_shape(place_of(curve, model), fitted.shape)
    return assessor.assess(turned, assessed.place)


def chosen_behind(assessor: Assessor, assessed: Assessed) -> Assessed:
    """Return a model with the curve of friction that is best beside its joint.

    How the device moves behind a joint hangs on friction's curve. Which one is likely without the
    joint says little: what yields there looks like friction that reverses over a displacement.
    Curves are ranked by what the model's slopes promise of them, as long as another one is better.
    One that is no better after a few steps of a fit is not fitted further.
    """
    curve = assessor.friction
    if curve is None or not any(
        p.fitted.id == curve.id and not p.held for p in assessed.model.terms
    ):
        return assessed
    shapes = [t.shape for t in curve.terms if t.id == curve.id]
    here = assessed
    while True:
        at, place = place_of(curve, here.model), here.place
        turned = [here.model.with_shape(at, shape) for shape in shapes]
        values = np.array([assessor.promised(here.local, m, place) for m in turned])
        likely = [turned[k] for k in np.argsort(-values)[:_LIKELIEST]]
        nearest, value = assessor.nearest(likely, place)
        if value <= assessor.promised(here.local, here.model, place):
            return here
        there = assessor.assess(nearest, place)
        if there.value <= here.value + _BETTER:
            return here
        here = there
