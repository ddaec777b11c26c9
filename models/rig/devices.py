"""Devices for studies: drawn at random within what is built."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from models.device import Device, Fluid

_INERTANCE = (40.0, 800.0)
_VISCOUS = 8e3


def random_device(rng: np.random.Generator, *, name: str = "") -> Device:
    """Draw a device that a usual rig can test.

    Parameters
    ----------
    rng : Generator
        The only source of randomness.
    name : str
        What the device is called.

    Returns
    -------
    Device
        Inertance 40 to 800 kg and laminar damping c2 under 8 kN s/m; dry friction is 2 to 8 % of
        the inertial force at 10 m/s^2.

    Examples
    --------
    >>> device = random_device(np.random.default_rng(0))
    >>> 40.0 < device.inertance < 800.0
    True
    """
    while True:
        rod = rng.uniform(0.008, 0.018)
        channel = rng.uniform(0.0035, 0.008)
        device = Device(
            rod_radius=rod,
            cylinder_radius=rod + rng.uniform(0.008, 0.02),
            channel_radius=channel,
            helix_radius=rng.uniform(0.07, 0.15),
            helix_pitch=2.0 * channel * rng.uniform(1.1, 2.0),
            turns=float(rng.integers(5, 17)),
            fluid=Fluid(rng.uniform(780.0, 880.0), math.exp(rng.uniform(*np.log([2e-3, 5e-2])))),
            transition_length=rng.uniform(0.0, 0.1),
            piston_clearance=rng.uniform(5e-5, 2e-4),
            name=name,
        )
        low, high = _INERTANCE
        if low < device.inertance < high and device.laminar_coefficients.c2 < _VISCOUS:
            share = rng.uniform(0.02, 0.08)
            return replace(device, coulomb_friction=10.0 * share * device.inertance)
