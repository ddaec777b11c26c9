r"""Exact laminar oscillatory flow in a round pipe: impedance, its memory, its effective order.

With z = Wo sqrt(i) and Wo = R sqrt(omega rho/mu), the pressure drop per length over the flow is
mu/(pi R^4) times z^2 I0(z)/I2(z). Two identities of Bessel functions split it without cancellation:

    z^2 I0/I2 = 8 + z^2 + 2 z I3/I2,        2 z I3/I2 = sum over k of 4 z^2/(z^2 + j_{2,k}^2),

steady Poiseuille resistance, inertia of the plug, and the wall layer's memory, where j_{2,k} are
the zeros of J2: the memory is a sum of first-order lags, so it exists in time as in frequency.

References: J. R. Womersley, *J. Physiol.* 127 (1955) 553-563; W. Zielke, *J. Basic Eng.* 90 (1968)
109-115.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

from models.checks import InputError, finite_array, number, one_of
from models.device import Device

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

# Beyond this modulus the Bessel routines lose digits; the asymptotic series has error below 1e-13.
_LARGE = 1e4


def womersley_number(device: Device, frequency: ArrayLike) -> Array:
    """Return Wo = r3 sqrt(2 pi f rho/mu) of the channel.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    frequency : array_like, any shape
        Frequency, Hz; its sign is dropped.

    Returns
    -------
    array, shape of `frequency`

    Examples
    --------
    >>> float(womersley_number(Device.preset("device-12"), 1.0).round(3))
    2.157
    """
    value = np.abs(finite_array("frequency", frequency))
    kinematic = device.fluid.kinematic_viscosity
    return np.asarray(device.channel_radius * np.sqrt(2.0 * math.pi * value / kinematic))


def _argument(womersley: ArrayLike) -> ComplexArray:
    value = finite_array("womersley", womersley)
    if np.any(value < 0.0):
        raise InputError("womersley", expected=">= 0", found=f"{float(value.min())}")
    return np.asarray(value * np.exp(0.25j * math.pi))


def _ratio(upper: int, lower: int, z: ComplexArray) -> ComplexArray:
    """Return I_upper(z)/I_lower(z), upper = lower + 1, for |arg z| <= pi/4, stable throughout."""
    small = np.abs(z) < 1e-100
    inside = np.where(small | (np.abs(z) > _LARGE), 1.0, z)
    value = special.ive(upper, inside) / special.ive(lower, inside)
    inverse = np.asarray(1.0 / np.where(small, 1.0, z), dtype=np.complex128)
    series = _asymptotic(upper, inverse) / _asymptotic(lower, inverse)
    value = np.where(np.abs(z) > _LARGE, series, value)
    return np.asarray(np.where(small, z / (2.0 * upper), value))


def _asymptotic(order: int, inverse: ComplexArray) -> ComplexArray:
    """Return sqrt(2 pi z) exp(-z) I_order(z) by Hankel's series to 1/z^4."""
    m = 4.0 * order**2
    term = np.ones_like(inverse)
    total = term
    for k in range(1, 5):
        term = term * (-(m - (2.0 * k - 1.0) ** 2) / (8.0 * k)) * inverse
        total = total + term
    return np.asarray(total)


def normalised_impedance(womersley: ArrayLike, *, part: str = "total") -> ComplexArray:
    """Return the impedance per length of a round pipe, in units of mu/(pi R^4).

    Parameters
    ----------
    womersley : array_like, any shape
        Womersley number, at least zero.
    part : str
        "total" z^2 I0/I2; "steady" 8; "plug" z^2; "wall" 2 z I3/I2; "excess" = plug + wall, what
        exceeds the steady Poiseuille resistance.

    Returns
    -------
    complex array, shape of `womersley`

    Raises
    ------
    InputError
        For a Womersley number below zero, and an unknown part.

    Notes
    -----
    Low Wo: 8 + 4/3 i Wo^2. High Wo: i Wo^2 + 2 sqrt(i) Wo.

    Examples
    --------
    >>> complex(normalised_impedance(0.0))
    (8+0j)
    """
    one_of("part", part, ("total", "steady", "plug", "wall", "excess"), where="impedance")
    z = _argument(womersley)
    plug = 1j * z.imag**2 * 2.0
    if part == "steady":
        return np.full(z.shape, 8.0 + 0.0j)
    if part == "plug":
        return np.asarray(plug)
    wall = 2.0 * z * _ratio(3, 2, z)
    if part == "wall":
        return np.asarray(wall)
    return np.asarray(plug + wall + (8.0 if part == "total" else 0.0))


def effective_order(womersley: ArrayLike, *, by: str = "phase", part: str = "total") -> Array:
    """Return the order of the derivative of displacement that laminar pipe flow acts as.

    Parameters
    ----------
    womersley : array_like, any shape
        Womersley number, above zero for "amplitude" and "phase" alike.
    by : str
        "phase": (2/pi) arg of force over displacement, as D^order has the phase order pi/2;
        "amplitude": d ln|force| / d ln(frequency) at constant displacement.
    part : str
        "total": from 1 (viscous) to 2 (inertial); "drag", without the plug's inertia: from 1 to
        3/2 (Stokes layer).

    Returns
    -------
    array, shape of `womersley`

    Raises
    ------
    InputError
        For a Womersley number below zero, an unknown `by`, and an unknown part.

    Examples
    --------
    >>> effective_order([1e-4, 1e6]).round(4).tolist()
    [1.0, 2.0]
    >>> float(effective_order(1e6, part="drag", by="amplitude").round(4))
    1.5
    """
    one_of("by", by, ("phase", "amplitude"), where="effective order")
    one_of("part", part, ("total", "drag"), where="effective order")
    z = _argument(womersley)
    if by == "phase":
        total = normalised_impedance(womersley, part="total")
        wanted = total if part == "total" else 8.0 + normalised_impedance(womersley, part="wall")
        return np.asarray(1.0 + np.angle(wanted) * 2.0 / math.pi)
    # d/d ln(omega) = (z/2) d/dz; I_n' = I_{n-1} - (n/z) I_n.
    i32 = _ratio(3, 2, z)
    if part == "total":
        i10 = _ratio(1, 0, z)
        slope = 0.5 * z * (i10 - i32)
        # For large z the difference cancels: i10 - i32 = 2/z + O(1/z^2).
        far = np.abs(z) > _LARGE
        tail = 1.0 - 1.0 / np.where(far, z, 1.0)
        return np.asarray(1.0 + np.where(far, tail, slope).real)
    # d(z I3/I2)/d ln z = z I3/I2 + z^2 (1 - i32^2) - 5 z i32, from the two recurrences of I_n'.
    wall = z * i32
    far = np.abs(z) > _LARGE
    growth = np.where(far, z, wall + z**2 * (1.0 - i32**2) - 5.0 * wall)
    return np.asarray(1.0 + (growth / (8.0 + 2.0 * wall)).real)


def channel_impedance(device: Device, omega: ArrayLike, *, part: str = "total") -> ComplexArray:
    """Return piston force over piston velocity for laminar oscillation in the channel, N s/m.

    Parameters
    ----------
    device : Device
        Geometry and fluid; the channel is the helix, straightened, without transitions.
    omega : array_like, any shape
        Angular frequency, rad/s; negative ones give the conjugate.
    part : str
        As in `normalised_impedance`.

    Returns
    -------
    complex array, shape of `omega`

    Raises
    ------
    InputError
        For an unknown part.

    Examples
    --------
    >>> device = Device.preset("device-12")
    >>> resistance = channel_impedance(device, 0.0).real
    >>> bool(np.isclose(resistance, device.laminar_coefficients.c2))
    True
    """
    value = finite_array("omega", omega)
    wo = womersley_number(device, value / (2.0 * math.pi))
    impedance = normalised_impedance(wo, part=part) * impedance_scale(device)
    return np.asarray(np.where(value < 0.0, np.conj(impedance), impedance))


def excess_impedance(device: Device, omega: ArrayLike) -> ComplexArray:
    """Return `channel_impedance` less its steady Poiseuille resistance, N s/m.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    omega : array_like, any shape
        Angular frequency, rad/s.

    Returns
    -------
    complex array, shape of `omega`

    Examples
    --------
    >>> complex(excess_impedance(Device.preset("device-12"), 0.0))
    0j
    """
    return channel_impedance(device, omega, part="excess")


def impedance_scale(device: Device) -> float:
    """Return S1^2 l mu/(pi r3^4), N s/m: what a normalised impedance is multiplied with."""
    length = device.channel_length
    return (
        device.annulus_area**2
        * length
        * device.fluid.viscosity
        / (math.pi * device.channel_radius**4)
    )


class WallModes(NamedTuple):
    """The wall layer's memory as first-order lags: sum of gain iw/(iw + rate), plus a remainder."""

    rates: Array
    """Decay rates, rad/s, shape (K,)."""
    gain: float
    """Gain of each, N s/m."""
    remainder: float
    """Inertance of the modes left out, kg: they are too fast to lag."""


def wall_modes(device: Device, *, count: int = 32) -> WallModes:
    """Return the exact modes of the wall layer's force on the piston.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    count : int
        Number of modes kept; the next ones act as inertance.

    Returns
    -------
    WallModes
        Rates (1/s) and sizes, in rising rate.

    Raises
    ------
    InputError
        For a count below one.

    Examples
    --------
    >>> modes = wall_modes(Device.preset("device-12"), count=4)
    >>> modes.rates.round(1).tolist()
    [35.6, 95.6, 182.3, 295.5]
    """
    number("count", count, at_least=1)
    zeros = special.jn_zeros(2, count)
    time = device.channel_radius**2 / device.fluid.kinematic_viscosity
    scale = impedance_scale(device)
    # The squared inverse zeros of J2 sum to 1/12 (Rayleigh).
    rest = 1.0 / 12.0 - float(np.sum(zeros**-2.0))
    return WallModes(rates=zeros**2 / time, gain=4.0 * scale, remainder=4.0 * scale * time * rest)
