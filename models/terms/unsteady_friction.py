"""Unsteady friction: the memory of a laminar flow in a round channel, its wall layer's force."""

import numpy as np
from scipy.special import jn_zeros

from models.checks import Array
from models.motion import Motion
from models.terms.low_pass import low_passed
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

_LAGS = 24  # of a series whose rest is as good as prompt
_RATES = jn_zeros(2, _LAGS) ** 2  # over the diffusion time: squares of the zeros of J2
_WEIGHTS = 4.0 / _RATES
_PROMPT = 1.0 / 3.0 - float(np.sum(_WEIGHTS))  # what the series leaves of its sum


def column(motion: Motion, shape: Shape) -> Array:
    """Return what the wall layer adds to plug flow and steady losses, over the oil's inertance.

    The sum over k of 4/j_k^2 times the acceleration behind a lag of T/j_k^2, where j_k are the
    zeros of J2 and T = R^2/nu is the time in which vorticity diffuses across the channel. Slow
    motion feels a third of the inertance more, fast motion a damping that grows with the root of
    frequency (W. Zielke, J. Basic Eng. 90, 1968, 109-115).
    """
    felt = motion.acceleration
    lags = shape["diffusion_time"] / _RATES
    if motion.periodic:
        s = 2j * np.pi * np.fft.rfftfreq(felt.size, motion.step)
        passed = _PROMPT + np.sum(_WEIGHTS / (1.0 + s[:, None] * lags), axis=1)
        return np.fft.irfft(np.fft.rfft(felt) * passed, n=felt.size)
    lagged = [w * low_passed(felt, motion, float(t)) for w, t in zip(_WEIGHTS, lags, strict=True)]
    return np.asarray(_PROMPT * felt + np.sum(lagged, axis=0))


def starts(scales: Scales) -> list[Start]:
    """Return diffusion times for which the memory shows within the tests' frequencies."""
    middle = np.sqrt(scales.omega * scales.least_omega)
    return [Start.one(diffusion_time=float(t / middle)) for t in np.geomspace(3.0, 3e3, 7)]


TERM = Term(
    "unsteady-friction",
    "kg",
    "b times the acceleration behind the wall layer's lags; b is the oil's inertance",
    column,
    parameters=(Parameter("diffusion_time", 1e-3, 1e3, 1.0, "s", spacing="log"),),
    nonnegative=True,
    follows="path",
    needs=("inertia",),
    mistaken_for=("fractional-derivative", "inertia", "sensor-gain"),
    starts=starts,
)
