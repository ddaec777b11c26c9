"""How a record goes on beyond its ends, as far as its band lets one tell."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.fractional.orders import Array
from models.fractional.spectral import TRANSITION, low_pass_gain

# A level and a slope at the ends are free: so many times the size of the rest.
_TREND = 100.0
# Samples per period of the cut-off that the fit uses; a finer record is thinned.
_DENSITY = 256.0


@dataclass(frozen=True)
class EndFit:
    """Band-limited fit to the last samples of a record, in its singular directions."""

    nodes: NDArray[np.intp]
    """(M,) samples used, counted within the fitted window."""
    left: Array
    """(M, F) left singular vectors."""
    values: Array
    """(F,) singular values."""
    extension: Array
    """(added, F) the right singular vectors beyond the end, faded out."""
    prior: float
    """Norm of the prior: ridge over noise ratio."""


# Kept: matrices of lengths and band alone, which records of one sampling share.
@functools.lru_cache(maxsize=32)
def end_fit(fitted: int, added: int, band: float) -> EndFit:
    """Prepare the continuation of records.

    Parameters
    ----------
    fitted, added : int
        Samples that are fitted before, and added beyond, the end.
    band : float
        Cut-off, cycles per sample. The prior is a flat spectrum up to there that falls to
        nothing at the upper end of the low-pass, with a level and a slope left free.

    Returns
    -------
    EndFit

    Examples
    --------
    >>> end_fit(100, 50, 0.05).extension.shape[0]
    50
    """
    period = fitted + 2.0 * added
    count = int(math.floor(TRANSITION * band * period))
    frequency = np.arange(1, count + 1) / period
    shape = np.maximum(np.sqrt(2.0 * low_pass_gain(frequency, band)), 1e-6)
    prior = np.concatenate([[_TREND, _TREND], shape, shape])

    def features(n: Array) -> Array:
        angle = 2.0 * np.pi * n[:, None] * frequency
        line = np.stack([np.ones(n.size), n / fitted], axis=1)
        columns = np.concatenate([line, np.cos(angle), np.sin(angle)], axis=1)
        return np.asarray(columns * prior)

    nodes = np.arange(fitted - 1, -1, -max(1, int(1.0 / (_DENSITY * band))))[::-1]
    inside = features(np.asarray(nodes + 1.0 - fitted, dtype=np.float64))
    left, values, right = np.linalg.svd(inside, full_matrices=False)
    fade = low_pass_gain(np.arange(1.0, added + 1.0), 0.5 * added)
    extension = fade[:, None] * (features(np.arange(1.0, added + 1.0)) @ right.T)
    return EndFit(nodes, left, values, extension, float(np.linalg.norm(shape)))


def continue_record(end: Array, fit: EndFit, ratio: Array) -> Array:
    """Continue records beyond their last sample.

    Parameters
    ----------
    end : ndarray, shape (R, fitted)
        The last samples.
    fit : EndFit
    ratio : ndarray, shape (R,)
        Noise over signal: everything that does not lie in the band counts as noise. Too small
        a ratio makes the continuation swing out.

    Returns
    -------
    ndarray, shape (R, added)

    Examples
    --------
    >>> n = np.arange(150)
    >>> x = np.sin(0.1 * n)
    >>> more = continue_record(x[None, :100], end_fit(100, 50, 0.05), np.array([1e-4]))[0]
    >>> bool(np.max(np.abs(more[:4] - x[100:104])) < 0.02)
    True
    """
    ridge = fit.prior * ratio[:, None]
    weights = (end[:, fit.nodes] @ fit.left) * fit.values / (fit.values**2 + ridge**2)
    return np.asarray(weights @ fit.extension.T)
