"""Steady friction in the helical channel, from the correlations collected in `fluids`.

Everything is written in f Re, which stays finite at rest (64, Poiseuille), where the Darcy factor f
alone doesn't; the correlations are called with |Re| only.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from fluids.friction import (
    friction_factor,
    helical_laminar_fd_Schmidt,
    helical_laminar_fd_White,
    helical_Re_crit,
    helical_turbulent_fd_Mori_Nakayama,
    helical_turbulent_fd_Schmidt,
)
from numpy.typing import ArrayLike, NDArray

from models.checks import finite_array, number, one_of
from models.device import Device
from models.flow.dimensionless import reynolds_per_speed

Array = NDArray[np.float64]

POISEUILLE = 64.0
"""f Re of steady laminar flow in a straight round pipe."""

LAMINAR: dict[str, Callable[..., float]] = {
    "white": helical_laminar_fd_White,
    "schmidt": helical_laminar_fd_Schmidt,
}
TURBULENT: dict[str, Callable[..., float]] = {
    "schmidt": helical_turbulent_fd_Schmidt,
    "mori-nakayama": helical_turbulent_fd_Mori_Nakayama,
}
TRANSITION = {
    "schmidt": "Schmidt",
    "ito": "Ito",
    "srinivasan": "Srinivasan",
    "seth-stahel": "Seth Stahel",
    "kubair-kuloor": "Kubair Kuloor",
    "kutateladze-borishanskii": "Kutateladze Borishanskii",
}
# Under this Reynolds number curvature can't be felt and the correlations divide by it.
_CREEP = 1e-9


def transition_reynolds(curvature: float, *, method: str = "schmidt") -> float:
    """Return the Reynolds number (standard) at which flow in a coil turns turbulent.

    Parameters
    ----------
    curvature : float
        Channel diameter over helix diameter, 0 for a straight pipe, below 1.
    method : str
        Whose correlation: one of `TRANSITION`. They differ widely (5,600 to 8,300 for one coil).

    Returns
    -------
    float

    Raises
    ------
    InputError
        For a curvature out of range, and an unknown method.

    Examples
    --------
    >>> round(transition_reynolds(0.05))
    7438
    >>> round(transition_reynolds(0.0))
    2300
    """
    ratio = number("curvature", curvature, at_least=0.0, below=1.0)
    one_of("method", method, TRANSITION, where="transition")
    return float(helical_Re_crit(Di=max(ratio, 1e-15), Dc=1.0, Method=TRANSITION[method]))


def friction_times_reynolds(
    reynolds: ArrayLike,
    *,
    curvature: float,
    laminar: str = "white",
    turbulent: str = "schmidt",
    transition: str = "schmidt",
    width: float = 0.15,
) -> Array:
    """Return Darcy factor times Reynolds number for steady flow in a coil, smooth over transition.

    Parameters
    ----------
    reynolds : array_like, any shape
        Standard Reynolds number; its sign is dropped, zero is allowed.
    curvature : float
        Channel diameter over helix diameter, 0 for a straight pipe.
    laminar : str
        "white" (Poiseuille below De = 11.6) or "schmidt" (meant for Re > 100).
    turbulent : str
        "schmidt" (tends to the straight pipe) or "mori-nakayama" (doesn't).
    transition : str
        Correlation of `transition_reynolds`.
    width : float
        Half width of the blend, in ln Re, above zero.

    Returns
    -------
    array, shape of `reynolds`

    Raises
    ------
    InputError
        For a curvature or width out of range, and an unknown correlation.

    Examples
    --------
    >>> friction_times_reynolds([0.0, -10.0], curvature=0.0).tolist()
    [64.0, 64.0]
    """
    value = np.abs(finite_array("reynolds", reynolds))
    ratio = number("curvature", curvature, at_least=0.0, below=1.0)
    number("width", width, above=0.0)
    low = LAMINAR[one_of("laminar", laminar, LAMINAR, where="friction")]
    high = TURBULENT[one_of("turbulent", turbulent, TURBULENT, where="friction")]
    centre = transition_reynolds(ratio, method=transition)
    begin, end = centre * math.exp(-width), centre * math.exp(width)

    def laminar_product(re: float) -> float:
        return re * low(re, ratio, 1.0) if ratio > 0.0 and re > _CREEP else POISEUILLE

    def turbulent_product(re: float) -> float:
        return re * (high(re, ratio, 1.0) if ratio > 0.0 else friction_factor(re))

    def product(re: float) -> float:
        if re <= begin:
            return laminar_product(re)
        if re >= end:
            return turbulent_product(re)
        s = math.log(re / begin) / (2.0 * width)
        weight = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
        return (1.0 - weight) * laminar_product(re) + weight * turbulent_product(re)

    flat = [product(float(re)) for re in value.ravel()]
    return np.asarray(flat, dtype=np.float64).reshape(value.shape)


def channel_force(
    device: Device,
    speed: ArrayLike,
    *,
    laminar: str = "white",
    turbulent: str = "schmidt",
    transition: str = "schmidt",
    width: float = 0.15,
) -> Array:
    """Return the piston force of steady channel friction, N, odd in the speed.

    F = S1 f (l/d) rho u|u|/2 over the helix, and the same with straight-pipe friction over the
    transition sections; under Poiseuille friction this is c2 v of Eq. 5 (for l alone).

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    speed : array_like, any shape
        Piston speed, m/s.
    laminar, turbulent, transition, width
        As in `friction_times_reynolds`.

    Returns
    -------
    array, shape of `speed`

    Raises
    ------
    InputError
        As `friction_times_reynolds`.

    Examples
    --------
    >>> device = Device.preset("device-12")
    >>> forces = channel_force(device, [-0.1, 0.0, 0.1])
    >>> bool(forces[0] == -forces[2]) and float(forces[1]) == 0.0
    True
    """
    value = finite_array("speed", speed)
    number_ = np.abs(value) * reynolds_per_speed(device, convention="standard")
    # Delta p = (f Re) mu l u/(2 d^2), so the force is linear in f Re, l and v.
    scale = device.annulus_area * device.area_ratio * device.fluid.viscosity
    scale /= 2.0 * (2.0 * device.channel_radius) ** 2
    helix = friction_times_reynolds(
        number_,
        curvature=device.curvature_ratio,
        laminar=laminar,
        turbulent=turbulent,
        transition=transition,
        width=width,
    )
    total = helix * device.channel_length
    if device.transition_length > 0.0:
        straight = friction_times_reynolds(number_, curvature=0.0, width=width)
        total = total + straight * 2.0 * device.transition_length
    return np.asarray(scale * total * value)
