"""Laws by which the seals of the second set reverse: none of the rig's, nor of discovery's.

u >= 0 is the speed over one of the seal's own.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import erf

from models.checks import Array
from models.device import Device
from models.rig.reversal import Reversal
from models.rig.seal import Seal, draw_seal

_STREAM = 2
_SLOWEST = 0.1
_HEIGHTS = 0.5, 6.0
_LIPS = 0.4, 10.0


def _spread(u: Array) -> Array:
    """Return the mean of min(1, u/X), X even from a to 1, a = 0.1.

    Junctions that each shear their film up to a limit, over speeds that spread as their heights do
    (after J. A. Greenwood and J. B. P. Williamson, *Proc. R. Soc. A* 295 (1966) 300-319).
    """
    s = np.clip(u, _SLOWEST, 1.0)
    risen = s - _SLOWEST - s * np.log(s)
    return np.asarray(
        np.where(u < _SLOWEST, -u * math.log(_SLOWEST), risen) / (1.0 - _SLOWEST)
    )


def _spread_slope(u: Array) -> Array:
    return np.asarray(-np.log(np.clip(u, _SLOWEST, 1.0)) / (1.0 - _SLOWEST))


def _two_heights(u: Array) -> Array:
    """Return (1 - w) erf(u) + w erf(u/r), w = 0.5, r = 6.

    Two populations of asperities of Gaussian heights (Greenwood and Williamson 1966), each of
    friction along the error function (N. Mostaghel and T. Davis, *Earthquake Engng Struct. Dyn.*
    26 (1997) 541-548).
    """
    share, ratio = _HEIGHTS
    return np.asarray((1.0 - share) * erf(u) + share * erf(u / ratio))


def _two_heights_slope(u: Array) -> Array:
    share, ratio = _HEIGHTS
    each = (1.0 - share) * np.exp(-(u**2)) + share / ratio * np.exp(-((u / ratio) ** 2))
    return np.asarray(2.0 / math.sqrt(math.pi) * each)


def _two_lips(u: Array) -> Array:
    """Return (2/pi) ((1 - w) arctan(u) + w arctan(u/r)), w = 0.4, r = 10.

    A lip and its wiper, each along the arctangent (Mostaghel and Davis 1997), of which the wiper,
    with less preload on more oil, takes longer.
    """
    share, ratio = _LIPS
    return np.asarray(
        2.0 / math.pi * ((1.0 - share) * np.arctan(u) + share * np.arctan(u / ratio))
    )


def _two_lips_slope(u: Array) -> Array:
    share, ratio = _LIPS
    each = (1.0 - share) / (1.0 + u**2) + share / ratio / (1.0 + (u / ratio) ** 2)
    return np.asarray(2.0 / math.pi * each)


SECOND_LAWS: tuple[Reversal, ...] = (
    Reversal("spread", _spread, _spread_slope),
    Reversal("two heights", _two_heights, _two_heights_slope),
    Reversal("two lips", _two_lips, _two_lips_slope),
)
"""Laws of this file: what a device of the second set draws from."""


def second_seal(device: Device) -> Seal:
    """Draw how a device's seals reverse, as the rig does, from the laws of this file."""
    return draw_seal(device, SECOND_LAWS, stream=_STREAM)
