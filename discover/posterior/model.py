"""A model as it is fitted: terms in some or all units, and which of their numbers are free."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from discover.posterior.sheet import Sheet
from discover.rows import RecordForces
from discover.rows.columns import Behind, finite_slope, force_columns, moved
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.terms import Scales, Shape
from models.terms.between_tests import ONLY

_LATEST = 8  # rows of changed models that are kept a record: a slope changes few records


@dataclass(frozen=True)
class Placed:
    """A term and how much of it is there in each unit."""

    fitted: FittedTerm
    """With its values."""
    share: tuple[float, ...] | None = None
    """(U,) from 0 to 1; None for all of it in all."""
    held: bool = False
    """True where none of its numbers is fitted."""


@dataclass(frozen=True)
class Number:
    """One number of a model that may be fitted."""

    term: int
    """Place of its term."""
    shape: str | None
    """Name of the shape parameter; None for the coefficient."""


@dataclass(frozen=True)
class Composite:
    """Terms, each in some or all units."""

    terms: tuple[Placed, ...]
    """In any order."""

    @classmethod
    def of(cls, model: ForceModel, *, held: bool = False) -> Composite:
        """Return a model that holds in all units."""
        return cls(tuple(Placed(t, held=held) for t in model.terms))

    @property
    def numbers(self) -> tuple[Number, ...]:
        """All that may be fitted; a parameter at its limit stays."""
        found = []
        for place, placed in enumerate(self.terms):
            if placed.held:
                continue
            found.append(Number(place, None))
            found += [Number(place, name) for name in fitted_names(placed.fitted)]
        return tuple(found)

    def value(self, number: Number) -> float:
        """Return a number's value."""
        fitted = self.terms[number.term].fitted
        return fitted.coefficient if number.shape is None else fitted.shape[number.shape]

    def with_values(self, numbers: Sequence[Number], values: Sequence[float]) -> Composite:
        """Return the model with other values."""
        terms = list(self.terms)
        for number, value in zip(numbers, values, strict=True):
            old = terms[number.term].fitted
            if number.shape is None:
                new = FittedTerm(old.id, float(value), old.shape)
            else:
                new = FittedTerm(
                    old.id, old.coefficient, {**old.shape, number.shape: float(value)}
                )
            terms[number.term] = replace(terms[number.term], fitted=new)
        return Composite(tuple(terms))

    def with_shape(self, place: int, shape: Shape) -> Composite:
        """Return the model with one term in another shape."""
        terms = list(self.terms)
        old = terms[place].fitted
        new = FittedTerm(old.id, old.coefficient, {**old.shape, **shape})
        terms[place] = replace(terms[place], fitted=new)
        return Composite(tuple(terms))

    def plus(self, *terms: FittedTerm) -> Composite:
        """Return the model with more terms, in all units."""
        return Composite((*self.terms, *(Placed(t) for t in terms)))

    def without(self, place: int) -> Composite:
        """Return the model without one term."""
        return Composite(tuple(t for i, t in enumerate(self.terms) if i != place))

    def in_unit(self, unit: int) -> ForceModel:
        """Return the model as it is in one unit."""
        terms = []
        for placed in self.terms:
            share = 1.0 if placed.share is None else placed.share[unit]
            if share > 0.0:
                t = placed.fitted
                scaled = t if share == 1.0 else FittedTerm(t.id, share * t.coefficient, t.shape)
                terms.append(scaled)
        return ForceModel(tuple(terms))

    def by_record(self, sheet: Sheet) -> dict[int, ForceModel]:
        """Return the model as it is in each record, by its place: in the record's first unit."""
        first = {u.record: i for i, u in reversed(list(enumerate(sheet.units)))}
        return {
            record: self.in_test(sheet.rows[record].motion.test).in_unit(unit)
            for record, unit in first.items()
        }

    def in_test(self, test: int) -> Composite:
        """Return the model without what is there in other tests only."""
        kept = tuple(
            p for p in self.terms if not test or p.fitted.shape.get(ONLY.name, 0.0) in (0.0, test)
        )
        return self if len(kept) == len(self.terms) else Composite(kept)

    @property
    def changes_force(self) -> bool:
        """True where terms change the force, as a sensor does, and none is simulated in time."""
        changing = [p.fitted.term for p in self.terms if p.fitted.term.acts != "force"]
        return bool(changing) and all(t.acts == "output" and t.impacts is None for t in changing)

    @property
    def adds_up(self) -> bool:
        """True where its force is the sum of what its terms add."""
        return all(p.fitted.term.acts == "force" for p in self.terms)


def fitted_names(fitted: FittedTerm) -> list[str]:
    """Return the shape parameters of a term that a fit may change: not choices, nor limits."""
    found = []
    for p in fitted.term.parameters:
        value = fitted.shape[p.name]
        limit = value == p.default and not p.lower <= p.default <= p.upper
        if p.fitted and not limit and value != 0.0:
            found.append(p.name)
    return found


class Evaluator:
    """Rows of models and of their numbers' slopes; what a unit of a term adds is kept."""

    def __init__(self, sheet: Sheet, scales: Scales, *, coarse: bool = False) -> None:
        self._sheet = sheet
        self._scales = scales
        self._is_coarse = coarse
        self._rows = tuple(r.coarse if coarse else r for r in sheet.rows)
        self._forces = tuple(RecordForces(r) for r in self._rows)
        self._known: dict[tuple[object, ...], Array] = {}
        self._latest: dict[tuple[object, ...], Array] = {}

    @cached_property
    def coarse(self) -> Evaluator:
        """The same with a quarter of a cycle's points: enough for differences between models."""
        return self if self._is_coarse else Evaluator(self._sheet, self._scales, coarse=True)

    def unit(self, fitted: FittedTerm) -> Array:
        """Return the rows (U, R) of a unit of a term that adds a force."""
        key = (fitted.id, *fitted.shape.items())
        if key not in self._known:
            one = FittedTerm(fitted.id, 1.0, fitted.shape)
            blocks = [force_columns(r, [one]) for r in self._rows]
            self._known[key] = self._sheet.stack(blocks)[:, 0]
        return self._known[key]

    def behind(self, model: Composite) -> Behind:
        """Return what gives columns of terms as a model's changes pass them on."""
        by_record = model.by_record(self._sheet).items()
        return Behind(
            {self._rows[place].file: own for place, own in by_record},
            {self._rows[place].file: self._forces[place] for place, _ in by_record},
        )

    def trials(self, model: Composite, terms: Sequence[FittedTerm]) -> Array:
        """Return the rows (U, K, R) of terms that may join a model, over their coefficients.

        Terms that change the motion or the force do so to the model's force in each record.
        """
        blocks = []
        first = {u.record: i for i, u in reversed(list(enumerate(self._sheet.units)))}
        adding = [k for k, t in enumerate(terms) if t.term.acts == "force"]
        changing = [k for k, t in enumerate(terms) if t.term.acts != "force"]
        for place, (rows, forces) in enumerate(zip(self._rows, self._forces, strict=True)):
            whole = np.zeros((len(terms), rows.target.size))
            if adding:
                whole[adding] = force_columns(rows, [terms[k] for k in adding])
            if changing:
                here = model.in_unit(first[place])
                whole[changing] = forces.changes(here, [terms[k] for k in changing])
            blocks.append(whole)
        return self._sheet.stack(blocks)

    def force(self, model: Composite) -> Array:
        """Return a model's rows (U, R)."""
        if model.adds_up:
            total = np.zeros_like(self._sheet.target)
            for placed in model.terms:
                share = 1.0 if placed.share is None else np.array(placed.share)[:, None]
                total += placed.fitted.coefficient * share * self.unit(placed.fitted)
            return total
        return self._changed(model)

    def _changed(self, model: Composite) -> Array:
        """Return the rows of a model whose motion or force is changed."""
        blocks: list[Array] = []
        divided = any(p.share is not None for p in model.terms)
        known: dict[tuple[int, int], Array] = {}
        for place, unit in enumerate(self._sheet.units):
            at = (unit.record, place if divided else 0)
            own = known.get(at)
            if own is None:
                test = self._rows[unit.record].motion.test
                own = self._of_record(unit.record, model.in_test(test).in_unit(place))
                known[at] = own
            part = own[None][:, unit.part]
            blocks.append(part if unit.basis is None else part @ unit.basis)
        size = self._sheet.target.shape[1]
        result = np.zeros((len(blocks), size))
        for place, block in enumerate(blocks):
            result[place, : block.shape[1]] = block[0]
        return result

    def _of_record(self, record: int, model: ForceModel) -> Array:
        """Return the rows (R_r,) of a model in a record; the latest of them are kept."""
        key = (record, tuple((t.id, t.coefficient, *t.shape.items()) for t in model.terms))
        own = self._latest.pop(key, None)
        if own is None:
            with np.errstate(over="ignore", invalid="ignore"):  # a joint may shake itself apart
                own = self._forces[record].of_model(model)
            while len(self._latest) >= _LATEST * len(self._rows):
                self._latest.pop(next(iter(self._latest)))
        self._latest[key] = own
        return own

    def slopes(self, model: Composite, numbers: Sequence[Number]) -> Array:
        """Return the change (U, P, R) of a model's rows with each number.

        Of models that have to be simulated, from the coarse rows.
        """
        found = []
        linear = model.adds_up
        if not linear and not self._is_coarse:
            return self.coarse.slopes(model, numbers)
        at = self.force(model)
        for number in numbers:
            placed = model.terms[number.term]
            share = 1.0 if placed.share is None else np.array(placed.share)[:, None]
            if linear and number.shape is None:
                found.append(share * self.unit(placed.fitted))
                continue
            if number.shape is None:
                step = 1e-3 * abs(placed.fitted.coefficient) or 1e-6
                value = placed.fitted.coefficient + step
            else:
                shape, step = moved(
                    placed.fitted.term, dict(placed.fitted.shape), number.shape, self._scales
                )
                value = shape[number.shape]
            other = model.with_values([number], [value])
            if linear:
                there = other.terms[number.term].fitted
                change = self.unit(there) - self.unit(placed.fitted)
                found.append(placed.fitted.coefficient * share * change / step)
                continue
            found.append(finite_slope((self.force(other) - at) / step))
        return np.stack(found, axis=1) if found else np.zeros((at.shape[0], 0, at.shape[1]))
