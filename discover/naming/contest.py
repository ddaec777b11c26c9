"""The contest of effects: each fitted jointly with the model, weighed, turned into probabilities.

The evidence of a hypothesis falls with its misfit above the noise. Near the noise that is half of
chi-square; far above it only ratios count (a Student's t for the error of the model), since no
formula follows a measured effect exactly. "Agrees" is the model as it is; "unknown" is a misfit
that some flexible shape would explain and no entry of the catalogue does; pairs of effects stand
for the case that two are missing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.naming.candidates import Variant, variants
from discover.naming.columns import CandidateColumns, candidate_columns, without_span
from discover.naming.evidence import (
    AGREES,
    FEW,
    LEFT_BY_JOINT,
    UNKNOWN,
    Entry,
    Evidence,
    cost,
    over_time,
    probabilities_of,
    share_beside,
    unusual,
    usual_left,
)
from discover.naming.fit import ModelFit, kind_of, telling
from discover.naming.forces import coefficient_bounds, in_record, is_joint, is_sensor
from discover.naming.pairs import pairs_with, unlikely
from discover.naming.reversal import other_reversals, reversal_doubt
from discover.naming.rows import RecordRows
from discover.naming.scales import scales_of
from models.checks import Array
from models.terms import TERMS

_NOISE_DEVIATIONS = 4.0  # of chi-square, within which the misfit is the noise's
_NOISE_UNCERTAINTY = 0.12  # of the noise's variance, over all rows
_LEFT_ALONE = 0.04  # of the misfit: where the best alone leaves more, a pair is sought
_PAIR_CANDIDATES = 6
_COLLINEAR = 1e-6
_BUT_THE_CURVE = 0.1  # of the misfit, left beside the doubt of friction's curve: nearly all is it
_AN_ANSWER = 0.05
_OFF_GRID = 4.0  # times the greatest loss: beside a model without it a straight line promises more
_UNEVEN = 5
_TELLING = 4  # records, by which joints are chosen that are tried on all
_OF_A_KIND = 6  # joints, that are
_NEEDS = {"stribeck-friction": "coulomb-friction"}  # a fall needs a friction to fall to


@dataclass(frozen=True)
class Contest:
    """What the contest of one round says."""

    entries: tuple[Entry, ...]
    """Best first; the model as it is among them."""
    probabilities: Mapping[str, float]
    """Of every effect, "agrees" and "unknown"; they add up to one."""
    excess: float
    """Chi-square of the model as it is, above what noise explains."""
    rows: int
    """Number of rows."""
    noise: float
    """Chi-square that noise explains, and the shapes of effects that were added before."""
    tolerated: float
    """Of it what the shapes explain."""
    starts: Mapping[str, tuple[Entry, ...]]
    """Of every effect the best of each kind of its shapes, to start a fit from."""

    @property
    def ranked(self) -> list[tuple[str, float]]:
        """Names and probabilities, most probable first."""
        return sorted(self.probabilities.items(), key=lambda item: -item[1])

    def without(self, effect: str, instead: str | None = None) -> Contest:
        """Return the contest when adding an effect turns out not to help.

        What it had goes to `instead`; where that is not given to "unknown", or to "agrees" where
        that was an answer.
        """
        chances = dict(self.probabilities)
        agreed = self.excess <= 0.0 and chances[AGREES] > _AN_ANSWER
        other = instead or (AGREES if agreed else UNKNOWN)
        chances[other] += chances[effect]
        chances[effect] = 0.0
        return replace(self, probabilities=chances)

    def in_doubt(self, effect: str) -> Contest:
        """Return the contest when what an effect explains may be noise, or is too little to matter.

        The model then agrees with the probability that the effect had. What is left goes to all
        names, in proportion.
        """
        chances = dict(self.probabilities)
        agrees = chances.pop(AGREES)
        doubt = chances[effect]
        left = (1.0 - agrees - doubt) / max(1.0 - agrees, 1e-300)
        shared = {name: left * chance for name, chance in chances.items()}
        return replace(self, probabilities={**shared, AGREES: agrees + doubt})

    def without_alone(self, effect: str, other: str) -> Contest:
        """Return the contest when adding an effect without another one turns out not to help.

        What rests on both goes to the other, the rest to "unknown".
        """
        chances = dict(self.probabilities)
        both = chances[effect] * share_beside(self.entries, effect, other)
        chances[other] += both
        chances[UNKNOWN] += chances[effect] - both
        chances[effect] = 0.0
        return replace(self, probabilities=chances)

    def partner(self, effect: str) -> str | None:
        """Return what is beside `effect` in the best pair that holds it; None without one."""
        pairs = (e.effects for e in self.entries if len(e.effects) == 2 and effect in e.effects)
        found = next(pairs, None)
        return None if found is None else found[1 - found.index(effect)]

    def best(self, effect: str) -> Entry | None:
        """Return the best hypothesis that adds `effect` alone."""
        return next((e for e in self.entries if e.effects == (effect,)), None)


def run_contest(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    effects: Sequence[str],
    *,
    tolerated: float = 0.0,
    columns: CandidateColumns | None = None,
) -> Contest:
    """Weigh every effect beside a fitted model.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        The model, fitted to them, with what it may still change.
    effects : sequence of str
        Ids to weigh.
    tolerated : float
        Chi-square by which the shapes of effects that were added before may be wrong.
    columns : CandidateColumns, optional
        Of the same records, where several contests share them.
    """
    present = [t for r in rows[:1] for t in (*r.held, *fit.model.terms)]
    friction = (t.shape["transition_speed"] for t in present if t.id == "coulomb-friction")
    scales = scales_of([r.observation for r in rows], next(friction, 0.0))
    terms = {t.id for t in present}
    possible = [e for e in effects if _NEEDS.get(e, e) in terms or e not in _NEEDS]
    chosen = [v for e in possible for v in variants(e, scales) if _can_show(v, terms)]
    chosen = _screened(rows, fit, chosen)
    informative = sum(r.informative for r in rows)
    size = fit.residual.size
    dof = size - len(fit.parameters)
    noise = dof + _NOISE_DEVIATIONS * np.sqrt(2.0 * dof) * 0.5 + _NOISE_UNCERTAINTY * dof
    columns = CandidateColumns(rows) if columns is None else columns
    raw = columns.of(fit.model, chosen)
    tangents = np.concatenate([fit.tangents, reversal_doubt(rows, fit.model)])
    freed = without_span(raw, tangents)
    target = without_span(fit.residual[None], tangents)[0]
    chi2 = float(target @ target)
    if chi2 < _BUT_THE_CURVE * fit.chi2:
        tolerated *= chi2 / fit.chi2  # the doubt of friction's curve, which is out, was all of it
    noise += tolerated

    def evidence(chi2: float, parameters: int) -> float:
        misfit = cost(chi2 - noise, informative, tolerated)
        return -0.5 * misfit - 0.5 * parameters * float(np.log(size))

    nothing = Entry((), (), (), chi2, evidence(chi2, 0))
    entries = [nothing]
    first = 0
    spans: list[slice] = []
    for v in chosen:
        span = slice(first, first + len(v.parts))
        first = span.stop
        spans.append(span)
        entry = _single(v, raw[span], freed[span], target, chi2, evidence)
        if entry is not None:
            entries.append(entry)
    if chi2 > noise:
        entries += _beside_other_friction(rows, fit, chosen, spans, raw, entries, evidence)
    starts = _starts(entries[1:])
    best = {name: some[0] for name, some in starts.items()}
    ranked = sorted(best.values(), key=lambda e: -e.log_evidence)
    pairs: list[Entry] = []
    if ranked and ranked[0].chi2 > noise + 20.0:
        for lead in ranked[:_PAIR_CANDIDATES]:
            start = (target, chi2)
            pairs += pairs_with(lead, best, chosen, spans, freed, start, evidence, informative)
    everything = sorted([nothing, *ranked, *pairs], key=lambda e: -e.log_evidence)
    usual = usual_left(rows, tolerated)
    probabilities = probabilities_of(everything, effects, chi2 - noise, informative, usual)
    return Contest(tuple(everything), probabilities, chi2 - noise, size, noise, tolerated, starts)


def _screened(
    rows: Sequence[RecordRows], fit: ModelFit, chosen: Sequence[Variant]
) -> list[Variant]:
    """Return variants without the joints that the records which tell most speak against.

    Of each kind of shape the best few are left.
    """
    joints = [v for v in chosen if is_joint(v.effect)]
    if len(rows) <= _TELLING or not joints:
        return list(chosen)
    ends = np.cumsum([r.target.size for r in rows])
    chosen_rows = telling(rows, fit, _TELLING)
    seen = np.concatenate([np.arange(ends[i] - rows[i].target.size, ends[i]) for i in chosen_rows])
    tangents = fit.tangents[:, seen]
    target = without_span(fit.residual[None, seen], tangents)[0]
    columns = candidate_columns([rows[i] for i in chosen_rows], fit.model, joints)
    columns = without_span(columns, tangents)
    along = np.maximum(columns @ target, 0.0)
    explained = along**2 / np.maximum(np.sum(columns**2, axis=1), 1e-300)
    kept: dict[tuple[object, ...], list[Variant]] = {}
    for i in np.argsort(explained)[::-1]:
        kind = joints[i].effect, kind_of(joints[i].parts[0].shape)
        best = kept.setdefault(kind, [])
        if len(best) < _OF_A_KIND:
            best.append(joints[i])
    left = {id(v) for some in kept.values() for v in some}
    return [v for v in chosen if not is_joint(v.effect) or id(v) in left]


def _can_show(v: Variant, terms: set[str]) -> bool:
    """Tell whether a shape is told apart.

    Friction near a place, or while it warms, is only told from friction that is there all along,
    and values of every test's own are not from the times at which a joint's flanks are met.
    """
    shape = v.parts[0].shape
    if shape.get("only", 0.0) and any(is_joint(t) for t in terms):
        return False
    warming = v.effect == "thermal-drift" and shape.get("power", 1.0) == 0.0
    return not (warming or shape.get("width", 0.0)) or "coulomb-friction" in terms


def _starts(singles: Sequence[Entry]) -> dict[str, tuple[Entry, ...]]:
    """Return of every effect the best entry of each kind of shape, best first.

    Shapes are of one kind where the same parameters are free and the others are equal. A change
    of input or output depends on its shape unevenly: the next best few stand beside the best.
    """
    found: dict[str, dict[tuple[object, ...], Entry]] = {}
    for e in sorted(singles, key=lambda e: -e.log_evidence):
        kinds: tuple[object, ...] = tuple((p.id, kind_of(p.shape)) for p in e.variants[0].parts)
        known = found.setdefault(e.effects[0], {})
        if TERMS[e.effects[0]].acts != "force" and len(known) < _UNEVEN:
            kinds = (*kinds, len(known))
        known.setdefault(kinds, e)
    return {name: tuple(kinds.values()) for name, kinds in found.items()}


def _single(
    v: Variant, raw: Array, freed: Array, target: Array, chi2: float, evidence: Evidence
) -> Entry | None:
    """Return one variant's fit; None where the model has absorbed it or its sign is wrong."""
    gram = freed @ freed.T
    power = np.sum(raw**2, axis=1)
    if np.any(np.diagonal(gram) <= _COLLINEAR * power) or not np.all(np.isfinite(gram)):
        return None
    solution = np.linalg.lstsq(gram, freed @ target, rcond=1e-10)[0]
    if TERMS[v.effect].nonnegative and np.any(solution <= 0.0):
        return None
    shape = v.parts[0].shape
    low, high = coefficient_bounds(shape)
    low *= _OFF_GRID if shape.get("droop_time", 0.0) > 0.0 else 1.0
    if not low <= solution[0] <= high:
        return None
    now = chi2 - float(solution @ (freed @ target))
    value = evidence(now, len(v.parts) + v.shapes) - unusual(shape)
    return Entry((v.effect,), (v,), (tuple(solution),), now, value)


def _beside_other_friction(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    chosen: Sequence[Variant],
    spans: Sequence[slice],
    raw: Array,
    entries: Sequence[Entry],
    evidence: Evidence,
) -> list[Entry]:
    """Return added forces that fit better beside friction that reverses over other speeds."""
    least: dict[str, float] = {}
    for e in entries[1:]:
        least[e.effects[0]] = min(e.chi2, least.get(e.effects[0], np.inf))
    forces = [i for i, v in enumerate(chosen) if TERMS[v.effect].acts == "force"]
    found = []
    for speed, other in other_reversals(rows, fit):
        tangents = np.concatenate([other.tangents, reversal_doubt(rows, other.model)])
        target = without_span(other.residual[None], tangents)[0]
        chi2 = float(target @ target)
        freed = without_span(raw, tangents)
        along, power = freed @ target, np.maximum(np.sum(freed**2, axis=1), 1e-300)
        for i in forces:
            v, span = chosen[i], spans[i]
            single = chi2 - float(along[span.start] ** 2 / power[span.start])
            if len(v.parts) == 1 and single >= least.get(v.effect, np.inf):
                continue
            entry = _single(v, raw[span], freed[span], target, chi2, evidence)
            if entry is not None:
                found.append(replace(entry, reversal=speed))
    return found


def leaves_much(rows: Sequence[RecordRows], contest: Contest, effect: str) -> bool:
    """Tell whether an effect, alone or in a pair, leaves more than what is really there would."""
    if effect == AGREES or contest.excess <= 0.0 or len(rows) < FEW:
        return False
    least = min((e.chi2 for e in contest.entries if e.effects[:1] == (effect,)), default=0.0)
    usual = LEFT_BY_JOINT if effect != UNKNOWN and is_joint(effect) else _LEFT_ALONE
    return least - contest.noise > usual * contest.excess


def pair_evidence(
    rows: Sequence[RecordRows], contest: Contest, chi2: float, chosen: Sequence[Variant]
) -> float:
    """Return the log evidence of two effects that were fitted together, with their chi-square."""
    informative = sum(r.informative for r in rows)
    spent = sum(len(v.parts) + v.shapes for v in chosen)
    value = -0.5 * cost(chi2 - contest.noise, informative, contest.tolerated)
    value -= 0.5 * spent * float(np.log(contest.rows))
    return value + unlikely(informative)


def reweighed(
    rows: Sequence[RecordRows],
    contest: Contest,
    fit: ModelFit,
    fits: Mapping[str, ModelFit],
    effects: Sequence[str],
) -> Contest:
    """Return the contest with effects weighed by fits of their real size and shape.

    `fit` is the model as it is, `fits` with each effect.
    """
    informative = sum(r.informative for r in rows)
    refitted = {
        e.effects[0]: _really_left(rows, fits[e.effects[0]], e)
        for e in contest.entries
        if len(e.effects) == 1 and e.effects[0] in fits
    }
    added = {n: fits[n].model.terms[-1] for n in refitted}
    lasting = (c for n, c in refitted.items() if not in_record(added[n].term, added[n].shape))
    steady = min(lasting, default=np.inf)
    entries = []
    for e in contest.entries:
        if len(e.effects) != 1 or e.effects[0] not in fits:
            entries.append(e)
            continue
        found, chi2 = fits[e.effects[0]], refitted[e.effects[0]]
        spent = sum(len(v.parts) + v.shapes for v in e.variants)
        value = -0.5 * cost(chi2 - contest.noise, informative, contest.tolerated)
        value -= 0.5 * spent * float(np.log(contest.rows))
        last = added[e.effects[0]]
        value -= over_time(rows, fit.residual, found.residual, last, steady - chi2)
        value -= unusual(last.shape)
        entries.append(replace(e, chi2=chi2, log_evidence=value))
    entries.sort(key=lambda e: -e.log_evidence)
    usual = usual_left(rows, contest.tolerated)
    chances = probabilities_of(entries, effects, contest.excess, informative, usual)
    return replace(contest, entries=tuple(entries), probabilities=chances)


def _really_left(rows: Sequence[RecordRows], fit: ModelFit, entry: Entry) -> float:
    """Return the chi-square of an effect's fit.

    A straight line to what a sensor does may promise more than a change of its size gives; what is
    simulated may not have been fitted to its best.
    """
    left = _left(rows, fit)
    return left if is_sensor(TERMS[entry.effects[0]]) else min(left, entry.chi2)


def _left(rows: Sequence[RecordRows], fit: ModelFit) -> float:
    """Return the chi-square of a fit that no change of its parameters explains."""
    tangents = np.concatenate([fit.tangents, reversal_doubt(rows, fit.model)])
    left = without_span(fit.residual[None], tangents)[0]
    return float(left @ left)
