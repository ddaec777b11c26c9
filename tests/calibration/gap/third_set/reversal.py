"""Laws by which the seals of the third set reverse, u >= 0 the speed over one of the seal's own."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import gamma, gammainc

from models.checks import Array
from models.device import Device
from models.rig.reversal import Reversal
from models.rig.seal import Seal, draw_seal

_STREAM = 3
_DECADES = 0.02
_ORDER = 1.6
_WORN = 0.25
_WIPER = 0.3, 12.0


def _decades(u: Array) -> Array:
    """Return the mean of min(1, u/X), ln X even from ln a to 0: junctions of many sizes."""
    s = np.clip(u, _DECADES, 1.0)
    whole = math.log(1.0 / _DECADES)
    slow = u * (1.0 / _DECADES - 1.0)
    risen = np.where(u < _DECADES, slow, np.log(s / _DECADES) + 1.0 - s) / whole
    return np.asarray(np.minimum(risen, 1.0))  # rounding


def _decades_slope(u: Array) -> Array:
    return np.asarray((1.0 / np.clip(u, _DECADES, 1.0) - 1.0) / math.log(1.0 / _DECADES))


def _breaking(u: Array) -> Array:
    """Return the share of junctions that have let go, their speeds after gamma distributions.

    Worn ones let go from rest on.
    """
    return np.asarray((1.0 - _WORN) * gammainc(_ORDER, u) - _WORN * np.expm1(-u))


def _breaking_slope(u: Array) -> Array:
    fresh = u ** (_ORDER - 1.0) / gamma(_ORDER)
    return np.asarray(((1.0 - _WORN) * fresh + _WORN) * np.exp(-u))


def _wiper(u: Array) -> Array:
    """Return a lip's film, 1 - exp(-u), beside a wiper that drags a film up to its limit."""
    share, reach = _WIPER
    return np.asarray(-(1.0 - share) * np.expm1(-u) + share * np.minimum(u / reach, 1.0))


def _wiper_slope(u: Array) -> Array:
    share, reach = _WIPER
    return np.asarray((1.0 - share) * np.exp(-u) + share / reach * (u < reach))


THIRD_LAWS: tuple[Reversal, ...] = (
    Reversal("decades", _decades, _decades_slope),
    Reversal("breaking", _breaking, _breaking_slope),
    Reversal("wiper", _wiper, _wiper_slope),
)
"""Laws of this file: what a device of the third set draws from."""


def third_seal(device: Device) -> Seal:
    """Draw how a device's seals reverse, as the rig does, from the laws of this file."""
    return draw_seal(device, THIRD_LAWS, stream=_STREAM)
