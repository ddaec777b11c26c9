"""The curve along which friction reverses: its harmonics hardly tell, the samples beside it do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.accuracy import Misfit
from discover.gap.stages import record_misfit
from discover.naming.fit import ModelFit, Parameter, fit_model, free_parameters
from discover.naming.reversal import reversing_friction
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_AREA = float(np.log(2.0))  # between sign and tanh, of that between sign and v/sqrt(v^2 + v_t^2)
_CLEARER = 0.99  # of the sum of records' squared gaps, below which another curve is preferred
_ANOTHER_WIDTH = 1.5  # times the range of reversal: then it stands for something else
_MET = 1.1  # of a record's noise, up to which a knee of its own has to bring every gap


def reversing_as_sampled(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit with the curve along which its friction reverses as the samples tell.

    A knee of its own (`sharpness`) could stand for an effect that is missing: it is taken only
    where nothing is left then.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Of a model; returned as it is where none of its friction's range of reversal is free.
    """
    place = reversing_friction(fit.model)
    if place is None or Parameter(place, "transition_speed") not in fit.parameters:
        return fit
    best, left = fit, _misfits(rows, fit)
    form, speed, sharpness = _curve(fit, place)
    if sharpness == 0.0:
        as_wide = speed / _AREA if form else speed * _AREA
        trial = _with_curve(rows, fit, place, 1.0 - form, as_wide, 0.0)
        width = _curve(trial, place)[1] / as_wide
        now = _misfits(rows, trial)
        if 1.0 / _ANOTHER_WIDTH < width < _ANOTHER_WIDTH and _gap(now) < _CLEARER * _gap(left):
            best, left = trial, now
    if _met(left):
        return best
    form, speed, _ = _curve(best, place)
    knee = _with_curve(rows, best, place, form, speed, 1.0)
    now = _misfits(rows, knee)
    return knee if _met(now) and _gap(now) < _CLEARER * _gap(left) else best


def _curve(fit: ModelFit, place: int) -> tuple[float, float, float]:
    shape = fit.model.terms[place].shape
    return shape["form"], shape["transition_speed"], shape["sharpness"]


def _with_curve(
    rows: Sequence[RecordRows], fit: ModelFit, place: int, form: float, speed: float,
    sharpness: float,
) -> ModelFit:
    terms = list(fit.model.terms)
    friction = terms[place]
    own = {"form": form, "transition_speed": speed, "sharpness": sharpness}
    terms[place] = FittedTerm(friction.id, friction.coefficient, {**friction.shape, **own})
    model = ForceModel(tuple(terms), fit.model.name)
    return fit_model(rows, model, free_parameters(model))


def _misfits(rows: Sequence[RecordRows], fit: ModelFit) -> list[Misfit]:
    return [record_misfit(r, fit.model) for r in rows]


def _gap(left: Sequence[Misfit]) -> float:
    """Return the sum of squared gaps, each record's by its own force."""
    return sum(m.error / max(m.force, 1e-300) for m in left)


def _met(left: Sequence[Misfit]) -> bool:
    return all(m.percent <= _MET * m.noise_percent for m in left)
