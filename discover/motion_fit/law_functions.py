"""Functions of a motion that stand together for whatever law a device may follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.hysteresis import bristle_state

_PRODUCTS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
"""Powers of displacement and velocity whose products stand for a static law."""
_ORDERS = (0.25, 0.5, 0.75, 1.25, 1.5, 1.75)
"""Of derivatives of displacement: any smooth linear response is nearly a sum of them."""
_SCALES = np.geomspace(3e-3, 1.0, 11)
"""Of the root mean square speed and displacement, over which friction may reverse."""
_SLOW = 3  # polynomials of time that follow a drift

Family = Callable[[], Iterator[Array]]
"""Yields functions' values at the samples, (N,) each: all at once would be much to hold."""


def law_functions(motion: Motion) -> list[Family]:
    """Return functions of a motion of N samples, by family.

    Products of displacement and speed, friction over several scales of speed and displacement,
    derivatives of several orders and slow changes: each law is nearly a sum of some.
    """
    x = motion.displacement - motion.displacement.mean()
    place, speed, push = (_unit(c) for c in (x, motion.velocity, motion.acceleration))
    scatter = float(np.std(x))

    def reversing(share: float) -> Iterator[Array]:
        sign = np.tanh(speed / share)
        yield from (sign, sign * place, bristle_state(motion, share * scatter))

    def pushed() -> Iterator[Array]:
        yield from (np.tanh(speed / _SCALES[0]) * np.abs(push), push)
        yield _unit(np.gradient(motion.acceleration))

    def answered(order: float) -> Iterator[Array]:
        yield _unit(motion.differentiate(np.array([order]))[0])

    def drifting() -> Iterator[Array]:
        time = np.linspace(-1.0, 1.0, x.size)
        yield from np.polynomial.legendre.legvander(time, _SLOW).T[1:]

    return [
        partial(_products, place, speed),
        *(partial(reversing, float(share)) for share in _SCALES),
        pushed,
        *(partial(answered, order) for order in _ORDERS),
        drifting,
    ]


def _products(place: Array, speed: Array) -> Iterator[Array]:
    """Yield what stands for a static law."""
    ones = np.ones_like(place)
    places, speeds = ([ones, c, c * c, c * c * c] for c in (place, speed))
    for i, j in _PRODUCTS:
        yield places[i] * speeds[j]
    yield from (np.abs(place), np.abs(speed), place * np.abs(place), speed * np.abs(speed))


def _unit(column: Array) -> Array:
    size = float(np.sqrt(np.mean(column**2)))
    return np.asarray(column / size if size > 0.0 else column)
