"""Reynolds and Dean numbers in both conventions, and the critical frequency (Eqs. 12 to 16).

"standard" is Re = rho d u/mu and De = Re sqrt(d/D) with channel diameter d = 2 r3, helix diameter
D = 2 r4 and mean channel speed u = v S1/S2. "paper" is the definition of Chen & Chen, *Materials*
2025, 18(11), 2556: twice this Re, and 2 sqrt(2) times this De.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import InputError, finite_array, number, one_of
from models.device import Device

Array = NDArray[np.float64]

CONVENTIONS = ("paper", "standard")
"""The two definitions of Reynolds and Dean number."""


def reynolds_per_speed(device: Device, *, convention: str = "paper") -> float:
    """Return Re/v, s/m: Reynolds number of the channel for one metre a second of the piston.

    Examples
    --------
    >>> round(reynolds_per_speed(Device.preset("device-12"), convention="standard"), 1)
    7585.2
    """
    one_of("convention", convention, CONVENTIONS)
    kinematic = device.fluid.kinematic_viscosity
    standard = 2.0 * device.channel_radius * device.area_ratio / kinematic
    return 2.0 * standard if convention == "paper" else standard


def dean_per_speed(device: Device, *, convention: str = "paper") -> float:
    """Return De/v, s/m: Dean number of the channel for one metre a second of the piston.

    Eq. 14, De = Re sqrt(2 r3/r4), with the paper's Re; or the standard Re sqrt(r3/r4).

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    convention : str
        "paper" or "standard".

    Returns
    -------
    float
        s/m.

    Raises
    ------
    InputError
        For an unknown convention.

    Examples
    --------
    >>> round(dean_per_speed(Device.preset("device-12")))
    4797
    """
    ratio = device.curvature_ratio
    factor = math.sqrt(2.0 * ratio) if convention == "paper" else math.sqrt(ratio)
    return reynolds_per_speed(device, convention=convention) * factor


def reynolds(device: Device, speed: ArrayLike, *, convention: str = "paper") -> Array:
    """Return the channel's Reynolds number (Eqs. 12 and 13) at a piston speed.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    speed : array_like, any shape
        Piston speed, m/s; its sign is dropped.
    convention : str
        "paper", Re = 2 rho D_h S1/(mu S2) v with D_h = 2 r3, or "standard", half of it.

    Returns
    -------
    array, shape of `speed`

    Raises
    ------
    InputError
        For an unknown convention.

    Examples
    --------
    >>> float(reynolds(Device.preset("device-12"), -0.1, convention="standard").round(1))
    758.5
    """
    value = np.abs(finite_array("speed", speed))
    return np.asarray(value * reynolds_per_speed(device, convention=convention))


def dean(device: Device, speed: ArrayLike, *, convention: str = "paper") -> Array:
    """Return the channel's Dean number (Eq. 14) at a piston speed; see `reynolds`.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    speed : array_like, any shape
        Piston speed, m/s; its sign is dropped.
    convention : str
        "paper" or "standard".

    Returns
    -------
    array, shape of `speed`

    Raises
    ------
    InputError
        For an unknown convention.

    Examples
    --------
    >>> speed = 2 * math.pi * 0.5 * 0.02       # 0.5 Hz, 20 mm
    >>> float(dean(Device.preset("device-12"), speed, convention="paper").round(0))
    301.0
    >>> float(dean(Device.preset("device-12"), speed, convention="standard").round(0))
    107.0
    """
    value = np.abs(finite_array("speed", speed))
    return np.asarray(value * dean_per_speed(device, convention=convention))


def critical_speed(device: Device, *, dean: float = 100.0, convention: str = "paper") -> float:
    """Return the piston speed at which the channel reaches a Dean number, m/s.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    dean : float
        Above zero.
    convention : str
        "paper" or "standard".

    Returns
    -------
    float
        m/s.

    Raises
    ------
    InputError
        For a Dean number that is not above zero, and an unknown convention.

    Examples
    --------
    >>> round(critical_speed(Device.preset("device-12")), 5)
    0.02085
    """
    criterion = number("dean", dean, above=0.0)
    return criterion / dean_per_speed(device, convention=convention)


def critical_frequency(
    device: Device, amplitude: ArrayLike, *, dean: float = 100.0, convention: str = "paper"
) -> Array:
    """Return the frequency at which a sine motion's peak speed reaches a Dean number (Eq. 16).

    f_low = De/(8 sqrt(2) pi A0) (mu/rho) sqrt(r3 r4)/(r2^2 - r1^2) in the paper's convention.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    amplitude : array_like, any shape
        Displacement amplitude A0, m, above zero.
    dean : float
        The criterion.
    convention : str
        "paper" or "standard".

    Returns
    -------
    array, shape of `amplitude`
        Frequency, Hz: inversely proportional to the amplitude.

    Raises
    ------
    InputError
        Where an amplitude is zero or negative, or the convention unknown.

    Examples
    --------
    >>> critical_frequency(Device.preset("device-12"), [0.005, 0.02]).round(3).tolist()
    [0.664, 0.166]
    """
    values = finite_array("amplitude", amplitude)
    if np.any(values <= 0.0):
        raise InputError("amplitude", expected="above 0 m", found=f"{float(values.min())} m")
    speed = critical_speed(device, dean=dean, convention=convention)
    return np.asarray(speed / (2.0 * math.pi * values))
