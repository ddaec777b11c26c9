"""Whitened rows of models on records: what is asked for again is evaluated once."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np

from discover.naming.forces import DELAY, Trial, change_on_cycle, model_force, of_test, steady_part
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion

_FORCES = 4  # a record, that are remembered
_COLUMNS = 64  # likewise


def whole_model(rows: RecordRows, model: ForceModel) -> ForceModel:
    """Return the model with the terms that the record holds."""
    return ForceModel((*rows.held, *model.terms), model.name) if rows.held else model


class UnitRows:
    """Whitened rows of terms with coefficient one: each shape is evaluated once."""

    def __init__(self) -> None:
        self._known: dict[Hashable, Array] = {}
        self._rows: dict[int, RecordRows] = {}
        self._forces: dict[int, dict[Hashable, Array]] = {}
        self._columns: dict[int, dict[Hashable, Array]] = {}

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
                self._known[key] = r.project(force)
        return self._known[key]

    def of_all(self, rows: Sequence[RecordRows], fitted: FittedTerm) -> Array:
        """Return the rows of several records after each other."""
        return np.concatenate([self.of(r, fitted) for r in rows])

    def of_model(self, rows: Sequence[RecordRows], model: ForceModel) -> Array:
        """Return the rows of a model's force, with the terms that each record holds."""
        return np.concatenate([self._of_record(r, model) for r in rows])

    def _of_record(self, r: RecordRows, model: ForceModel) -> Array:
        whole = of_test(r.observation, whole_model(r, model))
        changes = [t for t in whole.terms if t.term.acts != "force"]
        if any(t.id == DELAY for t in changes) or (changes and r.cycle_rows is None):
            return r.project(model_force(r.observation, whole))
        result = np.zeros(r.target.size)
        for t in whole.terms:
            if t.term.acts == "force":
                result += t.coefficient * self.of(r, t)
        if changes and r.cycle_rows is not None:
            with np.errstate(over="ignore", invalid="ignore"):  # a joint that shakes itself apart
                result += self._change(r, steady_part(whole)) @ r.cycle_rows
        return result

    def _change(self, r: RecordRows, steady: ForceModel) -> Array:
        """Return what a joint or a sensor changes: the force before it is evaluated once."""
        cycle = r.observation.cycle
        if cycle is None:
            raise ValueError("only a sine test has a cycle")
        self._rows[id(r)] = r
        added = [t for t in steady.terms if t.term.acts == "force"]
        key = tuple((t.coefficient, *_shape_key(t)) for t in added)
        known = self._forces.setdefault(id(r), {})
        if key not in known:
            total = np.zeros_like(cycle.displacement)
            for t in added:
                total += t.coefficient * self._on_cycle(r, t, cycle)
            _keep(known, key, total, most=_FORCES)
        return change_on_cycle(r.observation, steady, known[key])

    def _on_cycle(self, r: RecordRows, fitted: FittedTerm, cycle: Motion) -> Array:
        known = self._columns.setdefault(id(r), {})
        key = _shape_key(fitted)
        if key not in known:
            unit = ForceModel((FittedTerm(fitted.id, 1.0, fitted.shape),))
            _keep(known, key, unit.added(cycle), most=_COLUMNS)
        return known[key]


def _shape_key(fitted: FittedTerm) -> tuple[Hashable, ...]:
    return fitted.id, tuple(fitted.shape.items())


def _keep(known: dict[Hashable, Array], key: Hashable, value: Array, *, most: int) -> None:
    """Remember a value, and forget the oldest where that are more than `most`."""
    while len(known) >= most:
        known.pop(next(iter(known)))
    known[key] = value
