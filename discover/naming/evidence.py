"""What a hypothesis' fit says: its evidence, and the probabilities of all names."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.naming.candidates import Variant
from discover.naming.forces import in_record, is_joint
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm
from models.terms import Shape

AGREES = "agrees"
UNKNOWN = "unknown"
_TEMPERATURE = 3.0
_PRIOR_AGREES = 15.0
_NO_AGREEMENT = 300.0  # of chi-square above the noise: then it can't be called agreement
_UNKNOWN_SHARE = 0.6
_UNKNOWN_COST = 3.0
_LEFT = 0.08  # of the misfit, at which a shape is as likely the effect's as another's
LEFT_BY_JOINT = 0.3  # likewise: contact and loss are simplified, and impacts hard to meet
_LEFT_BY_PAIR = 0.5  # of these shares: two shapes that are not there leave less than one
_LEFT_OF_FEW = 0.8  # likewise, where records are few
FEW = 4  # records
_LEFT_BESIDE = 0.5  # likewise, beside shapes that were added before
_LEFT_SLOPE = 5.0  # of log odds in the share's: right and wrong ones hardly overlap
_LEFT_MOST = 4.0  # nats
_REFUTED = 40.0  # nats at most, that rows take back which an effect makes worse
_UNSEEN = 15.0  # nats that a change over time loses where none is seen inside the records
_SEEN = 10.0  # of chi-square, from which one is
_SLOW_FALL = 0.08  # m/s: seals' friction has fallen by then (mm/s to cm/s in the literature)
_UNUSUAL = 8.0  # nats for each factor of e above it


Evidence = Callable[[float, int], float]
"""Log evidence in nats, of a chi-square and a number of parameters."""


@dataclass(frozen=True)
class Entry:
    """A hypothesis: what is added, and how well it then fits."""

    effects: tuple[str, ...]
    """Ids that are added; the first is the stronger. Empty for the model as it is."""
    variants: tuple[Variant, ...]
    """Their shapes."""
    coefficients: tuple[tuple[float, ...], ...]
    """Of each variant's parts."""
    chi2: float
    """Sum of squared whitened misfits."""
    log_evidence: float
    """Nats."""
    reversal: float | None = None
    """m/s over which the model's friction reverses beside it, where not as in the model."""


def cost(excess: float, informative: float, tolerated: float = 0.0) -> float:
    """Return minus two times the log likelihood of a misfit above the noise.

    Up to `tolerated` below, where earlier effects' shapes may be what is left, it says nothing.
    """
    if excess > 0.0:
        return informative * float(np.log1p(excess / informative))
    return min(excess + tolerated, 0.0)


def unusual(shape: Shape) -> float:
    """Return the nats by which a shape is less likely than others before any measurement."""
    over = shape.get("stribeck_velocity", 0.0) / _SLOW_FALL
    return _UNUSUAL * float(np.log(over)) if over > 1.0 else 0.0


def probabilities_of(
    entries: Sequence[Entry], effects: Sequence[str], excess: float, informative: float,
    usual: tuple[float, float],
) -> dict[str, float]:
    """Return the probability of every name.

    The shape of an effect that is really there leaves little of what was missing. The more the
    best one leaves, the less its fit says that it is none of the shapes that nobody wrote down.
    """
    chi2 = next(e.chi2 for e in entries if not e.effects)
    logs: dict[str, list[float]] = {}
    for e in entries:
        if not e.effects:
            doubt = 0.5 * float(np.clip(excess, 0.0, _NO_AGREEMENT))
            logs[AGREES] = [e.log_evidence + _PRIOR_AGREES - doubt]
        else:
            logs.setdefault(e.effects[0], []).append(e.log_evidence)
    scaled = {k: float(logsumexp(np.array(v) / _TEMPERATURE)) for k, v in logs.items()}
    if excess > 0.0:
        explained = 0.5 * cost(_UNKNOWN_SHARE * excess, informative)
        scaled[UNKNOWN] = (-explained - _UNKNOWN_COST) / _TEMPERATURE
        named = [e for e in entries if e.effects]
        if named:
            left = [max(e.chi2 - (chi2 - excess), 0.0) / excess for e in named]
            doubt = min(_doubt(e, share, usual) for e, share in zip(named, left, strict=True))
            scaled[UNKNOWN] = max(scaled[UNKNOWN], scaled[named[0].effects[0]] + doubt)
    total = float(logsumexp(list(scaled.values())))
    result = {k: float(np.exp(v - total)) for k, v in scaled.items()}
    for name in (*effects, AGREES, UNKNOWN):
        result.setdefault(name, 0.0)
    return result


def odds_of_a_parameter(rows: int) -> float:
    """Return the odds of a hypothesis against one that fits as well with a parameter more."""
    return float(np.exp(0.5 * np.log(rows) / _TEMPERATURE))


def share_beside(entries: Sequence[Entry], effect: str, other: str) -> float:
    """Return the share of what is said for an effect that rests on another one beside it."""
    own = [e for e in entries if e.effects[:1] == (effect,)]
    logs = np.array([e.log_evidence for e in own]) / _TEMPERATURE
    beside = np.array([other in e.effects for e in own])
    if not beside.any():
        return 0.0
    return float(np.exp(logsumexp(logs[beside]) - logsumexp(logs)))


def usual_left(rows: Sequence[RecordRows], tolerated: float) -> tuple[float, float]:
    """Return the shares of the misfit at which a shape, or a joint, is likely not the effect's.

    A shape that is really there leaves a few per cent of the misfit of many tests, up to 4.5 in
    blind studies; one that is not, but the nearest in the catalogue, 7.6 and up: even odds are
    given just beyond the least. With a few tests a wrong shape is hardly told from one that is
    right beside something small; nor is it where shapes that were added before may be what is
    left.
    """
    if len(rows) < FEW:
        return _LEFT_OF_FEW, _LEFT_OF_FEW
    if tolerated > 0.0:
        return _LEFT_BESIDE, _LEFT_BESIDE
    return _LEFT, LEFT_BY_JOINT


def _doubt(entry: Entry, left: float, usual: tuple[float, float]) -> float:
    """Return the nats by which what a hypothesis leaves says that none is right."""
    share = usual[1] if any(is_joint(e) for e in entry.effects) else usual[0]
    share *= 1.0 if len(entry.effects) == 1 else _LEFT_BY_PAIR
    return float(min(_LEFT_SLOPE * np.log(max(left, 1e-6) / share), _LEFT_MOST))


def over_time(
    rows: Sequence[RecordRows], before: Array, after: Array, fitted: FittedTerm, better: float
) -> float:
    """Return the nats that an effect loses by what is seen to change while the records last.

    What it makes worse there refutes it, however much it explains otherwise; an effect that is a
    change over time has to show: in rows that only changes reach, or, in records that have none,
    by how much `better` in chi-square it is than all that does not change. A change from test to
    test need not.
    """
    follows = in_record(fitted.term, fitted.shape)
    changing = np.concatenate(
        [np.arange(r.target.size) >= (r.steady or r.target.size) for r in rows]
    )
    if not changing.any():
        return _UNSEEN if follows and better < _SEEN else 0.0
    gain = float(np.sum(before[changing] ** 2) - np.sum(after[changing] ** 2))
    unseen = _UNSEEN if follows and gain < _SEEN else 0.0
    return unseen + float(np.clip(-0.5 * gain, 0.0, _REFUTED))
