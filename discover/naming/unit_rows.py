"""Whitened rows of models on records: what is asked for again is evaluated once."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np

from discover.naming.forces import (
    Trial,
    at_samples,
    change_on_cycle,
    is_sensor,
    model_force,
    of_test,
    steady_part,
)
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion
from models.terms.joint_device import at_rest

_FORCES = 4  # a record, that are remembered
_CHANGED = 4  # likewise
_COLUMNS = 128  # likewise
_SHAPES = 64  # over all records, likewise
_SAME = 1e-12  # of the greatest force
_MOSTLY = 0.5  # of the samples, from which a force is projected whole


def whole_model(rows: RecordRows, model: ForceModel) -> ForceModel:
    """Return the model with the terms that the record holds."""
    return ForceModel((*rows.held, *model.terms), model.name) if rows.held else model


class UnitRows:
    """Whitened rows of terms with coefficient one: each shape is evaluated once."""

    def __init__(self) -> None:
        self._known: dict[Hashable, Array] = {}
        self._first: dict[tuple[int, str], tuple[Array, Array]] = {}
        self._of_all: dict[Hashable, Array] = {}
        self._rows: dict[int, RecordRows] = {}
        self._forces: dict[int, dict[Hashable, Array]] = {}
        self._columns: dict[int, dict[Hashable, Array]] = {}
        self._changed: dict[int, dict[Hashable, Array]] = {}

    def of(self, r: RecordRows, fitted: FittedTerm) -> Array:
        """Return the rows (R,) of a term that adds a force, in one record."""
        key = (id(r), *_shape_key(fitted))
        self._rows[id(r)] = r  # kept, so that no other record gets its id
        if key not in self._known:
            trial = Trial(r.observation, ForceModel(()))
            force = trial.added(fitted.term, fitted.shape, 1.0)
            if r.cycle_rows is not None and trial.on_cycle(fitted.term, fitted.shape):
                self._known[key] = np.asarray(force @ r.cycle_rows)
            else:
                self._known[key] = self._projected(r, fitted.id, force)
        return self._known[key]

    def _projected(self, r: RecordRows, effect: str, force: Array) -> Array:
        """Return the rows of a force at the samples: what differs from the first of its effect.

        Another range over which friction reverses changes it at reversals only.
        """
        if r.sample_rows is None:
            return r.project(force)
        first = self._first.get((id(r), effect))
        if first is None:
            rows = r.project(force)
            self._first[id(r), effect] = force, rows
            return rows
        change = force - first[0]
        there = np.flatnonzero(np.abs(change) > _SAME * float(np.abs(force).max()))
        if there.size > _MOSTLY * force.size:
            return r.project(force)
        return np.asarray(first[1] + change[there] @ r.sample_rows[there])

    def of_all(self, rows: Sequence[RecordRows], fitted: FittedTerm) -> Array:
        """Return the rows of several records after each other."""
        key = (*(id(r) for r in rows), *_shape_key(fitted))
        if key not in self._of_all:
            found = np.concatenate([self.of(r, fitted) for r in rows])
            _keep(self._of_all, key, found, most=_SHAPES)
        return self._of_all[key]

    def of_model(self, rows: Sequence[RecordRows], model: ForceModel) -> Array:
        """Return the rows of a model's force, with the terms that each record holds."""
        result = np.zeros(sum(r.target.size for r in rows))
        for t in model.terms:
            if t.term.acts == "force":
                result += t.coefficient * self.of_all(rows, t)
        end = 0
        for r in rows:
            begin, end = end, end + r.target.size
            for t in r.held:
                if t.term.acts == "force":
                    result[begin:end] += t.coefficient * self.of(r, t)
            if any(t.term.acts != "force" for t in (*r.held, *model.terms)):
                self._complete(result[begin:end], r, whole_model(r, model))
        return result

    def of_sensed(
        self, rows: Sequence[RecordRows], fitted: FittedTerm, model: ForceModel
    ) -> Array:
        """Return the rows (R,) of a term that adds a force, as a model's sensors read it alone.

        They are the term's share of the whole where every sensor `adds_up`.
        """
        if not any(is_sensor(t.term) for r in rows for t in (*r.held, *model.terms)):
            return self.of_all(rows, fitted)
        unit = FittedTerm(fitted.id, 1.0, fitted.shape)
        parts = []
        for r in rows:
            sensors = [t for t in (*r.held, *model.terms) if is_sensor(t.term)]
            part = self.of(r, fitted).copy()
            self._complete(part, r, ForceModel((unit, *sensors)))
            parts.append(part)
        return np.concatenate(parts)

    def _complete(self, added: Array, r: RecordRows, whole: ForceModel) -> None:
        """Complete the rows of what a model adds by what of it is changed."""
        whole = of_test(r.observation, whole)
        changes = [t for t in whole.terms if t.term.acts != "force"]
        if not changes:
            return
        known = self._changed.setdefault(id(r), {})
        key = tuple((t.coefficient, *_shape_key(t)) for t in whole.terms)
        at_cycle = None if any(at_samples(t.term, t.shape) for t in changes) else r.cycle_rows
        found = known.pop(key, None)
        if found is None:
            self._rows[id(r)] = r
            if at_cycle is None:
                found = r.project(model_force(r.observation, whole, resolved=False))
            else:
                with np.errstate(over="ignore", invalid="ignore"):  # a joint shakes itself apart
                    found = np.asarray(self._change(r, steady_part(whole)) @ at_cycle)
        _keep(known, key, found, most=_CHANGED)  # what was used last is forgotten last
        added[:] = found if at_cycle is None else added + found

    def _change(self, r: RecordRows, steady: ForceModel) -> Array:
        """Return what a joint or a sensor changes: the force before it is evaluated once."""
        cycle = r.observation.cycle
        if cycle is None:
            raise ValueError("only a sine test has a cycle")
        added = [t for t in steady.terms if t.term.acts == "force"]
        key = tuple((t.coefficient, *_shape_key(t)) for t in added)
        known = self._forces.setdefault(id(r), {})
        if key not in known:
            _keep(known, key, self._sum(r, added, cycle), most=_FORCES)
        total, still = known[key], at_rest(cycle)

        def force_of(moved: Motion) -> Array:
            if moved is cycle:
                return total
            return self._sum(r, added, still) if moved is still else steady.added(moved)

        return change_on_cycle(r.observation, steady, force_of)

    def _sum(self, r: RecordRows, added: Sequence[FittedTerm], motion: Motion) -> Array:
        """Return the sum of terms on a record's cycle, or on that at rest."""
        total = np.zeros_like(motion.displacement)
        for t in added:
            total += t.coefficient * self._on_cycle(r, t, motion)
        return total

    def _on_cycle(self, r: RecordRows, fitted: FittedTerm, motion: Motion) -> Array:
        known = self._columns.setdefault(id(r), {})
        key = (motion is r.observation.cycle, *_shape_key(fitted))
        if key not in known:
            unit = ForceModel((FittedTerm(fitted.id, 1.0, fitted.shape),))
            _keep(known, key, unit.added(motion), most=_COLUMNS)
        return known[key]


def _shape_key(fitted: FittedTerm) -> tuple[Hashable, ...]:
    return fitted.id, tuple(fitted.shape.items())


def _keep(known: dict[Hashable, Array], key: Hashable, value: Array, *, most: int) -> None:
    """Remember a value, and forget the oldest where that are more than `most`."""
    while len(known) >= most:
        known.pop(next(iter(known)))
    known[key] = value
