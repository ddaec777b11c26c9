"""How dry friction reverses with velocity: an odd curve from -1 to 1, and its table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.optimize import brentq

from models.checks import Array, InputError

Curve = Callable[[Array], Array]
_TABLE = 4097
_FAR = 1e6
_NEAR = 1e-4


@dataclass(frozen=True)
class Reversal:
    """A law by which friction reverses, in terms of velocity over the speed at half force.

    Every law is scaled so that half of the limit is reached at the same speed, whatever it is
    written in: a law says how the force turns over, not how fast.

    Raises
    ------
    InputError
        For a curve that does not rise from 0 at rest to 1.

    Examples
    --------
    >>> line = Reversal("line", lambda u: np.minimum(u, 1.0), lambda u: np.where(u < 1.0, 1.0, 0.0))
    >>> line.share(np.array([-4.0, 0.0, 1.0])).round(9).tolist()
    [-1.0, 0.0, 0.5]
    """

    name: str
    """What the law is called."""
    rise: Curve
    """Share of the limit at the law's own variable u >= 0, of any shape: from 0 to 1, monotone."""
    slope: Curve
    """Its derivative to u, likewise, finite."""

    def __post_init__(self) -> None:
        """Refuse curves that are no share of a limit."""
        start, end = (float(self.rise(np.array(u))) for u in (0.0, _FAR))
        if start != 0.0 or not abs(end - 1.0) < _NEAR:
            raise InputError(
                "rise",
                expected=f"from 0 at rest to 1, and there at u = {_FAR:g}",
                found=f"{start:g} to {end:g}",
                where=f"reversal {self.name}",
            )

    @cached_property
    def half(self) -> float:
        """The law's own variable where half of the limit is reached."""
        return float(brentq(lambda u: float(self.rise(np.array(u))) - 0.5, 0.0, _FAR))

    def share(self, ratio: Array) -> Array:
        """Return the share of the limit, -1 to 1, at velocity over half speed, of any shape."""
        return np.asarray(np.copysign(self.rise(self.half * np.abs(ratio)), ratio))

    def share_slope(self, ratio: Array) -> Array:
        """Return the derivative of `share` to velocity over half speed, of any shape."""
        return np.asarray(self.half * self.slope(self.half * np.abs(ratio)))


# Kept: a table by the law's parameters, asked for by each record of a rig.
@lru_cache(maxsize=64)
def tabulate(law: Reversal) -> Array:
    """Return the law's shares (T,) at even steps of r/(1 + r), r speed over half speed.

    The last, at infinite speed, is 1; straight lines between them are within 2e-4 of the law.
    """
    place = np.linspace(0.0, 1.0, _TABLE)[:-1]
    table = np.append(law.share(place / (1.0 - place)), 1.0)
    table.flags.writeable = False
    return table
