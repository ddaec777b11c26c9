"""Friction as one curve: which alone is most probable, and a model whose friction it is.

Departures from a curve add up to every other. But they are columns of the motion as it is. What a
joint or a sensor changes are the model's terms, and friction is changed as the curve of its term.
"""

from __future__ import annotations

import numpy as np

from discover.posterior.assess import Assessed, Assessor
from discover.posterior.covariance import Sizes
from discover.posterior.metric import Comparison
from discover.posterior.space import Part, Space
from models.checks import Array

_BETTER = 1.0  # nats, by which a curve is to be more probable than the one that a model has


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


def with_own_curve(assessor: Assessor, assessed: Assessed) -> Assessed:
    """Return a model whose friction is the curve that alone is most probable.

    As it was where that is its curve already, where a fit may change the curve, where the model
    has no friction of that kind, or where it is held.
    """
    curve, model = assessor.friction, assessed.model
    if curve is None or assessed.curve is None:
        return assessed
    at = next(i for i, p in enumerate(model.terms) if p.fitted.id == curve.id)
    placed = model.terms[at]
    if placed.held or any(placed.fitted.shape.values()):
        return assessed
    own = [k for k, t in enumerate(curve.terms) if t.id == curve.id]
    space, whole = assessed.space, curves(assessed.space, curve)[:, own]
    left = space.sheet.target - assessed.local.force + placed.fitted.coefficient * whole[:, 0]
    sizes = assessed.place.sizes(space.own_unit)
    values = each_alone(space, sizes, left, whole)
    best = int(values.argmax())
    if values[best] < values[0] + _BETTER:
        return assessed
    turned = model.with_shape(at, curve.terms[own[best]].shape)
    return assessor.assess(turned, assessed.place)
