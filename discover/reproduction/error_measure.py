"""The paper's error measure (Eqs. 9 and 10)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from discover.reproduction.paper import Condition
from models.checks import InputError, finite_array, one_of
from models.constitutive import ForceModel
from models.motion import sine_motion

SAMPLES = 1440
"""Samples of a cycle in every comparison here."""


def root_mean_square_error(force: ArrayLike, reference: ArrayLike) -> float:
    """Return the root mean square of the difference (Eq. 9), N.

    Examples
    --------
    >>> root_mean_square_error([1.0, 1.0], [0.0, 2.0])
    1.0
    """
    y, z = finite_array("force", force), finite_array("reference", reference)
    if y.shape != z.shape:
        raise InputError("force", expected=f"of shape {z.shape}", found=f"{y.shape}")
    return float(np.sqrt(np.mean((y - z) ** 2)))


def deviation_percent(force: ArrayLike, reference: ArrayLike, *, amplitude: str = "peak") -> float:
    """Return e_d, the error over the reference's amplitude in percent (Eq. 10).

    Parameters
    ----------
    force, reference : array_like, same shape
        N; the amplitude is the reference's.
    amplitude : str
        "peak", which Table 3 follows; "mean" (of the magnitude), as the paper's words say; "rms".

    Examples
    --------
    >>> deviation_percent([1.0, 1.0], [0.0, 2.0])
    50.0
    """
    one_of("amplitude", amplitude, ("peak", "mean", "rms"))
    z = finite_array("reference", reference)
    scale = {
        "peak": np.max(np.abs(z)),
        "mean": np.mean(np.abs(z)),
        "rms": np.sqrt(np.mean(z**2)),
    }[amplitude]
    if scale == 0.0:
        raise InputError("reference", expected="not zero throughout", found="zeros")
    return 100.0 * root_mean_square_error(force, reference) / float(scale)


def model_deviation(
    model: ForceModel, reference: ForceModel, condition: Condition, *, amplitude: str = "peak"
) -> float:
    """Return e_d of one model against another in a sine test, percent."""
    motion = sine_motion(condition.amplitude, condition.frequency, samples=SAMPLES)
    return deviation_percent(model.force(motion), reference.force(motion), amplitude=amplitude)
