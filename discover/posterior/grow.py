"""One more term: which one, if any, makes the records more probable.

Where a term leaves but noise, evidence decides. Where none does, no model is right, and evidence
is sure of whichever is a little less wrong. Then terms are compared by how well each record is
predicted from the others.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.posterior.assess import FEW_STEPS, Assessed, Assessor
from discover.posterior.catalogue import trials_of
from discover.posterior.climb import Place
from discover.posterior.left_out import predicted_no_worse, unseen
from discover.posterior.model import Composite
from discover.posterior.own_curve import chosen_behind, likely_curves, place_of, with_curve
from discover.posterior.own_share import own_lines
from discover.posterior.space import begun
from discover.posterior.step import Candidate, Step, ordered
from discover.posterior.weigh import Gain, Trials, gains
from models.checks import Array
from models.constitutive import FittedTerm
from models.terms import TERMS

_NAMES = 5  # that are fitted, of those that gain most
_SHAPES = 3  # of each, from which a fit starts, the best of each discrete choice first
_HOPELESS = -3.0  # nats of gain, below which nothing is fitted
_HALF = 0.5
"""Of the greatest gain in a straight line, that a shape near the right one has; of a term's whole
gain, that a few steps of a fit reach."""
_NEARLY = 0.8  # likewise, where another explains all but noise already
_TOLD = 3.0  # nats, by which a discrete choice is to be more probable than the plain one
_NATS = 20.0  # less than these shares; also of evidence, that a term may lose beside a remainder


@dataclass(frozen=True)
class _Weighed:
    """What a trial gains in a straight line at some sizes."""

    gain: Gain
    """That."""
    place: Place
    """These sizes."""
    beside: Assessed
    """The model."""


def grown(
    assessor: Assessor, now: Assessed, ids: Collection[str], *, least: float = -np.inf
) -> Step:
    """Return what may join a model.

    Terms that only add a force come first. Those that are simulated in time, which takes long, are
    tried where these leave more than noise and gain no more than twice as much in a straight line;
    where one leaves but noise, those for which what gains may be mistaken.
    What changes the motion or the force is weighed beside friction in its most probable curve, and
    what is not simulated beside friction as it is, too.

    Parameters
    ----------
    assessor : Assessor
        Of the records.
    now : Assessed
        The model as it is.
    ids : collection of str
        Terms that may join.
    least : float
        Log evidence that a model with one of them is to have, nats: those that are not half way
        there after a few steps of a fit are not fitted further.
    """
    found = [Candidate("", now.value, now)]
    changing = any(TERMS[i].acts != "force" for i in ids)
    turns = likely_curves(assessor, now) if changing else []
    curved = with_curve(assessor, now, turns[0]) if turns else now
    most: dict[Place, float] = {}
    for simulated in (False, True):
        chosen = [i for i in ids if TERMS[i].simulated is simulated]
        if simulated and any(c.assessed and c.assessed.quiet for c in found):
            better = [TERMS[c.id] for c in found if c.id and c.assessed and c.value > now.value]
            chosen = [i for i in chosen if any(i in t.mistaken_for for t in better)]
        if not chosen:
            continue
        found += _tried(assessor, (now, curved), turns[1:], chosen, len(ids), most, least)
    return weighed(found, now, assessor.seed)


def weighed(found: Sequence[Candidate], now: Assessed, seed: int) -> Step:
    """Return candidates, one of them the model as it is, the most probable first.

    By evidence where one leaves but noise, else by how well records left out are predicted.
    """
    if any(c.assessed.quiet for c in found if c.assessed):
        return ordered(Step(tuple(found), seed))
    return _by_prediction(found, now, seed)


def chosen_again(
    assessor: Assessor,
    now: Assessed,
    less: Assessed,
    own: Sequence[FittedTerm],
    log_prior: float,
    others: Collection[str] = (),
    among: int = 1,
) -> Candidate:
    """Return what a model has of one id: as it is, or chosen again beside all that joined later.

    A fit can't turn one shape into every other, and what was best while another term was missing
    need not be best beside it. Nor need it be the same term.

    Parameters
    ----------
    assessor : Assessor
        Of the records.
    now, less : Assessed
        The model, with terms of the id and without them.
    own : sequence of FittedTerm
        These terms.
    log_prior : float
        Nats, of such terms in one shape.
    others : collection of str
        Ids of terms that may take its place.
    among : int
        Number of terms that may join in all.

    Returns
    -------
    Candidate
        Of the same id in another shape or of another one, where that is better; else of the model
        as it is.
    """
    here = Candidate("", now.value + log_prior, now)
    if not np.isfinite(less.value):
        return here
    found, as_it_is = [here], (own[0].id, _choice(own))
    least = here.value - less.value - _NATS
    for identifier in (own[0].id, *others):
        trials = trials_of(
            assessor.space.scales, assessor.evaluator.coarse, [identifier], less.model, among=among
        )
        if not trials.entries:  # it needs a term that the model lacks
            continue
        more = log_prior - trials.entries[0].log_prior if identifier == own[0].id else 0.0
        starts = [
            w.gain for w in _weighed(assessor, less, trials).get(identifier, [])
            if w.gain.value + more > least
            and (identifier, _choice(w.gain.trial.terms)) != as_it_is
        ]
        other = _fitted(assessor, less, starts) if starts else here
        if other is not here and other.assessed is not None:
            found.append(replace(other, value=other.value + more))
    return weighed(found, now, assessor.seed).best if len(found) > 1 else here


def _by_prediction(found: Sequence[Candidate], now: Assessed, seed: int) -> Step:
    """Return candidates weighed by how well they predict records that are left out."""
    before = unseen(now)
    likely = [_predicting(c, before) if c.value > now.value - _NATS else c for c in found]
    parts = next(c.left.size for c in likely if c.left is not None)
    return ordered(Step(tuple(likely), seed, own_lines(now.predicting, parts)))


def _predicting(candidate: Candidate, before: Array) -> Candidate:
    """Return a candidate with what it leaves of records that are predicted by the others.

    One that leaves more of unseen records than was left `before` does not predict.
    """
    if candidate.assessed is None:
        return candidate
    return replace(candidate, left=predicted_no_worse(candidate.assessed, before))


def _tried(
    assessor: Assessor, beside: tuple[Assessed, Assessed], turns: Sequence[FittedTerm],
    ids: Sequence[str], among: int, most: dict[Place, float], least: float,
) -> list[Candidate]:
    """Return some terms beside the model as it is, or as it is with friction's own curve.

    Those that change the force are fitted from the first, and where that leaves more than noise
    from the second; those that are simulated from the second alone, and also from other curves,
    `turns`. `most` is kept, what any has gained at some sizes.
    """
    coarse, (now, curved) = assessor.evaluator.coarse, beside
    by_id: dict[str, list[_Weighed]] = {}
    for acting in (True, False):
        own = [i for i in ids if (TERMS[i].acts == "force") is acting]
        simulated = any(TERMS[i].simulated for i in own)
        for model in [now] if acting or curved is now else [curved] if simulated else [now, curved]:
            trials = trials_of(assessor.space.scales, coarse, own, model.model, among=among)
            for identifier, found_here in _weighed(assessor, model, trials).items():
                by_id.setdefault(identifier, []).extend(found_here)
    for w in (w for one in by_id.values() for w in one):
        most[w.place] = max(most.get(w.place, -np.inf), w.gain.value)

    def behind(w: _Weighed) -> float:
        """Return by how much a trial gains less than any at these sizes, nats."""
        return most[w.place] - w.gain.value

    for one in by_id.values():
        one.sort(key=behind)
    found: list[Candidate] = []
    ranks = [0, 0]  # of those that add a force and of those that change it
    for one in sorted(by_id.values(), key=lambda own: behind(own[0])):
        gain = one[0].gain
        which = int(TERMS[gain.trial.id].acts == "force")
        rank = ranks[which]
        ranks[which] += 1
        near = _NEARLY if any(c.assessed and c.assessed.quiet for c in found) else _HALF
        worth = any(w.gain.value >= max(_HOPELESS, near * most[w.place] - _NATS) for w in one)
        if rank >= _NAMES or not worth:
            found.append(Candidate(gain.trial.id, now.value + min(gain.value, 0.0), None))
            continue
        fits: list[Candidate] = []
        for model, others in ((now, ()), (curved, turns))[: 1 if curved is now else 2]:
            starts = [w.gain for w in one if w.beside is model]
            if starts and not any(c.assessed and c.assessed.quiet for c in fits):
                fits.append(_fitted(assessor, model, starts, others, least))
        found.append(max(fits, key=lambda c: c.value))
    return found


def _weighed(assessor: Assessor, now: Assessed, trials: Trials) -> dict[str, list[_Weighed]]:
    """Return what trials gain in a straight line, by id, those that gain most first.

    At the sizes that predict best, those of a model that leaves but noise, and the model's own.
    """
    if not trials.entries:
        return {}
    space, curve = now.space, assessor.curve_of(now.model)
    found: dict[str, list[_Weighed]] = {}
    best = now.predicting  # where more than noise is left, prediction decides
    for place, local in {
        best.place: best.local, space.quiet: now.local, now.place: now.local
    }.items():
        for gain in gains(space, trials, local, place.sizes(space.own_unit), curve):
            found.setdefault(gain.trial.id, []).append(_Weighed(gain, place, now))
    return found


def _fitted(
    assessor: Assessor, now: Assessed, starts: Sequence[Gain], turns: Sequence[FittedTerm] = (),
    least: float = -np.inf,
) -> Candidate:
    """Return a term beside the model, fitted from its best shapes, and from curves of friction.

    Only begun where it will not reach the `least` log evidence, nats.
    """
    evaluator = assessor.evaluator.coarse
    start = now.place.towards(assessor.space.quiet)
    chosen = [
        (gain, model) for gain in _starting(starts)
        if np.all(np.isfinite(evaluator.force(model := now.model.plus(*_begun(gain)))))
    ]
    if len(chosen) > 1 or (chosen and (turns or least > -np.inf)):
        glanced = _glanced(assessor, chosen, start)
        if turns and assessor.friction is not None:
            gain = glanced[0][0]
            model = now.model.plus(*_begun(gain))
            at = place_of(assessor.friction, model)
            turned = [(gain, model.with_shape(at, t.shape)) for t in turns]
            glanced = sorted(glanced + _glanced(assessor, turned, start), key=_rank)
        gained = glanced[0][0].trial.log_prior + glanced[0][2] - now.value
        if now.value + gained / _HALF < least:
            return Candidate(glanced[0][0].trial.id, now.value + min(gained, 0.0), None)
        chosen = [(g, m) for g, m, _ in glanced]
    for gain, model in chosen:
        if np.all(np.isfinite(assessor.evaluator.force(model))):  # on the fine rows too
            first = assessor.assess(model, start)
            found = Candidate(
                gain.trial.id, first.value + gain.trial.log_prior, first, len(gain.trial.terms)
            )
            if not first.quiet:
                found = _with_likely_curve(assessor, _turned(assessor, found, starts))
            may_join = found.value > now.value - _NATS
            return _plain_where_not_told(assessor, found, starts) if may_join else found
    # At the sizes at which it would gain most it has no finite force.
    return Candidate(starts[0].trial.id, now.value, None)


def _glanced(
    assessor: Assessor, chosen: Sequence[tuple[Gain, Composite]], start: Place
) -> list[tuple[Gain, Composite, float]]:
    """Return models after a few steps of a fit, with their log evidence, the best first."""
    return sorted(
        ((g, *assessor.glance(m, start, iterations=FEW_STEPS)) for g, m in chosen), key=_rank
    )


def _rank(glanced: tuple[Gain, Composite, float]) -> float:
    return -glanced[2] - glanced[0].trial.log_prior


def _turned(assessor: Assessor, found: Candidate, starts: Sequence[Gain]) -> Candidate:
    """Return a candidate with the discrete choice that is best at the values which were fitted.

    Before they are, choices may be alike: filters of all orders begin as the same delay.
    """
    assessed = found.assessed
    if assessed is None or found.count != 1:
        return found
    model, own = assessed.model, assessed.model.terms[-1].fitted
    others, seen = list[tuple[float, Composite, Gain]](), {_choice([own])}
    here = assessed.density(model)
    for gain in starts:
        choice = _choice(gain.trial.terms)
        if choice in seen or len(gain.trial.terms) > 1:
            continue
        seen.add(choice)
        other = model.without(len(model.terms) - 1).plus(_in_choice(own, gain.trial.terms[0]))
        others.append((assessed.density(other), other, gain))
    value, other, gain = max(others, key=lambda o: o[0], default=(here, model, starts[0]))
    if not value > here:
        return found
    there = assessor.assess(other, assessed.place)
    turned = Candidate(found.id, there.value + gain.trial.log_prior, there, 1)
    return turned if turned.value > found.value else found


def _with_likely_curve(assessor: Assessor, found: Candidate) -> Candidate:
    """Return a candidate with the curve of friction that is best beside what is simulated."""
    if found.assessed is None or not TERMS[found.id].simulated:
        return found
    there = chosen_behind(assessor, found.assessed)
    return replace(found, assessed=there, value=there.value + found.log_prior)


def _plain_where_not_told(
    assessor: Assessor, found: Candidate, starts: Sequence[Gain]
) -> Candidate:
    """Return a candidate with plain choices where the records don't tell others from them.

    A slow force passes a filter as it passes a delay.
    """
    plain = next((g.trial for g in starts if _is_plain(g)), None)
    assessed = found.assessed
    if assessed is None or found.count != 1 or plain is None:
        return found
    model = assessed.model
    own = _in_choice(model.terms[-1].fitted, plain.terms[0])
    if all(own.shape[p.name] == model.terms[-1].fitted.shape[p.name] for p in own.term.parameters):
        return found
    other = assessor.assess(model.without(len(model.terms) - 1).plus(own), assessed.place)
    plainer = Candidate(found.id, other.value + plain.log_prior, other, 1)
    return plainer if plainer.value > found.value - _TOLD else found


def _in_choice(fitted: FittedTerm, start: FittedTerm) -> FittedTerm:
    """Return a term as it is fitted, but in the discrete choice of a start, within its bounds."""
    shape = {
        p.name: fitted.shape[p.name]
        if p.fitted and (fitted.shape[p.name] == 0.0) == (start.shape[p.name] == 0.0)
        else start.shape[p.name]
        for p in fitted.term.parameters
    }
    return begun(FittedTerm(fitted.id, start.coefficient, shape), fitted.coefficient)


def _starting(ranked: Sequence[Gain]) -> list[Gain]:
    """Return the shapes from which a fit starts: the best of each discrete choice, then others.

    The plain one is always among them. Between shapes that a fit can turn into each other, it will
    find its way; between the others a gain in a straight line says too little.
    """
    trials = {id(g.trial): g for g in reversed(ranked)}
    shapes = [g for g in ranked if trials[id(g.trial)] is g]
    seen, first, others = set[tuple[object, ...]](), list[Gain](), list[Gain]()
    for gain in shapes:
        choice = _choice(gain.trial.terms)
        (others if choice in seen else first).append(gain)
        seen.add(choice)
    chosen = [*first, *others][:_SHAPES]
    return chosen + [g for g in first[_SHAPES:] if _is_plain(g)]


def _choice(terms: Sequence[FittedTerm]) -> tuple[object, ...]:
    """Return what a fit can't turn into something else: discrete choices, and what is at zero."""
    term, shape = terms[0].term, terms[0].shape
    return (
        len(terms),
        *(shape[p.name] if not p.fitted else shape[p.name] == 0.0 for p in term.parameters),
    )


def _is_plain(gain: Gain) -> bool:
    """Tell whether a trial is one term whose discrete choices are all as they are by default."""
    only, *more = gain.trial.terms
    return not more and all(
        p.fitted or only.shape[p.name] == p.default for p in only.term.parameters
    )


def _begun(gain: Gain) -> list[FittedTerm]:
    """Return the terms of a trial at the size at which they gain most, within their bounds."""
    return [
        begun(t, size) for t, size in zip(gain.trial.terms, gain.coefficients, strict=True)
    ]
