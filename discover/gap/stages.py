"""A model on all records: its misfit on those that were fitted, and on those that were not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.gap.accuracy import Misfit, misfit, pooled, records_alike
from discover.naming.fit import ModelFit, fit_model
from discover.naming.forces import by_others, has_impacts, has_joint, model_force
from discover.naming.polish import counted
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import UnitRows, whole_model
from models.checks import Array
from models.constitutive import ForceModel

_FOLDS = 16
_LEFT_OUT_STEPS = 3
_LEFT_OUT_ENOUGH = 0.01
_UNSEEN = 0.03  # of what all records tell about a parameter: what less is told of stays


@dataclass(frozen=True)
class Stage:
    """A model on all records: before the first round, or after one."""

    fit: ModelFit
    """On the fitted records."""
    misfits: tuple[Misfit, ...]
    """Of every record, by the fitted model."""
    unseen: tuple[Misfit, ...]
    """Of the records that were not fitted: the held-out ones, or each left out in turn."""


def stage(rows: Sequence[RecordRows], fit: ModelFit) -> Stage:
    """Return what a fitted model makes of every record."""
    found = tuple(record_misfit(r, fit.model) for r in rows)
    held = tuple(_of_unseen(r, fit.model) for r in rows if r.observation.held_out)
    return Stage(fit, found, held or left_out(rows, fit))


def record_misfit(rows: RecordRows, model: ForceModel) -> Misfit:
    """Return one record's misfit by a model fitted to it or to others."""
    return misfit(rows.observation, model_force(rows.observation, whole_model(rows, model)))


def _of_unseen(rows: RecordRows, model: ForceModel) -> Misfit:
    """Return the misfit of a record that a model was not fitted to: of its own it knows nothing."""
    return record_misfit(rows, by_others(rows.observation, model))


def left_out(rows: Sequence[RecordRows], fit: ModelFit) -> tuple[Misfit, ...]:
    """Return each record's misfit by the model fitted to the others.

    Of more than sixteen records several are left out at once. Beside a joint or a sensor's effect
    what only a record that is left out tells about (the one in which a joint opens, say) stays as
    it is; a value of its own is the mean of the others'.
    """
    if len(rows) < 2:
        return ()
    if not fit.parameters:
        return tuple(record_misfit(r, fit.model) for r in rows)
    seen = counted(rows, fit) if has_impacts(fit.model) else rows
    changes = any(t.term.acts != "force" for t in fit.model.terms)
    units = UnitRows()
    along = _tangents_of_each(seen, fit, units) if changes else None
    stay = None
    if along is not None:
        stay = _UNSEEN * np.sum([part @ part.T for part in along], axis=0)
    found: dict[int, Misfit] = {}
    folds = min(len(rows), _FOLDS)
    for fold in range(folds):
        rest = [i for i in range(len(rows)) if i % folds != fold]
        refit = fit_model(
            [seen[i] for i in rest], fit.model, fit.parameters, iterations=_LEFT_OUT_STEPS,
            enough=_LEFT_OUT_ENOUGH, units=units, exact=False, stay=stay,
            along=None if along is None else np.concatenate([along[i] for i in rest], axis=1),
        )
        for i in range(fold, len(rows), folds):
            found[i] = _of_unseen(rows[i], refit.model)
    return tuple(found[i] for i in range(len(rows)))


def _tangents_of_each(
    rows: Sequence[RecordRows], fit: ModelFit, units: UnitRows
) -> list[Array]:
    """Return the tangents of every record's rows at a fit."""
    here = fit_model(
        rows, fit.model, fit.parameters, iterations=0, units=units, exact=False,
        rough=not has_joint(fit.model),
    )
    return np.split(here.tangents, np.cumsum([r.target.size for r in rows])[:-1], axis=1)


def seen_gap(rows: Sequence[RecordRows], at: Stage) -> float:
    """Return the gap of the fitted records, pooled in N, %."""
    return pooled(_seen(rows, at))


def seen_alike(rows: Sequence[RecordRows], at: Stage) -> float:
    """Return the root mean square of the fitted records' own relative gaps, %."""
    return records_alike(_seen(rows, at))


def _seen(rows: Sequence[RecordRows], at: Stage) -> list[Misfit]:
    found = zip(rows, at.misfits, strict=True)
    return [m for r, m in found if not r.observation.held_out]


def without(model: ForceModel, effect: str) -> ForceModel:
    """Return the model without an effect."""
    return ForceModel(tuple(t for t in model.terms if t.id != effect), model.name)
