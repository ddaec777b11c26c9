"""Dry friction of the seals: smooth in speed, or with presliding and a Stribeck fall."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit

from models.checks import Array, number
from models.device import Device
from models.rig.reversal import Reversal
from models.rig.reversal_laws import LAWS

_HALF_SPEEDS = (0.8e-4, 1.6e-4)
_NANOMETRES = 1e9


@dataclass(frozen=True)
class Seal:
    """Properties of the seals."""

    sliding: float
    """Friction at high speed, N."""
    breakaway: float = 1.25
    """Static over sliding friction."""
    stribeck_speed: float = 0.008
    """Speed over which friction falls, m/s."""
    presliding: float = 6e-5
    """Displacement over which friction reverses, m."""
    half_speed: float = 1.2e-4
    """Speed at which the smooth law has reached half of `sliding`, m/s."""
    reversal: Reversal = LAWS[0]
    """How the smooth law gets there."""

    def __post_init__(self) -> None:
        """Refuse impossible seals."""
        number("sliding", self.sliding, at_least=0.0, where="seal")
        number("breakaway", self.breakaway, at_least=1.0, where="seal")
        for key in ("stribeck_speed", "presliding", "half_speed"):
            number(key, getattr(self, key), above=0.0, where="seal")


def draw_seal(device: Device, laws: Sequence[Reversal] = LAWS, *, stream: int = 0) -> Seal:
    """Draw how a device's seals reverse; they carry no friction yet.

    The radii that the seals are cut for, to a nanometre, are the seed: a device keeps its seals
    from campaign to campaign, and nothing else that a campaign draws depends on them.

    Parameters
    ----------
    device : Device
        Whose rod and cylinder the seals fit.
    laws : sequence of Reversal
        One of them is taken, each as likely; the half speed is log-uniform from 0.08 to 0.16 mm/s.
    stream : int
        Apart from other draws for the same radii.

    Examples
    --------
    >>> seal = draw_seal(Device.preset("device-12"))
    >>> seal.reversal in LAWS, 0.8e-4 < seal.half_speed < 1.6e-4
    (True, True)
    """
    radii = (device.rod_radius, device.cylinder_radius)
    rng = np.random.default_rng([stream, *(round(_NANOMETRES * radius) for radius in radii)])
    law = laws[int(rng.integers(len(laws)))]
    return Seal(
        sliding=0.0, half_speed=math.exp(rng.uniform(*np.log(_HALF_SPEEDS))), reversal=law
    )


def smooth_friction(seal: Seal, velocity: Array) -> Array:
    """Return f s(v/v_h), N, at velocities v of any shape, m/s.

    f is the seal's sliding friction, s its reversal and v_h its half speed.

    Examples
    --------
    >>> float(smooth_friction(Seal(sliding=400.0), np.array(1.0)).round(3))
    400.0
    """
    return np.asarray(seal.sliding * seal.reversal.share(velocity / seal.half_speed))


def presliding_friction(
    displacement: Array, velocity: Array, *, seal: Seal, passes: int = 2
) -> Array:
    """Return LuGre friction along a periodic motion, N.

    dz/dt = v - |v| z/g(v), F = f_c z/z_s with g = z_s (1 + (ratio - 1) exp(-|v|/v_s)): bristles
    that deflect over z_s before they slide. The step is exact for constant speed within it.

    Parameters
    ----------
    displacement, velocity : array, shape (G,)
        One period of the motion, m and m/s.
    seal : Seal
        Its properties.
    passes : int
        Periods that are run from rest; the last is returned.

    References
    ----------
    C. Canudas de Wit et al., *IEEE Trans. Automatic Control* 40 (1995) 419-425.
    """
    limit = 1.0 + (seal.breakaway - 1.0) * np.exp(-np.abs(velocity) / seal.stribeck_speed)
    steps = np.diff(displacement, prepend=displacement[-1]) / seal.presliding
    return np.asarray(seal.sliding * _bristles(steps, limit, passes))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _bristles(steps: Array, limit: Array, passes: int) -> Array:
    """Return the deflection in units of z_s for steps of displacement in the same unit."""
    size = steps.size
    result = np.empty(size)
    z = 0.0
    for _ in range(passes):
        for i in range(size):
            bound = limit[i] if steps[i] >= 0.0 else -limit[i]
            z = bound + (z - bound) * math.exp(-abs(steps[i]) / limit[i])
            result[i] = z
    return result
