"""Whether a motion ever comes back: to a place where it was, or to a speed that it had.

Where both displacement and speed only rise, or only fall, each is a function of the other, and of
the time. So is any force: a law of the speed can't be told from one of the place or of the time.
Where only the displacement does, dry friction has one direction, and is a constant force.
"""

from __future__ import annotations

import numpy as np

from models.checks import Array

_PLACES = 512  # means of neighbouring samples, at which a motion is looked at
_LEAST = 1e-5  # of the stroke, that counts as coming back
_SURE = 5.0  # standard deviations of noise, likewise
_BEND = float(np.sqrt(1.5))  # noise of a place less the middle of two others, over that of one


def comes_back(displacement: Array) -> bool:
    """Return whether a motion turns back, or its speed both rises and falls.

    Speed rises where the displacement lies below a straight line between an earlier and a later
    place, and falls where it lies above one: nothing is differentiated.

    Parameters
    ----------
    displacement : ndarray, shape (N,)
        m, uniformly sampled.

    Examples
    --------
    Of an eighth of a cycle, and of a stroke from rest to rest:

    >>> turn = np.linspace(0.0, 1.0, 200)
    >>> comes_back(np.sin(0.25 * np.pi * turn)), comes_back(np.cos(np.pi * turn))
    (False, True)
    """
    if turns_back(displacement):
        return True
    places, least = _places(displacement)
    above, below = 0.0, 0.0
    for reach in range(1, (places.size + 1) // 2):
        middle = 0.5 * (places[: -2 * reach] + places[2 * reach :])
        apart = places[reach:-reach] - middle
        above, below = max(above, float(apart.max())), max(below, float(-apart.min()))
    return min(above, below) > _BEND * least


def turns_back(displacement: Array) -> bool:
    """Return whether a displacement (N,), m, uniformly sampled, both rises and falls.

    Examples
    --------
    >>> turn = np.linspace(0.0, 1.0, 200)
    >>> turns_back(np.cos(np.pi * turn)), turns_back(np.cos(2.0 * np.pi * turn))
    (False, True)
    """
    places, least = _places(displacement)
    if places.size < 3:
        return False
    highest, lowest = np.maximum.accumulate(places), np.minimum.accumulate(places)
    return min(float(np.max(highest - places)), float(np.max(places - lowest))) > least


def _places(displacement: Array) -> tuple[Array, float]:
    """Return means of neighbouring samples, and what between two of them counts as a motion, m."""
    each = max(1, displacement.size // _PLACES)
    count = displacement.size // each
    places = displacement[: each * count].reshape(count, each).mean(axis=1)
    rest = np.diff(displacement, 3) / np.sqrt(20.0)  # what a smooth motion leaves: white noise
    noise = float(np.std(rest) / np.sqrt(each)) if rest.size else 0.0
    return places, _LEAST * float(np.ptp(places)) + _SURE * noise
