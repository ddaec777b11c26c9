"""What a force law amounts to under a sine: an inertance and a damping per frequency (Eq. 8).

Equation numbers are those of Chen & Chen, *Materials* 2025, 18(11), 2556.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array, InputError, finite_array, number
from models.constitutive import ForceModel
from models.motion import sine_motion


class Equivalents(NamedTuple):
    """The fundamental of a force as F = inertance a + damping v."""

    inertance: Array
    """kg; negative where the law acts as a spring, of stiffness -omega^2 times it."""
    damping: Array
    """N s/m."""


def _positive(name: str, values: ArrayLike) -> Array:
    result = finite_array(name, values)
    if np.any(result <= 0.0):
        raise InputError(name, expected="> 0", found=f"{float(result.min())}")
    return result


def fractional_equivalents(coefficient: float, order: float, omega: ArrayLike) -> Equivalents:
    """Return the inertance and damping of coefficient times D^order x under a sine (Eq. 8).

    Inertance C omega^(order-2) sin((order-1) pi/2), damping C omega^(order-1) cos((order-1) pi/2),
    of the steady state (Weyl) derivative. Their ratio, omega inertance/damping = tan((order-1)
    pi/2), holds the order alone, whatever the frequency.

    Parameters
    ----------
    coefficient : float
        [b (1 + b0)], N s^order/m.
    order : float
        In [0, 2]. The paper states 1 < order < 2; below one the inertance is negative.
    omega : array_like, any shape
        Angular frequency, rad/s, above zero.

    Returns
    -------
    Equivalents
        Inertance, kg, and damping, N s/m, shape of `omega`.

    Raises
    ------
    InputError
        Where the order is outside [0, 2] or a frequency not above zero.

    Examples
    --------
    >>> mass = fractional_equivalents(370.0, 2.0, 10.0)
    >>> round(float(mass.inertance), 9), abs(float(mass.damping)) < 1e-9
    (370.0, True)
    """
    number("coefficient", coefficient)
    number("order", order, at_least=0.0, at_most=2.0)
    w = _positive("omega", omega)
    angle = (order - 1.0) * math.pi / 2.0
    return Equivalents(
        inertance=np.asarray(coefficient * w ** (order - 2.0) * math.sin(angle)),
        damping=np.asarray(coefficient * w ** (order - 1.0) * math.cos(angle)),
    )


def harmonic_equivalents(
    model: ForceModel, amplitude: float, omega: ArrayLike, *, samples: int = 1024
) -> Equivalents:
    """Return the inertance and damping of any force model under A0 sin(omega t).

    The fundamental of the force, by Fourier sum over one cycle: for friction and nonlinear damping
    this is the describing function, so the answer depends on the amplitude.

    Parameters
    ----------
    model : ForceModel
        Any sum of terms.
    amplitude : float
        A0, m.
    omega : array_like, any shape
        Angular frequency, rad/s, above zero.
    samples : int
        Samples of the cycle; the error falls with their square (friction) or faster.

    Returns
    -------
    Equivalents
        Inertance, kg, and damping, N s/m, shape of `omega`.

    Raises
    ------
    InputError
        For an amplitude or a frequency that is not above zero.

    Examples
    --------
    >>> from models.constitutive import foim
    >>> from models.device import Device
    >>> model = foim(Device.preset("device-12"), 0.57, 1.89, friction=0.0)
    >>> whole = harmonic_equivalents(model, 0.005, 75.0)
    >>> part = fractional_equivalents(model.terms[0].coefficient, 1.89, 75.0)
    >>> [bool(np.isclose(a, b)) for a, b in zip(whole, part, strict=True)]
    [True, True]
    """
    number("amplitude", amplitude, above=0.0)
    w = _positive("omega", omega)
    flat = np.ravel(w)
    stiffness = np.empty(flat.shape, dtype=np.complex128)
    turn = np.exp(-2j * np.pi * np.arange(samples) / samples)
    for k, value in enumerate(flat):
        force = model.force(sine_motion(amplitude, value / (2.0 * math.pi), samples=samples))
        # x = A0 sin(omega t) has the phasor -i A0.
        stiffness[k] = (2.0 / samples) * np.dot(force, turn) / (-1j * amplitude)
    return Equivalents(
        inertance=np.asarray((-stiffness.real / flat**2).reshape(w.shape)),
        damping=np.asarray((stiffness.imag / flat).reshape(w.shape)),
    )


def order_by_phase(equivalents: Equivalents, omega: ArrayLike) -> Array:
    """Return the order whose derivative has the same phase as inertance and damping together.

    1 + (2/pi) atan2(omega inertance, damping): 1 for a damper, 2 for an inerter, 0 for a spring.

    Parameters
    ----------
    equivalents : Equivalents
        Of any model or device.
    omega : array_like, broadcastable to them
        Angular frequency, rad/s.

    Returns
    -------
    array, shape of `omega`

    Examples
    --------
    >>> float(order_by_phase(fractional_equivalents(580.0, 1.89, 75.0), 75.0).round(9))
    1.89
    """
    w = _positive("omega", omega)
    angle = np.arctan2(w * equivalents.inertance, equivalents.damping)
    return np.asarray(1.0 + angle * 2.0 / math.pi)
