"""What a channel's low-pass makes of a force: Butterworth's of some order, by its delay."""

from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.motion import Motion

Lines = NDArray[np.complex128]
_NODES = {1: 8, 2: 12, 3: 24, 4: 32}
_NEGLIGIBLE = 1e-6  # weight
_BILINEAR = {
    order: np.array([np.poly([1.0] * k + [-1.0] * (order - k)) for k in range(order, -1, -1)])
    for order in _NODES
}
"""(order + 1, order + 1) coefficients of (z - 1)^k (z + 1)^(order - k), highest k first."""


def low_passed(
    force: Array, motion: Motion, delay: float, order: int = 1, *, digital: bool = False
) -> Array:
    """Return a force (N,) behind a low-pass: steady, or settled as the record begins.

    Parameters
    ----------
    force : ndarray, shape (N,)
        Before it.
    motion : Motion
        Whose samples the force is at.
    delay : float
        Of slow forces, s: 1, 1.414, 2 and 2.613 over the corner (rad/s) for orders 1 to 4.
    order : int
        1 to 4.
    digital : bool
        Whether it works on the record's samples. Of a motion that repeats exactly, as on the grid
        of a simulated cycle, the samples are not known: there it does not.
    """
    if motion.periodic:
        return low_passed_cycle(force, motion.step, delay, order)
    if digital:
        return low_passed_samples(force, motion.step, delay, order)
    return _settled(force, *_between_samples(delay / motion.step, order))


def low_passed_samples(force: Array, step: float, delay: float, order: int = 1) -> Array:
    """Return samples (N,), one every `step` s, behind a digital low-pass, settled as they begin.

    It is the bilinear transform of the analogue one: slow forces pass with that very delay.
    """
    rates = (2.0 / step) ** np.arange(order, -1.0, -1.0)
    powers = _BILINEAR[order]  # of s = 2/step (z - 1)/(z + 1)
    bottom = (_denominator(delay, order) * rates) @ powers
    return _settled(force, powers[-1] / bottom[0], bottom / bottom[0])


# Kept: a few numbers for each of the latest filters, which is the same for records of one rate.
@lru_cache(maxsize=256)
def _between_samples(delay: float, order: int) -> tuple[Array, Array]:
    """Return the filter of samples with straight lines between them; the delay is in steps."""
    from scipy.signal import cont2discrete  # loaded here: it takes a quarter of a second

    system = np.array([1.0]), _denominator(delay, order)
    top, bottom, _ = cont2discrete(system, 1.0, method="foh")
    return top.ravel(), bottom


def _settled(force: Array, top: Array, bottom: Array) -> Array:
    """Return what a filter that passes what lasts makes of a force that began long ago."""
    from scipy.signal import lfilter

    begun = np.cumsum((top - bottom)[:0:-1])[::-1]
    return np.asarray(lfilter(top, bottom, force, zi=force[0] * begun)[0])


def low_passed_cycle(force: Array, step: float, delay: float, order: int = 1) -> Array:
    """Return a cycle (N,) of a force, sampled every `step` s, behind a low-pass as above."""
    return low_passed_lines(np.fft.rfft(force), force.size, step, delay, order)


def low_passed_lines(lines: Lines, size: int, step: float, delay: float, order: int = 1) -> Array:
    """Return a cycle (size,) as above, of the spectrum (size/2 + 1,) of the force before it."""
    s = 2j * np.pi * np.fft.rfftfreq(size, step)
    return np.fft.irfft(lines / np.polyval(_denominator(delay, order), s), n=size)


# Kept: a rule of a few nodes for each order.
@cache
def earlier(order: int) -> tuple[Array, Array]:
    """Return moments ago (M,) in delays, and weights (M,): their sum is what a low-pass passes.

    By Gauss and Laguerre's rule for its response to an impulse, which decays as exp(-t/delay) or
    faster.
    """
    from scipy.signal import residue

    residues, poles, _ = residue([1.0], _denominator(1.0, order))
    ago, weights = np.polynomial.laguerre.laggauss(_NODES[order])
    response = np.sum(residues * np.exp(np.outer(ago, poles + 1.0)), axis=1).real
    weights = weights * response
    used = np.abs(weights) > _NEGLIGIBLE
    return ago[used], weights[used]


def _denominator(delay: float, order: int) -> Array:
    """Return the polynomial in s (rad/s) whose inverse the low-pass is."""
    unscaled = _butterworth(order)
    return np.asarray(unscaled * (delay / unscaled[-2]) ** np.arange(order, -1.0, -1.0))


# Kept: a few numbers for each order.
@cache
def _butterworth(order: int) -> Array:
    """Return the polynomial of corner 1 rad/s."""
    from scipy.signal import butter

    return np.asarray(butter(order, 1.0, analog=True)[1])
