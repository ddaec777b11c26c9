"""The value that every term is a function of: a motion and how to differentiate it.

The kind of record decides the operator (see ``design.md``): a sine test is differentiated exactly,
harmonic by harmonic, from minus infinity (Weyl); a sampled record by a causal, spectral or
band-limited scheme. A term only ever sees a `Motion`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, InputError, finite_array, number
from models.fractional import derivative, harmonic_factors

SampledKind = Literal["caputo", "riemann-liouville", "grunwald-letnikov", "weyl"]


@dataclass(frozen=True)
class Motion:
    """Displacement of the device's ends with its derivatives of any order.

    Examples
    --------
    >>> motion = harmonic_motion([0.0, -0.005j], 2.0, samples=8)
    >>> float(motion.velocity[0].round(6))
    0.062832
    """

    time: Array
    """(N,) s, uniform."""
    displacement: Array
    """(N,) m."""
    velocity: Array
    """(N,) m/s."""
    acceleration: Array
    """(N,) m/s^2."""
    differentiate: Callable[[Array], Array]
    """Maps orders (K,) to derivatives of the displacement (K, N), in m/s^order."""
    operator: str
    """Which fractional derivative: "weyl", "caputo", "band-limited", ..."""
    periodic: bool = False
    """True where the samples are whole periods of a steady state."""
    test: int = 0
    """Number of the record in its campaign, from 1; 0 where it isn't known."""
    sampling: float = 0.0
    """s, sampling interval of the record that it belongs to; 0 where it is its own `step`."""
    kept: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)
    """What terms have found out about this motion, by module; it goes with the motion, and no copy
    has it."""

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy, or another process, is given."""
        return {**self.__dict__, "kept": {}}

    @property
    def step(self) -> float:
        """Sampling interval, s."""
        return float((self.time[-1] - self.time[0]) / (self.time.size - 1))

    def fractional(self, orders: ArrayLike) -> Array:
        """Return the derivatives of the displacement of `orders`, (K, N); scalar order: (N,)."""
        wanted = finite_array("order", orders)
        values = self.differentiate(np.atleast_1d(wanted))
        return values[0] if wanted.ndim == 0 else values


def harmonic_motion(
    coefficients: ArrayLike, frequency: float, *, samples: int = 512, cycles: int = 1
) -> Motion:
    """Return the steady-state motion x(t) = Re sum_k c_k exp(i 2 pi k f t).

    Parameters
    ----------
    coefficients : array_like of complex, shape (H + 1,)
        Mean and harmonics, m.
    frequency : float
        Fundamental f, Hz.
    samples : int
        Samples per cycle.
    cycles : int
        Whole cycles.

    Returns
    -------
    Motion
        Exact to round-off for every order (the Weyl derivative of each harmonic).

    Raises
    ------
    InputError
        For a frequency that is not above zero, and fewer than two samples a cycle of the highest
        harmonic.

    Examples
    --------
    >>> motion = harmonic_motion([0.0, 0.01], 2.0, samples=8)
    >>> motion.displacement[:2].round(3).tolist()
    [0.01, 0.007]
    """
    values = np.atleast_1d(np.asarray(coefficients, dtype=np.complex128))
    number("frequency", frequency, above=0.0)
    if values.size >= samples / 2:
        raise InputError(
            "samples", expected=f"more than twice {values.size - 1} harmonics", found=f"{samples}"
        )
    omega = 2.0 * np.pi * frequency * np.arange(values.size)
    time = np.arange(samples * cycles) / (samples * frequency)

    def synthesise(spectra: NDArray[np.complex128]) -> Array:
        padded = np.zeros((spectra.shape[0], samples // 2 + 1), dtype=np.complex128)
        padded[:, : values.size] = spectra * (samples / 2.0)
        padded[:, 0] = spectra[:, 0].real * samples
        cycle = np.fft.irfft(padded, n=samples, axis=1)
        return np.tile(cycle, (1, cycles))

    def differentiate(orders: Array) -> Array:
        return synthesise(harmonic_factors(orders, omega) * values)

    x, v, a = differentiate(np.array([0.0, 1.0, 2.0]))
    return Motion(time, x, v, a, differentiate, "weyl", periodic=True)


def sine_motion(
    amplitude: float, frequency: float, *, samples: int = 512, cycles: int = 1
) -> Motion:
    """Return x(t) = A0 sin(2 pi f t), the steady state that the paper's figures use.

    Parameters
    ----------
    amplitude : float
        A0, m.
    frequency : float
        f, Hz, above zero.
    samples : int
        Samples per cycle.
    cycles : int
        Whole cycles.

    Returns
    -------
    Motion
        Of ``samples * cycles`` samples from t = 0.

    Raises
    ------
    InputError
        For a frequency that is not above zero.

    Examples
    --------
    >>> float(abs(sine_motion(0.02, 0.5).velocity).max().round(5))
    0.06283
    """
    return harmonic_motion([0.0, -1j * amplitude], frequency, samples=samples, cycles=cycles)


def sampled_motion(
    time: ArrayLike, displacement: ArrayLike, *, kind: SampledKind = "caputo"
) -> Motion:
    """Return the motion of a clean, uniformly sampled displacement.

    For noisy records use ``discover.motion_fit``, which chooses the band from the noise.

    Parameters
    ----------
    time : array_like, shape (N,)
        s, in equal steps; three samples or more.
    displacement : array_like, shape (N,)
        m.
    kind : str
        Operator of the derivatives, as in `models.fractional.derivative`: "caputo",
        "riemann-liouville", "grunwald-letnikov" (from rest) or "weyl" (periodic).

    Returns
    -------
    Motion
        Velocity and acceleration are derivatives of the displacement by that operator.

    Raises
    ------
    InputError
        Where a value is not finite, or the two differ in shape.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 1.0, 201)
    >>> motion = sampled_motion(t, 0.5 * t**2)
    >>> float(motion.velocity[-1].round(3))
    1.0
    """
    t = finite_array("time", time, ndim=1, min_size=3)
    x = finite_array("displacement", displacement, ndim=1, min_size=3)
    if x.shape != t.shape:
        raise InputError("displacement", expected=f"of shape {t.shape}", found=f"{x.shape}")
    dt = float((t[-1] - t[0]) / (t.size - 1))

    def differentiate(orders: Array) -> Array:
        return np.asarray(derivative(x, orders, dt, kind=kind))

    v, a = differentiate(np.array([1.0, 2.0]))
    return Motion(t, x, v, a, differentiate, kind, periodic=kind == "weyl")
