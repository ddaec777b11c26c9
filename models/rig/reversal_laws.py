"""Laws by which the seals of the rig reverse, u >= 0 the speed over one of the seal's own.

None is among the curves that discovery fits, nor near one: the tests hold them apart.
"""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.reversal import Reversal

_STRESS = 10.0
_SECOND_SHARE, _SECOND_SPEED = 0.5, 10.0
_SMALL = 1e-2


def _parabola(u: Array) -> Array:
    """Return u (2 - u), 1 beyond u = 1.

    M. Li et al., *ACM Trans. Graphics* 39 (2020) 49, for contact with dry friction. Junctions that
    each shear a film up to a limit at a speed of their own add up to it where their number grows
    with that speed.
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
    return np.asarray(np.arcsinh(_STRESS * np.minimum(u, 1.0)) / math.asinh(_STRESS))


def _activated_slope(u: Array) -> Array:
    slope = _STRESS / math.asinh(_STRESS) / np.sqrt(1.0 + (_STRESS * u) ** 2)
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


def _alignment(u: Array) -> Array:
    """Return coth u - 1/u: u/3 - u^3/45 + 2 u^5/945 where small.

    Mean alignment of independent carriers, here chains of the rubber's surface, that shear turns
    its way against thermal agitation (P. Langevin, *Ann. Chim. Phys.* 5 (1905) 70-127).
    """
    large = np.maximum(u, _SMALL)
    small = np.minimum(u, _SMALL)
    series = small / 3.0 - small**3 / 45.0 + 2.0 * small**5 / 945.0
    # coth u = 1 + 2 exp(-2u)/(1 - exp(-2u)) does not overflow; the series does not cancel.
    fall = np.exp(-2.0 * large)
    exact = 1.0 - 2.0 * fall / np.expm1(-2.0 * large) - 1.0 / large
    return np.asarray(np.where(u < _SMALL, series, exact))


def _alignment_slope(u: Array) -> Array:
    large = np.maximum(u, _SMALL)
    fall = np.exp(-2.0 * large)
    small = np.minimum(u, _SMALL)
    series = 1.0 / 3.0 - small**2 / 15.0 + 2.0 * small**4 / 189.0
    exact = 1.0 / large**2 - 4.0 * fall / np.expm1(-2.0 * large) ** 2
    return np.asarray(np.where(u < _SMALL, series, exact))


LAWS: tuple[Reversal, ...] = (
    Reversal("parabola", _parabola, _parabola_slope),
    Reversal("activated film", _activated, _activated_slope),
    Reversal("two films", _two_films, _two_films_slope),
    Reversal("alignment", _alignment, _alignment_slope),
)
"""Laws of this file: what a device of the rig draws from."""
