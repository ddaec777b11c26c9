"""Candidates refined: the best shapes of the leading effects fitted for real, with the model."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.naming.contest import Contest, reweighed
from discover.naming.evidence import AGREES, Entry
from discover.naming.fit import ModelFit, fit_model, free_parameters, telling
from discover.naming.forces import MOST_FILTERED, behind_filter, has_joint, is_joint, is_sensor
from discover.naming.restart import best_range
from discover.naming.reversal import with_reversal
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import UnitRows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS

_LEADING = 6
_KINDS = (6, 4, 2, 1)  # of shapes that are fitted, of the first effect, the second, ...
_FIRST_STEPS = 2
_BEGUN_ON = 8  # records, where each evaluation costs a simulation
_ENDED = 2  # kinds of the first effect's force, that are fitted to the end
_ITERATIONS = 8
_ENOUGH = 0.02
_NEARLY = 0.8  # of the greatest filtered gain
_SPRING = 8.0  # times the play, that its flanks give under the greatest force
_BEARS = 0.25  # of the stiffness under the greatest force, that a play has in its middle at most
_FAR = 30.0  # widths from a soft flank, where it is linear
_WITHIN = 60.0  # nats behind the best that adds one effect, within which another is refined
_SENSOR_WITHIN = 120.0  # likewise a sensor's: its straight line is off by its size squared
_SURE = 0.9  # of agreement: no shape changes that
_HOPELESS = 0.95  # of the misfit, that an added force leaves: no shape near it leaves much less


def extended(model: ForceModel, entry: Entry, *, only_first: bool = True) -> ForceModel:
    """Return the model with an entry's effect added, at the size that the contest found."""
    if entry.reversal is not None:
        model = with_reversal(model, entry.reversal)
    terms = list(model.terms)
    pairs = list(zip(entry.variants, entry.coefficients, strict=True))
    for variant, values in pairs[:1] if only_first else pairs:
        for part, value in zip(variant.parts, values, strict=True):
            start = part.probe if part.id == "series-compliance" else _sensible(part.id, value)
            terms.append(FittedTerm(part.id, start, part.shape))
    return ForceModel(tuple(terms), model.name)


def _sensible(identifier: str, value: float) -> float:
    """Return a first guess: shares of a whole start within it."""
    if identifier in ("sensor-clipping", "cavitation", "backlash"):
        return min(max(value, 0.05), 1.0)
    return max(value, 0.0) if TERMS[identifier].nonnegative else value


def refine(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    contest: Contest,
    effects: Sequence[str],
    *,
    only: Collection[str] | None = None,
) -> tuple[Contest, dict[str, ModelFit]]:
    """Return the contest with its leading effects fitted for real, and those fits.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        The model as it is.
    contest : Contest
        From `run_contest`.
    effects : sequence of str
        Ids that were weighed.
    only : collection of str, optional
        Ids that may be refined.
    """
    if contest.probabilities[AGREES] > _SURE:
        return contest, {}
    units = UnitRows()
    frozen = _Frozen.of(rows, fit, units)
    fits: dict[str, ModelFit] = {}
    seen: set[str] = set()
    passed_over: list[str] = []
    instead: dict[str, Entry] = {}
    weighed = contest
    while leading := [e for e in _leading(weighed, only) if e.effects[0] not in seen]:
        # What the first promised in a straight line it may not keep: then others come near.
        for entry in leading:
            name = entry.effects[0]
            starts = contest.starts[name][: _KINDS[min(len(seen), len(_KINDS) - 1)]]
            ended = _ENDED if not seen and TERMS[name].acts == "force" else 1
            seen.add(name)
            found = _best(rows, fit, starts, ended, units, frozen)
            if at_most_filtered(found.model.terms[len(fit.model.terms) :]):
                others = [s for s in contest.starts[name] if not _filtered(s)][:1]
                if not others:
                    passed_over.append(name)
                    continue
                instead[name] = others[0]
                found = _best(rows, fit, others, 1, units, frozen)
            if pulls(found.model.terms[len(fit.model.terms) :]):
                found = as_begun(rows, extended(fit.model, starts[0]), units)
            impossible = pulls(found.model.terms[len(fit.model.terms) :])
            if impossible or not np.isfinite(found.chi2) or is_a_spring(rows, found.model):
                passed_over.append(name)
                continue
            if name == "sensor-gain" and not has_joint(fit.model):
                found = best_range(rows, found)
            fits[name] = found
        weighed = replace(
            contest,
            entries=tuple(
                instead.get(e.effects[0], e) if len(e.effects) == 1 else e
                for e in contest.entries
                if not set(passed_over) & set(e.effects)
            ),
        )
        weighed = reweighed(rows, weighed, fit, fits, effects)
    return weighed, fits


def pulls(terms: Sequence[FittedTerm]) -> bool:
    """Tell whether some term has a sign that it can't have."""
    return any(t.term.nonnegative and t.coefficient <= 0.0 for t in terms)


def _leading(contest: Contest, only: Collection[str] | None) -> list[Entry]:
    """Return the best entries that add one effect, near enough to the best of them."""
    singles = [e for e in contest.entries if len(e.effects) == 1][:_LEADING]
    return [
        e
        for e in singles
        if e.log_evidence > singles[0].log_evidence - _within(e.effects[0])
        and (only is None or e.effects[0] in only)
        and not _hopeless(e, contest)
    ]


def _within(name: str) -> float:
    return _SENSOR_WITHIN if is_sensor(TERMS[name]) else _WITHIN


def _best(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    starts: Sequence[Entry],
    ended: int,
    units: UnitRows,
    frozen: _Frozen | None,
) -> ModelFit:
    """Return the best fit from an effect's starts: after first steps `ended` of them go on."""
    models = [extended(fit.model, start) for start in starts]
    if len(models) > 1:
        seen = rows
        if models[0].terms[-1].term.acts != "force":
            seen = [rows[i] for i in telling(rows, fit, _BEGUN_ON)]
        begun = [_fit(seen, m, units, _FIRST_STEPS, frozen) for m in models]
        begun.sort(key=dearness)
        models = [f.model for f in begun[:ended]]
    best = min((_fit(rows, m, units, _ITERATIONS, frozen) for m in models), key=dearness)
    gain = best.model.terms[-1]
    if behind_filter(gain.shape) and abs(gain.coefficient) > _NEARLY * MOST_FILTERED:
        # Whether its size is possible shows at the end.
        best = fit_model(rows, best.model, best.parameters, units=units, iterations=_ITERATIONS)
    return best


def as_begun(
    rows: Sequence[RecordRows], model: ForceModel, units: UnitRows | None = None
) -> ModelFit:
    """Return the fit of a model whose last term keeps its shape: free, it ran to a wrong sign."""
    last = len(model.terms) - 1
    free = tuple(p for p in free_parameters(model) if p.shape is None or p.term < last)
    return fit_model(rows, model, free, iterations=_ITERATIONS, enough=_ENOUGH, units=units)


def at_most_filtered(terms: Sequence[FittedTerm]) -> bool:
    """Tell whether a gain behind a filter is as great as it may be: then it is none."""
    return any(behind_filter(t.shape) and abs(t.coefficient) >= MOST_FILTERED for t in terms)


def _filtered(start: Entry) -> bool:
    return behind_filter(start.variants[0].parts[0].shape)


def dearness(fit: ModelFit) -> float:
    """Return the chi-square of a fit and what its parameters cost: the least is the best."""
    spent = len(fit.parameters) * float(np.log(fit.residual.size))
    return float(np.nan_to_num(fit.chi2, nan=np.inf)) + spent


def _hopeless(entry: Entry, contest: Contest) -> bool:
    left = entry.chi2 - contest.noise
    return left > _HOPELESS * contest.excess > 0.0 and not is_joint(entry.effects[0])


def is_a_spring(rows: Sequence[RecordRows], model: ForceModel) -> bool:
    """Tell whether the last term is no play but a spring.

    So it is where its flanks give far more than it plays, and where soft ones bear in its middle.
    """
    play = model.terms[-1]
    if play.id != "backlash":
        return False
    terms = (*model.terms, *(t for r in rows[:1] for t in r.held))
    mass = sum(t.coefficient for t in terms if t.id == "inertia")
    stiffness = mass * play.shape["contact"] ** 2
    force = max(float(np.abs(r.observation.measured).max()) for r in rows)
    gap, softness = play.shape["gap"], play.shape["softness"]
    if stiffness <= 0.0:
        return False
    return force > _SPRING * stiffness * gap or _bearing(force / stiffness / gap, softness) > _BEARS


def _bearing(force: float, softness: float) -> float:
    """Return how stiff soft flanks are in the middle of a play, over how they are under a force.

    Lengths are shares of the play, the force is what it bends a flank by.
    """
    if softness == 0.0:
        return 0.0
    half, pressed = 0.5 / softness, force / softness  # in widths
    far = np.exp(-half)
    if pressed > _FAR:
        depth = half + pressed
    else:  # where log((1 + far e^depth) / (1 + far e^-depth)) is `pressed`
        grown = np.expm1(pressed)
        root = np.hypot(grown, 2.0 * far * np.exp(0.5 * pressed))
        depth = float(np.log((grown + root) / (2.0 * far)))
    return float(2.0 * far / (1.0 + far) * depth / pressed)


@dataclass(frozen=True)
class _Frozen:
    """A model whose changes of input and output stand still, so that its other terms only add."""

    rows: tuple[RecordRows, ...]
    """Records without what the changes make of their force."""
    fit: ModelFit
    """The model with its changes."""

    @classmethod
    def of(cls, rows: Sequence[RecordRows], fit: ModelFit, units: UnitRows) -> _Frozen | None:
        """Return the model frozen; None where it has nothing to freeze."""
        if not any(t.term.acts != "force" for t in fit.model.terms):
            return None
        plain = _without_changes(fit.model)
        less = tuple(
            replace(
                r,
                target=r.target
                - units.of_model([r], fit.model)
                + units.of_model([r], plain),
            )
            for r in rows
        )
        return cls(less, fit)

    def whole(self, found: ModelFit) -> ModelFit:
        """Return a fit of the other terms as one of the whole model, changes in their places."""
        terms = self.fit.model.terms
        places = [i for i, t in enumerate(terms) if t.term.acts == "force"]
        added = len(found.model.terms) - len(places)
        places += range(len(terms), len(terms) + added)
        others = iter(found.model.terms)
        whole = [t if t.term.acts != "force" else next(others) for t in terms]
        moved = [replace(p, term=places[p.term]) for p in found.parameters]
        own = [i for i, p in enumerate(self.fit.parameters) if p.term not in places]
        return replace(
            found,
            model=ForceModel((*whole, *others), found.model.name),
            parameters=(*moved, *(self.fit.parameters[i] for i in own)),
            tangents=np.concatenate([found.tangents, self.fit.tangents[own]]),
        )


def _without_changes(model: ForceModel) -> ForceModel:
    return ForceModel(tuple(t for t in model.terms if t.term.acts == "force"), model.name)


def _fit(
    rows: Sequence[RecordRows],
    model: ForceModel,
    units: UnitRows,
    steps: int,
    frozen: _Frozen | None,
) -> ModelFit:
    if frozen is not None and model.terms[-1].term.acts == "force":
        less = _without_changes(model)
        found = fit_model(
            frozen.rows, less, free_parameters(less), iterations=steps, enough=_ENOUGH,
            units=UnitRows(),
        )
        return frozen.whole(found)
    parameters, own = free_parameters(model), len(model.terms) - 1
    if steps == _FIRST_STEPS and any(is_joint(t.id) for t in model.terms[:-1]):
        # Each shape before costs simulations of the joint: which kind is best shows without.
        parameters = tuple(p for p in parameters if p.shape is None or p.term == own)
    return fit_model(
        rows, model, parameters, iterations=steps, enough=_ENOUGH, units=units, exact=False
    )
