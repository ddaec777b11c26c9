"""Steady-state (Weyl) derivative: a factor for each harmonic, exact on whole periods."""

from __future__ import annotations

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from models.checks import finite_array, number
from models.fractional.orders import Array, checked_orders, checked_record

TRANSITION = 2.0
"""The low-pass ends at this many times its cut-off."""


def harmonic_factors(orders: ArrayLike, omegas: ArrayLike) -> NDArray[np.complex128]:
    r"""Return what each order does to a steady harmonic, :math:`(i\omega)^\alpha`.

    A derivative from minus infinity turns :math:`e^{i\omega t}` into
    :math:`(i\omega)^\alpha e^{i\omega t}`, so :math:`\sin(\omega t)` into
    :math:`\omega^\alpha\sin(\omega t + \alpha\pi/2)`.

    Parameters
    ----------
    orders : array_like, shape (K,)
        Orders of differentiation, -1 to 2.
    omegas : array_like, shape (H,)
        Angular frequencies, rad/s; negative ones give the complex conjugate.

    Returns
    -------
    ndarray, shape (K, H), complex
        Principal branch. At omega = 0: 1 for order 0, else 0 (an integral over all the past of
        a constant has no value; the mean of a record is taken as zero).

    Raises
    ------
    InputError
        For an order outside [-1, 2] or values that are not finite.

    References
    ----------
    Samko, Kilbas, Marichev, *Fractional Integrals and Derivatives*, 1993, section 19.

    Examples
    --------
    >>> bool(abs(harmonic_factors([1.0], [2.0])[0, 0] - 2j) < 1e-15)
    True
    """
    alpha = checked_orders(orders)[0][:, None]
    omega = np.atleast_1d(finite_array("omega", omegas))[None, :]
    moving = omega != 0.0
    size = np.power(np.where(moving, np.abs(omega), 1.0), alpha)
    # Quarter turns by their remainder, so that whole orders have no stray real part.
    turns = np.floor(alpha + 0.5)
    angle = 0.5 * np.pi * (alpha - turns)
    unit = np.array([1.0, 1.0j, -1.0, -1.0j])[turns.astype(np.intp) % 4]
    phase = unit * (np.cos(angle) + 1j * np.sin(angle))
    factors = size * np.where(omega < 0.0, np.conj(phase), phase)
    at_rest = np.where(alpha == 0.0, 1.0, 0.0)
    return np.asarray(np.where(moving, factors, at_rest), dtype=np.complex128)


def spectral_derivative(
    x: ArrayLike, orders: ArrayLike, dt: float, *, cutoff: float | None = None
) -> Array:
    """Differentiate records that hold whole periods, in steady state (Weyl).

    Exact to rounding for motion that is periodic over the record and sampled above twice its
    highest frequency. Anything else wraps round; see `band_limited_derivative`.

    Parameters
    ----------
    x : array_like, shape (..., N)
        Samples of whole periods: the sample after the last equals the first.
    orders : array_like, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    cutoff : float, optional
        Hz: low-pass that passes everything up to here and nothing above twice that.

    Returns
    -------
    ndarray, shape (K, ..., N)
        In units of x per second to the order. Orders below zero integrate the part without
        its mean.

    Raises
    ------
    InputError
        For orders outside [-1, 2], dt <= 0 or values that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.arange(100) / 100
    >>> y = spectral_derivative(np.sin(2 * np.pi * t), [1.0], 0.01)
    >>> bool(np.allclose(y[0], 2 * np.pi * np.cos(2 * np.pi * t)))
    True
    """
    values, step = checked_record(x, dt)
    alpha, _ = checked_orders(orders)
    n = values.shape[-1]
    frequency = scipy.fft.rfftfreq(n, step)
    factors = harmonic_factors(alpha, 2.0 * np.pi * frequency)
    if cutoff is not None:
        factors *= low_pass_gain(frequency, number("cutoff", cutoff, above=0.0))
    if n % 2 == 0:
        # The sample at the Nyquist frequency is the mean of +omega and -omega: the real part.
        factors[:, -1] = factors[:, -1].real
    spectrum = scipy.fft.rfft(values, axis=-1)
    shape = (alpha.size,) + (1,) * (values.ndim - 1) + (frequency.size,)
    rows = factors.reshape(shape) * spectrum
    return np.asarray(scipy.fft.irfft(rows, n=n, axis=-1), dtype=np.float64)


def low_pass_gain(frequency: Array, cutoff: float) -> Array:
    """Return the real gain of the low-pass: 1 up to the cut-off, smoothly to 0 at twice that.

    Examples
    --------
    >>> low_pass_gain(np.array([1.0, 3.0, 4.0]), 2.0).round(12)
    array([1. , 0.5, 0. ])
    """
    s = np.clip((frequency / cutoff - 1.0) / (TRANSITION - 1.0), 0.0, 1.0)
    # Rounding leaves less than nothing just below the end.
    return np.maximum(1.0 - s**4 * (35.0 - 84.0 * s + 70.0 * s**2 - 20.0 * s**3), 0.0)
