"""A model's force on a record: what has memory in its steady state, what drifts over the record."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.motion_fit import Observation
from discover.rows.record_rows import RecordRows
from discover.rows.sine_rows import POINTS
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from models.terms.between_tests import ONLY


def drifts(fitted: FittedTerm) -> bool:
    """Tell whether a term changes while a record lasts: it then has no steady cycle."""
    return fitted.term.remembers(fitted.shape) == "time"


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
    if rows.cycle is None or rows.cycle_rows is None:
        return rows.of_motion(model.force(rows.motion))
    whole = steady(model).force(rows.cycle)
    result = np.asarray(whole @ rows.cycle_rows)
    if any(drifts(t) for t in model.terms):
        here = at_moments(whole, rows.motion.time, rows.observation.frequency)
        result = result + rows.of_motion(_drifting(model, rows.motion, here))
    return result


def force_at_samples(observation: Observation, model: ForceModel) -> Array:
    """Return a model's force at a record's usable samples, (N,) N.

    Low-passed to the band where the record is no sine test, as `Observation.measured` is.
    """
    model = in_test(model, observation.test)
    if observation.cycle is None:
        motion = replace(observation.motion, test=observation.test)
        return observation.at_samples(model.force(motion))
    numbered = {"test": observation.test, "sampling": observation.motion.step}
    cycle = replace(observation.cycle_of(POINTS), **numbered)
    whole = at_moments(steady(model).force(cycle), observation.time, observation.frequency)
    return whole + _drifting(model, replace(observation.motion, **numbered), whole)
