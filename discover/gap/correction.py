"""The curve of an added effect corrected, where it is not quite its formula's.

A measured effect follows no formula exactly. What it leaves is looked for along the effect's own
coordinate: a further member of its family (another speed, power, gap or time) beside the one that
was named. Seals' friction follows none either: at last a curve of its own is tried for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.gap.accuracy import Misfit, pooled
from discover.gap.reversing import WIDEST, curves_of_its_own
from discover.gap.stages import Stage, left_out, record_misfit, stage
from discover.naming.candidates import Part, Variant, variants
from discover.naming.columns import candidate_columns, without_span
from discover.naming.fit import ITERATIONS, ModelFit, fit_model, free_parameters
from discover.naming.forces import DELAY, has_joint, is_joint
from discover.naming.rows import RecordRows
from discover.naming.scales import scales_of
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS, Shape

_POWERS = {
    "asymmetric-damping": (0.5, 1.0, 1.5, 2.0, 3.0),
    "position-dependent-friction": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0),
}
_SIDES = (0.0, 1.0, -1.0)
_CLOSE = 1.1  # times the noise floor, up to which no curve is corrected
_WORTH = 0.05  # of the gap of records that were left out, that a correction has to close
_LEAST = 0.02  # of the misfit, that a member has to explain
_FEWEST = 20.0  # of chi-square, that it has to explain too
_STEPS_BESIDE_JOINT = 6
_MOST_BESIDE_JOINT = 2  # members
_APART = 1e-4  # of a member's own square, that it has to add to what the model spans


@dataclass(frozen=True)
class Correction:
    """Curves that differ from their formulas."""

    effects: tuple[str, ...]
    """Whose: once for each member that was added beside its formula."""
    stage: Stage
    """After it."""
    reversal: bool = False
    """Whether friction has come to reverse along a curve of its own."""


def corrected(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    effects: Sequence[str],
    *,
    before: Sequence[str] = (),
    most: int,
) -> Correction | None:
    """Return the curves of the added effects corrected by further members of their families.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    fitted : sequence of RecordRows
        Those that are not held out: each is left out in turn, and has to be predicted better.
    now : Stage
        With the effects' formulas.
    effects : sequence of str
        Ids that were added.
    before : sequence of str
        Whose curves were corrected already: once for each member.
    most : int
        Members at most.

    Returns
    -------
    Correction or None
        None where nothing is added or left, or no member helps.
    """
    seen = _of_fitted(rows, now)
    floor = pooled(seen, noise=True)
    unseen = _each_left_out(rows, fitted, now)
    if not effects or not unseen:
        return None
    best, nearest = None, pooled(unseen)
    fit, names = now.fit, list[str]()
    most = min(most, _MOST_BESIDE_JOINT) if has_joint(fit.model) else most
    while len(names) < most and nearest > _CLOSE * floor:
        found = with_member(fitted, fit, effects)
        if found is None:
            break
        name, trial = found
        excess = fit.chi2 - fit.residual.size
        if fit.chi2 - trial.chi2 < max(_LEAST * excess, _FEWEST):
            break
        fit = trial
        names.append(name)
        met = pooled([record_misfit(r, fit.model) for r in fitted])
        if met > (1.0 - 0.5 * _WORTH) * pooled(seen):
            continue  # what fitted records hardly gain those left out do not
        gap = pooled(left_out(fitted, fit))
        if gap < (1.0 - _WORTH) * nearest:
            best, nearest = (tuple(names), fit), gap
    if best is None:
        return None
    return _kept(rows, fitted, [*before, *best[0]], best[1])


def _kept(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    members: Sequence[str],
    fit: ModelFit,
) -> Correction:
    """Return the correction without members that others have left nothing to do."""
    left = list(members)
    terms = list(fit.model.terms)
    for t in fit.model.terms:
        if t.coefficient == 0.0 and t.id in left:
            left.remove(t.id)
            terms.remove(t)
    if len(left) < len(members):
        model = ForceModel(tuple(terms), fit.model.name)
        fit = fit_model(fitted, model, free_parameters(model), iterations=0)
    return Correction(tuple(left), stage(rows, fit))


def reversal_corrected(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    before: Sequence[str] = (),
) -> Correction | None:
    """Return friction's reversal along a curve of its own, where that predicts records better.

    Such a curve could stand for an effect: it is for when nothing more is named.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    fitted : sequence of RecordRows
        Those that are not held out: each is left out in turn, and has to be predicted better.
    now : Stage
        With all that was added.
    before : sequence of str
        Whose curves were corrected already: once for each member.

    Returns
    -------
    Correction or None
        None where too little is left, or no curve helps.
    """
    floor = pooled(_of_fitted(rows, now), noise=True)
    unseen = _each_left_out(rows, fitted, now)
    best, nearest = None, pooled(unseen)
    if not unseen or nearest <= _CLOSE * floor:
        return None
    for trial in curves_of_its_own(fitted, now.fit):
        gap = pooled(left_out(fitted, trial))
        if gap < (1.0 - _WORTH) * nearest:
            best, nearest = trial, gap
        if nearest <= _CLOSE * floor:
            break
    if best is None:
        return None
    return replace(_kept(rows, fitted, before, best), reversal=True)


def _of_fitted(rows: Sequence[RecordRows], now: Stage) -> list[Misfit]:
    """Return the misfits of the records that are not held out."""
    return [m for r, m in zip(rows, now.misfits, strict=True) if not r.observation.held_out]


def _each_left_out(
    rows: Sequence[RecordRows], fitted: Sequence[RecordRows], now: Stage
) -> tuple[Misfit, ...]:
    """Return the misfits of the fitted records, each left out in turn."""
    return left_out(fitted, now.fit) if len(fitted) < len(rows) else now.unseen


def with_member(
    rows: Sequence[RecordRows], fit: ModelFit, effects: Sequence[str]
) -> tuple[str, ModelFit] | None:
    """Return the fit with that member of the effects' families that explains most, and whose.

    What is simulated as a whole, or shifts all, has no family that could stand side by side.
    """
    some = [e for e in effects if not is_joint(e) and e != DELAY]
    members = [m for e in some for m in _family(rows, fit.model, e)]
    if not members:
        return None
    raw = candidate_columns(rows, fit.model, [Variant(m.id, (m,), 0) for m in members])
    apart = without_span(raw, fit.tangents)
    power, along = np.sum(apart**2, axis=1), apart @ fit.residual
    seen = power > _APART * np.sum(raw**2, axis=1)
    seen &= (along > 0.0) | [_may_pull(fit.model, m) for m in members]
    gain = np.where(seen, along**2 / np.maximum(power, 1e-300), 0.0)
    place = int(np.argmax(gain))
    if gain[place] <= 0.0:
        return None
    chosen = members[place]
    fastest = max(r.sizes["speed"] for r in rows)
    term = FittedTerm(chosen.id, float(along[place] / power[place]), chosen.shape)
    model = ForceModel((*fit.model.terms, term), fit.model.name)
    steps = _STEPS_BESIDE_JOINT if has_joint(model) else ITERATIONS
    found = fit_model(rows, model, free_parameters(model), iterations=steps)
    if any(_resists(t.shape, fastest) for t in found.model.terms[len(fit.model.terms) :]):
        return None
    return chosen.id, found


def _resists(shape: Shape, fastest: float) -> bool:
    """Tell whether friction's reversal is so wide that it is a resistance's, and no seal's."""
    return shape.get("transition_speed", 0.0) > WIDEST * fastest


def _may_pull(model: ForceModel, member: Part) -> bool:
    """Tell whether a member may be negative: what only pushes does so at its other end too."""
    sides = [t.shape.get("side") for t in model.terms if t.id == member.id]
    return not TERMS[member.id].nonnegative or member.shape.get("side") in sides


def _family(rows: Sequence[RecordRows], model: ForceModel, effect: str) -> list[Part]:
    """Return the members of an effect's family that the model does not hold."""
    own = [dict(t.shape) for t in model.terms if t.id == effect]
    if not own or not own[0]:
        return []
    if effect in _POWERS:
        sides = _SIDES if "side" in own[0] else (None,)
        parts = [
            Part(effect, {**own[0], "power": power, **({} if side is None else {"side": side})})
            for power in _POWERS[effect] for side in sides
        ]
    else:
        parts = []
    scales = scales_of([r.observation for r in rows])
    if effect not in _POWERS or own[0].get("width", 0.0) > 0.0:
        parts += [
            p for v in variants(effect, scales) for p in v.parts
            if not _resists(p.shape, scales.speed)
        ]
    unique: dict[tuple[tuple[str, float], ...], Part] = {}
    for p in parts:
        shape = TERMS[effect].shape(p.shape)
        if shape not in own:
            unique.setdefault(tuple(shape.items()), Part(effect, shape, p.probe))
    return list(unique.values())
