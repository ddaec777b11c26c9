"""A model's force on a record: what has memory in its steady state, what drifts over the record."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.motion_fit import POINTS, Observation
from discover.rows.record_rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from models.terms.between_tests import ONLY
from models.terms.term import Changed, ForceOf

_STEP = 1e-3  # of a record's force, over which the slope of what is passed on is taken
_NUMBERS = 2**20  # of what units of terms add, that are kept of one record,
_FEWEST, _MOST = 16, 256  # but so many units at least, and at most
_INNER = 16  # forces behind an effect that are kept, as fits change the outermost alone too
_TOTALS = 4  # sums of terms that are kept: a joint's device is fitted once to each


def drifts(fitted: FittedTerm) -> bool:
    """Tell whether a term changes while a record lasts: it then has no steady cycle."""
    return fitted.term.remembers(fitted.shape) == "time"


def unit(fitted: FittedTerm, motion: Motion) -> Array:
    """Return what a unit of a term adds on a motion, (N,) in N over the coefficient's unit."""
    if fitted.term.column is None:
        raise ValueError(f"{fitted.id} adds no force")
    return fitted.term.column(motion, fitted.shape)


def steady(model: ForceModel) -> ForceModel:
    """Return a model without what changes while a record lasts."""
    return ForceModel(tuple(t for t in model.terms if not drifts(t)), model.name)


def _drifting(model: ForceModel, motion: Motion, whole: Array) -> Array:
    """Return what the terms that drift add to a force (M,) on a motion, N."""
    terms = tuple(t for t in model.terms if drifts(t))
    if not terms:
        return np.zeros_like(whole)
    slow = ForceModel(terms)
    return slow.changed(lambda m: whole + slow.added(m), motion) - whole


def at_moments(cycle: Array, time: Array, frequency: float) -> Array:
    """Return a force on a grid over one cycle (G,) at other times (M,), s."""
    phase = np.mod(time * frequency, 1.0)
    grid = np.arange(cycle.size + 1) / cycle.size
    return np.asarray(np.interp(phase, grid, np.append(cycle, cycle[0])))


def in_test(model: ForceModel, test: int) -> ForceModel:
    """Return a model as it is in a test, numbered from 1.

    Of terms that each hold in one test only, a test that has none of its own takes their mean.
    """
    own: dict[tuple[object, ...], list[FittedTerm]] = {}
    kept = []
    for t in model.terms:
        only = t.shape.get(ONLY.name, 0.0)
        if only == 0.0:
            kept.append(t)
        else:
            others = tuple(v for v in t.shape.items() if v[0] != ONLY.name)
            own.setdefault((t.id, *others), []).append(t)
    if not own:
        return model
    for terms in own.values():
        here = [t for t in terms if t.shape[ONLY.name] == test]
        if here or not test:
            kept += here
            continue
        mean = float(np.mean([t.coefficient for t in terms]))
        kept.append(FittedTerm(terms[0].id, mean, {**terms[0].shape, ONLY.name: float(test)}))
    return ForceModel(tuple(kept), model.name)


def force_rows(rows: RecordRows, model: ForceModel) -> Array:
    """Return a model's rows (R,) in a record."""
    return RecordForces(rows).of_model(model)


@dataclass(frozen=True)
class _Kept(Changed):
    """A changed force that further effects change: what it is on a record's motion is kept."""

    motion: Motion
    """Of the record."""
    known: dict[Hashable, Array]
    """The latest forces on it."""
    key: Hashable
    """Of this one."""

    def __call__(self, motion: Motion) -> Array:
        """Return the changed force, (N,) N; the same array where it is asked for again."""
        if motion is not self.motion:
            return super().__call__(motion)
        found = self.known.pop(self.key, None)
        if found is None:
            found = super().__call__(motion)
        _keep(self.known, self.key, found, most=_INNER)
        return found


class RecordForces:
    """Models' rows in one record. What a unit of a term adds is kept, the latest of them."""

    def __init__(self, rows: RecordRows) -> None:
        self.rows = rows
        self._motion = rows.motion if rows.cycle is None else rows.cycle
        self._most = min(max(_NUMBERS // self._motion.displacement.size, _FEWEST), _MOST)
        self._units: dict[Hashable, Array] = {}
        self._totals: dict[Hashable, Array] = {}
        self._inner: dict[Hashable, Array] = {}

    def of_model(self, model: ForceModel) -> Array:
        """Return a model's rows (R,)."""
        whole = self._steady(model)
        result = self._rows_of(whole)
        if self._drifts(*model.terms):
            motion = self.rows.motion
            here = at_moments(whole, motion.time, self.rows.observation.frequency)
            result = result + self.rows.of_motion(_drifting(model, motion, here))
        return result

    def passed_on(self, model: ForceModel, terms: Sequence[FittedTerm]) -> Array:
        """Return the rows (K, R) of terms that add a force, as changes in a model pass them on.

        Parameters
        ----------
        model : ForceModel
            What is changed and what changes it: rows are the slopes there.
        terms : sequence of FittedTerm
            K of them, with their coefficients.
        """
        before, drifting = self._steady(model), self._drifts(*model.terms)
        grown = np.zeros((len(terms), before.size))
        others: list[tuple[int, float, FittedTerm]] = []
        for k, t in enumerate(terms):
            slow = self._drifts(t)
            own = _size(unit(t, self.rows.motion) if slow else self._unit(t))
            own *= abs(t.coefficient)
            step = _STEP * (_size(before) or 1.0) / own if own > 0.0 else 1.0
            more = FittedTerm(t.id, step * t.coefficient, t.shape)
            if slow or drifting:
                others.append((k, step, more))
            else:
                grown[k] = (self._steady(model, more) - before) / step
        found = self._rows_of(grown)
        if others:
            start = self.of_model(model)
            for k, step, more in others:
                found[k] = (self.of_model(ForceModel((*model.terms, more))) - start) / step
        return found

    def changes(self, model: ForceModel, terms: Sequence[FittedTerm]) -> Array:
        """Return the rows (K, R) of changes of motion or force, each over its coefficient."""
        before = self.of_model(model)
        found = np.zeros((len(terms), before.size))
        for k, t in enumerate(terms):
            with np.errstate(over="ignore", invalid="ignore"):  # a joint may shake itself apart
                change = (self.of_model(ForceModel((*model.terms, t))) - before) / t.coefficient
                bounded = np.isfinite(change @ change)
            if bounded:
                found[k] = change
        return found

    def _drifts(self, *terms: FittedTerm) -> bool:
        """Tell whether any of some terms has no steady cycle, on which the others are."""
        return self.rows.cycle is not None and any(drifts(t) for t in terms)

    def _rows_of(self, whole: Array) -> Array:
        """Return the rows (..., R) of forces (..., G) that are steady, or (..., M) of samples."""
        if self.rows.cycle_rows is None:
            return self.rows.of_motion(whole)
        return np.asarray(whole @ self.rows.cycle_rows)

    def _steady(self, model: ForceModel, more: FittedTerm | None = None) -> Array:
        """Return the force of what does not drift, on the cycle or at the samples.

        With one term more that adds a force, of which a unit is kept and no sum.
        """
        kept = [t for t in model.terms if not self._drifts(t)]
        adding = [t for t in kept if t.term.acts == "force"]
        changing = tuple(t for t in kept if t.term.acts != "force")
        total = self._total(adding)
        if more is not None:
            total = total + more.coefficient * self._unit(more)
            adding.append(more)
        if not changing:
            return total

        def force_of(motion: Motion) -> Array:
            return total if motion is self._motion else ForceModel(tuple(adding)).added(motion)

        *inner, last = ForceModel(changing).chain
        whole: ForceOf = force_of
        for place, t in enumerate(inner, start=1):
            if t.term.transform is None:
                continue
            key = (_key(adding), _key(inner[:place]))
            whole = _Kept(
                whole, t.term.transform, t.coefficient, t.shape, self._motion, self._inner, key
            )
        return ForceModel((last,)).changed(whole, self._motion)

    def _total(self, adding: Sequence[FittedTerm]) -> Array:
        """Return the sum of what terms add; the same array where it is asked for again."""
        key = _key(adding)
        known = self._totals.get(key)
        if known is None:
            known = np.zeros_like(self._motion.displacement)
            for t in adding:
                known += t.coefficient * self._unit(t)
            _keep(self._totals, key, known, most=_TOTALS)
        return known

    def _unit(self, fitted: FittedTerm) -> Array:
        key = (fitted.id, *fitted.shape.items())
        known = self._units.get(key)
        if known is None:
            known = unit(fitted, self._motion)
            _keep(self._units, key, known, most=self._most)
        return known


def _key(terms: Sequence[FittedTerm]) -> Hashable:
    return tuple((t.id, t.coefficient, *t.shape.items()) for t in terms)


def _size(force: Array) -> float:
    return float(np.sqrt(np.mean(force**2)))


def _keep(known: dict[Hashable, Array], key: Hashable, value: Array, *, most: int) -> None:
    while len(known) >= most:
        known.pop(next(iter(known)))
    known[key] = value


def force_at_samples(observation: Observation, model: ForceModel) -> Array:
    """Return a model's force at a record's usable samples, (N,) N.

    Low-passed to the band where the record is no sine test, as `Observation.measured` is.
    """
    model = in_test(model, observation.test)
    if observation.cycle is None:
        motion = replace(observation.motion, test=observation.test)
        return observation.at_samples(model.force(motion))
    test, sampling = observation.test, observation.motion.step
    cycle = replace(observation.cycle_of(POINTS), test=test, sampling=sampling)
    motion = replace(observation.motion, test=test, sampling=sampling)
    whole = at_moments(steady(model).force(cycle), observation.time, observation.frequency)
    return whole + _drifting(model, motion, whole)


def misfit_power(observation: Observation, model: ForceModel) -> float:
    """Return the mean square (N^2) of all usable samples of a sine test less a model's force.

    Raises
    ------
    ValueError
        Where the observation has no sums of its samples.
    """
    sums = observation.sums
    if sums is None or observation.at is None:
        raise ValueError("the observation has no sums")
    model = in_test(model, observation.test)
    test, sampling = observation.test, observation.motion.step
    cycle = replace(observation.cycle_of(POINTS), test=test, sampling=sampling)
    force = np.broadcast_to(steady(model).force(cycle), sums.count.shape)
    if any(drifts(t) for t in model.terms):
        motion = replace(observation.at(sums.middles.ravel()), test=test, sampling=sampling)
        force = force + _drifting(model, motion, force.ravel()).reshape(force.shape)
    return sums.misfit(force) / sums.samples
