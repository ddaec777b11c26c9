"""A power law that stands for a whole power: no measured flow tells them apart.

Its exponent is nearly whole, or beside friction's own curve linear damping leaves noise alone too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from discover.gap.doubt import share_of
from discover.gap.mending import mended
from discover.gap.reversing import noise_alone
from discover.naming.contest import Contest
from discover.naming.evidence import odds_of_a_parameter
from discover.naming.fit import ModelFit
from discover.naming.rows import RecordRows

POWER_LAW = "power-law-damping"
_LINEAR = "viscous-damping"
_WHOLE = {_LINEAR: 1.0, "quadratic-damping": 2.0}
_NEAR = 0.15  # of a whole power; that of turbulent flow in smooth pipes, 1.75, is further
_LIKELIER = 3.0  # times is a whole power, before any test, than another one near it
_LOW = 1.0  # exponent, below which a law is like friction's approach to its limit


@dataclass(frozen=True)
class WholePower:
    """What a power law stands for."""

    name: str
    """Id of the whole power's effect."""
    contest: Contest
    """With what both have shared between them."""
    fit: ModelFit
    """With the whole power, mended."""


def as_whole_power(
    rows: Sequence[RecordRows],
    before: ModelFit,
    contest: Contest,
    fit: ModelFit,
    effects: Sequence[str],
) -> WholePower | None:
    """Return the whole power that a power law stands for; None where it is no whole one.

    Beside friction whose curve is not yet known the free exponent makes up for that. Each mended
    with a curve of its own, the whole power may leave what its shape may be wrong by.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    before : ModelFit
        Without the power law.
    contest : Contest
        That named it.
    fit : ModelFit
        With it, mended.
    effects : sequence of str
        Ids that may be named.
    """
    exponent = next(t.shape["exponent"] for t in fit.model.terms[::-1] if t.id == POWER_LAW)
    name = next((n for n, power in _WHOLE.items() if abs(exponent - power) < _NEAR), "")
    near = bool(name)
    name = _LINEAR if not near and exponent < _LOW else name
    if name not in effects or contest.best(name) is None:
        return None
    other = mended(rows, before, contest, name, None)
    tolerated = share_of(POWER_LAW) ** 2 * (before.chi2 - fit.chi2)
    if not other.chi2 - fit.chi2 < tolerated:
        return None
    if not near and not noise_alone(other):
        return None
    both = contest.probabilities[name] + contest.probabilities[POWER_LAW]
    odds = odds_of_a_parameter(contest.rows) * (_LIKELIER if near else 1.0)
    chances = {
        **contest.probabilities, name: both * odds / (1.0 + odds), POWER_LAW: both / (1.0 + odds),
    }
    return WholePower(name, replace(contest, probabilities=chances), other)
