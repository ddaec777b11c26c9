"""A record that was not fitted, with values of its own where every test has its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from discover.rows.force import RecordForces, in_test
from discover.rows.record_rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.terms.between_tests import ONLY


def with_own_values(model: ForceModel, rows: RecordRows) -> ForceModel:
    """Return a model with what every test has of its own as a record shows it.

    An offset that differs from test to test is known of the tests that were fitted only. Here its
    coefficient is fitted to the record, and nothing else is: what is left then is the law's alone.

    Parameters
    ----------
    model : ForceModel
        Some of its terms may hold in one test each.
    rows : RecordRows
        Of a record that was not fitted.

    Returns
    -------
    ForceModel
        The model itself where no term holds in one test only, and where its force is not finite.
    """
    here = in_test(model, rows.motion.test)
    places = [i for i, t in enumerate(here.terms) if t.shape.get(ONLY.name, 0.0) > 0.0]
    if not places:
        return model
    forces = RecordForces(rows)

    def at(values: Array) -> ForceModel:
        terms = list(here.terms)
        for place, value in zip(places, values, strict=True):
            old = terms[place]
            terms[place] = FittedTerm(old.id, float(value), old.shape)
        return replace(here, terms=tuple(terms))

    def left(values: Array) -> Array:
        return rows.target - forces.of_model(at(values))

    start = np.array([here.terms[i].coefficient for i in places])
    if not np.all(np.isfinite(left(start))):  # a joint may shake itself apart
        return model
    return at(least_squares(left, start, x_scale="jac").x)
