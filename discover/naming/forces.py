"""A model's force, and a column's, on a record: memory and filters in the steady state."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from discover.motion_fit import Observation
from discover.naming.last import Last, key_of
from discover.naming.late import (
    ForceOn,
    aligned,
    at,
    from_cycle,
    is_digital,
    low_passed,
    low_passed_digitally,
    shows,
    summed,
)
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from models.terms import TERMS, ForceOf, Shape, Term
from models.terms.time_delay import delay_at

DELAY = "time-delay"
MOST_FILTERED = 0.3  # of a gain: with its filter a greater one is any delay, or memory of a flow


def needs_cycle(term: Term, shape: Shape) -> bool:
    """Tell whether a term has memory: it then sees one cycle of the steady state."""
    remembers = term.follows == "path" or shape.get("presliding", 0.0) > 0.0
    return term.acts != "force" or remembers


def behind_filter(shape: Shape) -> bool:
    """Tell whether a sensor's gain acts behind a low-pass."""
    return shape.get("filter_time", 0.0) > 0.0


def coefficient_bounds(shape: Shape) -> tuple[float, float]:
    """Return what a coefficient lies between where a sensor's shape bounds it."""
    if behind_filter(shape):
        return -MOST_FILTERED, MOST_FILTERED
    if shape.get("filter_order", 0.0) > 0.0:
        return 0.0, np.inf
    return (-1.0, 0.0) if shape.get("droop_time", 0.0) > 0.0 else (-np.inf, np.inf)


def adds_up(term: Term, shape: Shape) -> bool:
    """Tell whether a sensor makes of a sum of forces the sum of what it makes of each."""
    if term.id == DELAY:
        return True
    part = any(shape.get(name, 0.0) > 0.0 for name in ("one_way", "threshold", "load_power"))
    return term.id == "sensor-gain" and not part and shape.get("side", 1.0) >= 0.0


def _of_samples(fitted: FittedTerm) -> bool:
    """Tell whether a sensor works on the samples: what it reads has no cycle."""
    return any(fitted.shape.get(name, 0.0) > 0.0 for name in ("resampled", "digital"))


def at_samples(term: Term, shape: Shape) -> bool:
    """Tell whether a term is evaluated at the samples: what shifts them, or changes meanwhile."""
    return term.id == DELAY or behind_filter(shape) or in_record(term, shape)


def has_joint(model: ForceModel) -> bool:
    """Tell whether something in a model moves through a joint, with impacts."""
    return any(is_joint(t.id) for t in model.terms)


def has_impacts(model: ForceModel) -> bool:
    """Tell whether a joint in a model is met at once, as flanks or a closing void are.

    What only yields moves smoothly: lines tell it as well as samples do.
    """
    return any(is_joint(t.id) and t.shape.get("contact", 0.0) > 0.0 for t in model.terms)


def is_joint(effect: str) -> bool:
    """Tell whether an effect is a joint, simulated in time."""
    return TERMS[effect].acts == "input" or effect == "cavitation"


def is_sensor(term: Term) -> bool:
    """Tell whether a term changes what is read of a force, and not how the device moves."""
    return term.acts == "output" and not is_joint(term.id)


def in_record(term: Term, shape: Shape) -> bool:
    """Tell whether a term changes while a record lasts: it then has no steady cycle."""
    changes = term.follows == "time" or shape.get("settling_time", 0.0) > 0.0
    return changes and shape.get("over", 0.0) == 0.0


def of_each_test(model: ForceModel, effect: str) -> bool:
    """Tell whether a model holds an effect by values of every test's own."""
    return any(t.id == effect and t.shape.get("only", 0.0) > 0.0 for t in model.terms)


def by_others(observation: Observation, model: ForceModel) -> ForceModel:
    """Return a model with the mean of other tests' own values in place of a record's own."""
    kept = [t for t in model.terms if not t.shape.get("only", 0.0)]
    if len(kept) == len(model.terms):
        return model
    kinds: dict[tuple[object, ...], list[FittedTerm]] = {}
    for t in model.terms:
        if t.shape.get("only", 0.0):
            kind = tuple((k, v) for k, v in t.shape.items() if k != "only")
            kinds.setdefault((t.id, *kind), []).append(t)
    for own in kinds.values():
        others = [t.coefficient for t in own if t.shape["only"] != observation.test]
        shape = {**own[0].shape, "only": float(observation.test)}
        kept.append(FittedTerm(own[0].id, float(np.mean(others or [0.0])), shape))
    return ForceModel(tuple(kept), model.name)


def share_in(observation: Observation, shape: Shape) -> float:
    """Return how much of a term is there in a record's test: from 0 to 1, where it grows."""
    return _share(observation.test, shape)


def _share(number: int, shape: Shape) -> float:
    """Return how much of a term is there in a campaign's test; `number` 0 where it isn't known."""
    if shape.get("only", 0.0) > 0.0 and number != shape["only"]:
        return 0.0
    if number == 0:
        return 1.0
    late = number - shape.get("from_test", 0.0) + 1.0
    return min(max(late / max(shape.get("over", 0.0), 1.0), 0.0), 1.0)


def of_test(observation: Observation, model: ForceModel) -> ForceModel:
    """Return a model with as much of each term as there is in a record's test."""
    return of_number(observation.test, model)


def of_number(number: int, model: ForceModel) -> ForceModel:
    """Return a model with as much of each term as there is in a campaign's test, from 1."""
    shares = [_share(number, t.shape) for t in model.terms]
    if all(share == 1.0 for share in shares):
        return model
    terms = tuple(
        FittedTerm(t.id, share * t.coefficient, t.shape)
        for t, share in zip(model.terms, shares, strict=True)
        if share > 0.0
    )
    return ForceModel(terms, model.name)


def model_force(
    observation: Observation, model: ForceModel, *, resolved: bool = True
) -> Array:
    """Return the model's force on the motion's grid, (N,) N.

    What has memory is evaluated over one steady cycle of a sine test; the rest at the samples.

    Parameters
    ----------
    observation : Observation
        The record.
    model : ForceModel
        As fitted.
    resolved : bool
        Whether a joint's impacts are simulated as finely as samples show them; lines don't.
    """
    if resolved and has_impacts(model):
        observation = observation.resolved
    return _force(observation, of_test(observation, model))


def _force(observation: Observation, model: ForceModel) -> Array:
    """Return the force of a model with as much of each term as there is in the test."""
    gains = [t for t in model.terms if t.term.acts == "output" and in_record(t.term, t.shape)]
    if gains:
        rest = ForceModel(tuple(t for t in model.terms if t not in gains))
        force = _force(observation, rest)
        return ForceModel(tuple(gains)).changed(lambda _: force, observation.motion)
    filtered = [t for t in model.terms if behind_filter(t.shape)]
    if filtered and observation.at is not None:
        rest = ForceModel(tuple(t for t in model.terms if t not in filtered))
        force = _force(observation, rest)
        for t in filtered:
            on_samples = t.shape.get("digital", 0.0) > 0.0
            passed = _low_passed(observation, rest, t.shape["filter_time"], 1, digital=on_samples)
            force = force + t.coefficient * passed
        return force
    delays = [t for t in model.terms if t.id == DELAY]
    if delays and observation.at is not None:
        rest = ForceModel(tuple(t for t in model.terms if t.id != DELAY))
        step = observation.motion.step
        delay = sum(delay_at(step, t.coefficient, t.shape) for t in delays)
        degree, order, digital = (
            int(max(t.shape.get(name, 0.0) for t in delays))
            for name in ("resampled", "filter_order", "digital")
        )
        if order and delay > 0.0:
            late = _low_passed(observation, rest, delay, order, digital=digital > 0)
            steady = steady_part(rest)
            if len(steady.terms) == len(rest.terms):
                return late
            return late + _force(observation, rest) - _force(observation, steady)
        if degree:
            key = key_of(rest)
            return aligned(observation, lambda there: _force(there, rest), key, delay, degree)
        return _force(at(observation, observation.motion.time - delay), rest)
    motion, cycle = observation.motion, observation.cycle
    if cycle is None or not any(needs_cycle(t.term, t.shape) for t in model.terms):
        return model.force(motion)
    plain = ForceModel(tuple(t for t in model.terms if not needs_cycle(t.term, t.shape)))
    return plain.force(motion) + from_cycle(observation, _remembered(cycle, model, plain))


_CHANGES: Last[Array] = Last()  # at other times of a cycle, as behind a delay, they are the same


def _remembered(cycle: Motion, model: ForceModel, plain: ForceModel) -> Array:
    """Return what a model's terms with memory add to the plain ones over a cycle, (G,) N."""
    steady = steady_part(model)

    def change() -> Array:
        return np.asarray(steady.force(cycle) - steady_part(plain).force(cycle))

    return _CHANGES.of(cycle, key_of(steady), change)


def _on_record(model: ForceModel) -> ForceOn:
    return lambda there: _force(there, model)


def _on_motion(model: ForceModel) -> ForceOn:
    return lambda there: model.force(there.motion)


def _low_passed(
    observation: Observation, model: ForceModel, delay: float, order: int, *, digital: bool
) -> Array:
    """Return the steady force behind a low-pass that delays slow forces, (N,) at the samples."""
    model = steady_part(model)
    force = _on_record(model)
    if digital and is_digital(observation, delay):
        return low_passed_digitally(observation, force, key_of(model), delay, order)
    if any(_of_samples(t) for t in model.terms):
        if not shows(observation, delay):
            return summed(observation, force, delay, order)
        force = _on_motion(model)  # such a filter rounds what samples do
    return low_passed(observation, force, key_of(model), delay, order)


def steady_part(model: ForceModel) -> ForceModel:
    """Return a model without what changes over time: it has a steady cycle."""
    return ForceModel(tuple(t for t in model.terms if not in_record(t.term, t.shape)))


def change_on_cycle(observation: Observation, model: ForceModel, added: ForceOf) -> Array:
    """Return what changes of input and output do to a model's force over one cycle, (G,) N.

    Parameters
    ----------
    observation : Observation
        Of a sine test.
    model : ForceModel
        Its `steady_part`.
    added : callable
        The sum of the model's terms that add a force, N, on a motion. Where it gives the same
        array again on the cycle, joints know their device.
    """
    cycle = observation.cycle
    if cycle is None:
        raise ValueError("only a sine test has a cycle")
    return model.changed(added, cycle) - added(cycle)


@dataclass(frozen=True)
class Trial:
    """What terms are tried beside on one record: its motion and the model's force on it."""

    observation: Observation
    """The record."""
    model: ForceModel
    """What a term is added to: changes of input and output act on its force."""

    @cached_property
    def _late_from(self) -> Array:
        return model_force(self.observation, self.model, resolved=False)

    @cached_property
    def _on_cycle(self) -> Array | None:
        cycle = self.observation.cycle
        return None if cycle is None else self._steady.force(cycle)

    @cached_property
    def _at_samples(self) -> Array:
        return self._steady.force(self.observation.motion)

    @property
    def _steady(self) -> ForceModel:
        return steady_part(of_test(self.observation, self.model))

    def on_cycle(self, term: Term, shape: Shape) -> bool:
        """Tell whether a term is evaluated over one steady cycle: all but jumps and slow change."""
        if self.observation.cycle is None or at_samples(term, shape):
            return False
        return needs_cycle(term, shape) or "transition_speed" not in shape

    def added(self, term: Term, shape: Shape, probe: float) -> Array:
        """Return the force that a unit of a term adds, on the cycle or at the motion's samples.

        Parameters
        ----------
        term : Term
            The term.
        shape : mapping
            Its shape.
        probe : float
            Coefficient at which a change of input or output is tried.
        """
        share = share_in(self.observation, shape)
        shifts = term.id == DELAY or behind_filter(shape)
        if share > 0.0 and shifts and self.observation.at is not None:
            late = ForceModel((*self.model.terms, FittedTerm(term.id, probe, shape)))
            return (model_force(self.observation, late, resolved=False) - self._late_from) / probe
        cycle = self.observation.cycle if self.on_cycle(term, shape) else None
        motion = self.observation.motion if cycle is None else cycle
        if share == 0.0:
            return np.zeros_like(motion.displacement)
        if term.column is not None:
            return share * term.column(motion, shape)
        if term.transform is None:
            raise ValueError(f"{term.id} neither adds nor changes a force")
        if cycle is None and term.acts == "output" and in_record(term, shape):
            whole = self._late_from
            changed = term.transform(lambda _: whole, motion, share * probe, shape)
            return (changed - whole) / probe
        before = self._at_samples if cycle is None or self._on_cycle is None else self._on_cycle

        def force_of(moved: Motion) -> Array:
            return before if moved is motion else self._steady.force(moved)

        return (term.transform(force_of, motion, share * probe, shape) - before) / probe
