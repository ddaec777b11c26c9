"""The curve along which friction reverses: its harmonics hardly tell, the samples beside it do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.gap.stages import record_misfit
from discover.naming.fit import ModelFit, Parameter, fit_model, free_parameters
from discover.naming.reversal import reversing_friction
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_AREA = float(np.log(2.0))  # between sign and tanh, of that between sign and v/sqrt(v^2 + v_t^2)
_CLEARER = 0.99  # of the sum of records' squared gaps, below which the other curve is preferred
_ANOTHER_WIDTH = 1.5  # times the range of reversal: then it stands for something else


def reversing_as_sampled(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    """Return the fit with the curve along which its friction reverses as the samples tell.

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
    terms = list(fit.model.terms)
    friction = terms[place]
    form, speed = friction.shape["form"], friction.shape["transition_speed"]
    as_wide = speed / _AREA if form else speed * _AREA
    other = {**friction.shape, "form": 1.0 - form, "transition_speed": as_wide}
    terms[place] = FittedTerm(friction.id, friction.coefficient, other)
    model = ForceModel(tuple(terms), fit.model.name)
    trial = fit_model(rows, model, free_parameters(model))
    now, before = (
        sum(m.error / max(m.force, 1e-300) for m in (record_misfit(r, f.model) for r in rows))
        for f in (trial, fit)
    )
    width = trial.model.terms[place].shape["transition_speed"] / as_wide
    same = 1.0 / _ANOTHER_WIDTH < width < _ANOTHER_WIDTH
    return trial if same and now < _CLEARER * before else fit
