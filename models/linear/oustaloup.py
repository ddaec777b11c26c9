"""Rational approximations of s^order over a band, with the error that they make there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array, InputError, number
from models.linear.dynamic import Complex

_REFINED_B, _REFINED_D = 10.0, 9.0


@dataclass(frozen=True)
class RationalPower:
    """s^order ~ s^whole * gain * prod (s + zeros)/(s + poles), in the band."""

    order: float
    """In (0, 2)."""
    band: tuple[float, float]
    """rad/s, where `error` holds."""
    whole: int
    """Exact factors of s: 1 for orders from one."""
    zeros: Array
    """(P,) rad/s, less the zeros of the transfer function; all on the negative real axis."""
    poles: Array
    """(P,) rad/s, likewise less the poles."""
    gain: float
    """Of the proper factor at infinite frequency."""
    error: float
    """Largest |approximation/exact - 1| over the band, the phase included."""

    def __call__(self, s: ArrayLike) -> Complex:
        """Return the approximation at complex `s`, rad/s."""
        points = np.asarray(s, dtype=np.complex128)[..., None]
        factor = np.prod((points + self.zeros) / (points + self.poles), axis=-1)
        return np.asarray(self.gain * points[..., 0] ** self.whole * factor)

    @property
    def residues(self) -> Array:
        """(P,) r of gain + sum r/(s + pole): the proper factor in partial fractions."""
        result = np.empty(self.poles.size)
        for i, pole in enumerate(self.poles):
            others = np.delete(self.poles, i) - pole
            # One zero to one pole, so that the product neither overflows nor vanishes.
            ratios = np.delete(self.zeros - pole, i) / others
            result[i] = self.gain * (self.zeros[i] - pole) * np.prod(ratios)
        return result

    def to_control(self) -> Any:
        """Return a `control.TransferFunction`; needs the extra ``control``.

        Raises
        ------
        InputError
            Where python-control is not installed.
        """
        control = import_control()
        s_power = np.zeros(self.whole)
        return control.zpk(np.concatenate([-self.zeros, s_power]), -self.poles, self.gain)


def import_control() -> Any:
    """Return the module, or raise `InputError` that says how to get it."""
    try:
        import control
    except ModuleNotFoundError:
        raise InputError(
            "python-control", expected="installed (pip install 'inerter-discovery[control]')",
            found="nothing",
        ) from None  # fmt: skip
    return control


def oustaloup(
    order: float,
    band: tuple[float, float],
    *,
    pairs: int = 15,
    margin: float = 10.0,
    refined: bool = True,
) -> RationalPower:
    """Return Oustaloup's recursive approximation of s^order, or Xue's refined one.

    Poles and zeros alternate, evenly in the logarithm of frequency, over a band that is `margin`
    times wider at either end than the one in which the error is stated.

    Parameters
    ----------
    order : float
        0 < order < 2, not one. Above one an exact factor s is split off.
    band : tuple of float
        Lowest and highest rate, rad/s.
    pairs : int
        Poles and zeros, each.
    margin : float
        At least one; one is the textbook form, whose error peaks at the ends of the band.
    refined : bool, optional
        Xue's correction at the ends, one more pair of poles and zeros.

    Returns
    -------
    RationalPower
        Gain, zeros and poles, rad/s, with its error in the band.

    Raises
    ------
    InputError
        For an order, a band or a number of pairs out of range.

    References
    ----------
    Oustaloup, Levron, Mathieu, Nanot, *Frequency-band complex noninteger differentiator*, IEEE
    Trans. Circuits Syst. I 47 (2000) 25-39. Xue, Zhao, Chen, *A modified approximation method of
    fractional order system*, ICMA 2006.

    Examples
    --------
    >>> half = oustaloup(0.5, (0.1, 100.0), pairs=20)
    >>> half.error < 2e-3
    True
    >>> bool(abs(half(3j) / 3j**0.5 - 1) <= half.error)
    True
    """
    number("order", order, above=0.0, below=2.0)
    number("margin", margin, at_least=1.0)
    low = number("lower end of the band", band[0], above=0.0)
    high = number("upper end of the band", band[1], above=low)
    if order == 1.0:
        raise InputError("order", expected="not whole: s is rational already", found="1")
    if pairs < 1:
        raise InputError("pairs", expected=">= 1", found=f"{pairs}")
    whole = int(order > 1.0)
    alpha = order - whole
    bottom, top = low / margin, high * margin
    spread = _REFINED_B / _REFINED_D if refined else 1.0
    bottom, top = bottom / spread, top * spread
    ratio = top / bottom
    k = np.arange(pairs, dtype=np.float64)
    zeros = bottom * ratio ** ((k + 0.5 * (1.0 - alpha)) / pairs)
    poles = bottom * ratio ** ((k + 0.5 * (1.0 + alpha)) / pairs)
    gain = top**alpha
    if refined:
        # (d s^2 + b h s)/(d (1 - alpha) s^2 + b h s + d alpha), h the band's upper end, all rates
        # over the middle of the band. It is one inside the band, and so is the gain's correction:
        # the original's (d/b)^(2 alpha) would shift the whole band.
        b, d, unit = _REFINED_B, _REFINED_D, math.sqrt(top * bottom)
        reach = b * top / spread / unit
        roots = np.roots([d * (1.0 - alpha), reach, d * alpha])
        zeros = np.concatenate([zeros, unit * np.array([0.0, reach / d])])
        poles = np.concatenate([poles, -unit * roots.real])
        gain /= 1.0 - alpha
    trial = RationalPower(order, (low, high), whole, zeros, poles, gain, math.nan)
    # The error ripples once a pair; between grid points it exceeds the grid's by less than 1 %.
    grid = 1j * np.geomspace(low, high, 64 * pairs + 257)
    error = 1.01 * float(np.abs(trial(grid) / grid**order - 1.0).max())
    return RationalPower(order, (low, high), whole, zeros, poles, gain, error)
