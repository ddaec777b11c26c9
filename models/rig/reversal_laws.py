"""Laws by which the seals of the rig reverse, u >= 0 the speed over one of the seal's own.

None is among the curves that discovery fits, nor near one: the tests hold them apart.
"""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.reversal import Reversal

_SLIP_SPEED = 10.0
_SECOND_SHARE, _SECOND_SPEED = 0.5, 10.0


def _parabola(u: Array) -> Array:
    """Return u (2 - u), 1 beyond u = 1.

    M. Li et al., *ACM Trans. Graphics* 39 (2020) 49, for contact with dry friction. Junctions that
    each shear a film up to a limit at a speed of their own add up to it where their number is
    in proportion to that speed, up to u = 1.
    """
    s = np.minimum(u, 1.0)
    return np.asarray(s * (2.0 - s))


def _parabola_slope(u: Array) -> Array:
    return np.asarray(2.0 * np.maximum(1.0 - u, 0.0))


def _activated(u: Array) -> Array:
    """Return arsinh(k u)/arsinh(k), k = 10, 1 beyond u = 1.

    A boundary film whose flow is thermally activated (H. Eyring, *J. Chem. Phys.* 4 (1936)
    283-291), up to the stress at which it slips (S. Bair and W. O. Winer, *J. Lubrication
    Technology* 101 (1979) 251-257).
    """
    return np.asarray(np.arcsinh(_SLIP_SPEED * np.minimum(u, 1.0)) / math.asinh(_SLIP_SPEED))


def _activated_slope(u: Array) -> Array:
    slope = _SLIP_SPEED / math.asinh(_SLIP_SPEED) / np.sqrt(1.0 + (_SLIP_SPEED * u) ** 2)
    return np.asarray(np.where(u < 1.0, slope, 0.0))


def _two_films(u: Array) -> Array:
    """Return (1 - w)(1 - exp(-u)) + w (1 - exp(-u/r)), w = 0.5, r = 10.

    Two lips, at the rod and at the piston, each with a film that shears up to its limiting stress
    (S. Bair and W. O. Winer, *J. Lubrication Technology* 101 (1979) 258-265) at its own speed.
    """
    first, second = -np.expm1(-u), -np.expm1(-u / _SECOND_SPEED)
    return np.asarray((1.0 - _SECOND_SHARE) * first + _SECOND_SHARE * second)


def _two_films_slope(u: Array) -> Array:
    first, second = np.exp(-u), np.exp(-u / _SECOND_SPEED) / _SECOND_SPEED
    return np.asarray((1.0 - _SECOND_SHARE) * first + _SECOND_SHARE * second)


def _fractal_spots(u: Array) -> Array:
    """Return u/2, 1 - 1/(2 u) beyond u = 1: the mean of min(1, u/X), 1/X even from 0 to 1.

    Elastic contact spots of a fractal profile, here of dimension 4/3 (A. Majumdar and B. Bhushan,
    *J. Tribology* 113 (1991) 1-11): the smaller a spot, the higher its pressure, and with it the
    stress that limits its film (S. Bair and W. O. Winer, *J. Lubrication Technology* 101 (1979)
    251-257), which it reaches at a speed X, 1 for the largest.
    """
    return np.asarray(np.where(u < 1.0, 0.5 * u, 1.0 - 0.5 / np.maximum(u, 1.0)))


def _fractal_spots_slope(u: Array) -> Array:
    return np.asarray(0.5 / np.maximum(u, 1.0) ** 2)


LAWS: tuple[Reversal, ...] = (
    Reversal("parabola", _parabola, _parabola_slope),
    Reversal("activated film", _activated, _activated_slope),
    Reversal("two films", _two_films, _two_films_slope),
    Reversal("fractal spots", _fractal_spots, _fractal_spots_slope),
)
"""Laws of this file: what a device of the rig draws from."""
