"""A model's force, and a column's, on a record: memory and filters in the steady state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.motion_fit import Observation
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from models.terms import Shape, Term

DELAY = "time-delay"
_PATH = ("hysteresis",)


def needs_cycle(term: Term, shape: Shape) -> bool:
    """Tell whether a term has memory: it then sees one cycle of the steady state."""
    remembers = term.id in _PATH or shape.get("presliding", 0.0) > 0.0
    return term.acts != "force" or remembers


def _from_cycle(observation: Observation, force: Array) -> Array:
    """Return a force on the cycle's grid at the record's samples."""
    cycle = observation.cycle
    if cycle is None:
        return force
    phase = np.mod(observation.motion.time * observation.frequency, 1.0)
    grid = np.arange(force.size + 1) / force.size
    return np.asarray(np.interp(phase, grid, np.append(force, force[0])))


def model_force(observation: Observation, model: ForceModel) -> Array:
    """Return the model's force on the motion's grid, (N,) N.

    What has memory is evaluated over one steady cycle of a sine test; the rest at the samples.
    """
    delay = sum(t.coefficient for t in model.terms if t.id == DELAY)
    if delay and observation.late is not None:
        rest = ForceModel(tuple(t for t in model.terms if t.id != DELAY))
        return model_force(replace(observation, motion=observation.late(delay)), rest)
    motion, cycle = observation.motion, observation.cycle
    if cycle is None or not any(needs_cycle(t.term, t.shape) for t in model.terms):
        return model.force(motion)
    plain = ForceModel(tuple(t for t in model.terms if not needs_cycle(t.term, t.shape)))
    steady = ForceModel(tuple(t for t in model.terms if not _changes(t)))
    steady_plain = ForceModel(tuple(t for t in plain.terms if not _changes(t)))
    change = steady.force(cycle) - steady_plain.force(cycle)
    return plain.force(motion) + _from_cycle(observation, change)


def _changes(fitted: FittedTerm) -> bool:
    return fitted.id in ("thermal-drift", "sensor-drift")


def added_force(
    observation: Observation, model: ForceModel, term: Term, shape: Shape, probe: float
) -> Array:
    """Return the force that a unit of a term adds to `model`, (N,).

    Parameters
    ----------
    observation : Observation
        The record.
    model : ForceModel
        What the term is added to: changes of input and output act on its force.
    term : Term
        The term.
    shape : mapping
        Its shape.
    probe : float
        Coefficient at which a change of input or output is tried.
    """
    if term.id == DELAY and observation.late is not None:
        late = ForceModel((*model.terms, FittedTerm(DELAY, probe)))
        return (model_force(observation, late) - model_force(observation, model)) / probe
    memory = needs_cycle(term, shape) and observation.cycle is not None
    motion = observation.cycle if memory else observation.motion
    if motion is None:
        raise ValueError("a record with memory has a cycle")
    if term.column is not None:
        force = term.column(motion, shape)
    elif term.transform is not None:
        force = _changed(model, term, shape, probe, motion)
    else:
        raise ValueError(f"{term.id} neither adds nor changes a force")
    return _from_cycle(observation, force) if memory else force


def _changed(
    model: ForceModel, term: Term, shape: Shape, probe: float, motion: Motion
) -> Array:
    steady = ForceModel(tuple(t for t in model.terms if not _changes(t)))
    before = steady.force(motion)
    if term.transform is None:
        return before
    after = term.transform(lambda _: before, motion, probe, shape)
    return (after - before) / probe
