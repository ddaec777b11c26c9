"""A joint sought over all of its range. The model's own force: it is the search that is tested."""

import numpy as np
import pytest

from discover.naming.fit import fit_model, free_parameters, misfits
from discover.naming.scattered import scattered
from models.constitutive import FittedTerm, ForceModel
from tests.discover.naming.test_restart import DEVICE, PLAY, TORN, through

VALVE = {**TORN, "lag": 2e-3}


def begun(rows, identifier, shape):
    samples = [r.samples for r in rows]
    model = ForceModel((*DEVICE, FittedTerm(identifier, 1.0, shape)))
    return samples, fit_model(samples, model, free_parameters(model), iterations=6, exact=False)


def telling(samples, fit):
    return np.argsort(misfits(samples, fit))[::-1]


@pytest.fixture(scope="module")
def valve():
    return through(FittedTerm("cavitation", 1.0, VALVE))


@pytest.fixture(scope="module")
def play():
    return through(FittedTerm("backlash", 1.0, PLAY))


def test_a_valve_that_closes_late_is_found_from_one_that_does_not(valve):
    samples, stuck = begun(valve, "cavitation", {**VALVE, "lag": 0.0, "loss": 0.9})
    found = scattered(samples, stuck, telling(samples, stuck))
    assert found.chi2 < 0.3 * stuck.chi2
    shape = found.model.terms[-1].shape
    assert shape["lag"] == pytest.approx(VALVE["lag"], rel=0.25)
    assert shape["limit"] == pytest.approx(VALVE["limit"], rel=0.02)
    assert any(p.shape == "lag" for p in found.parameters)


def test_flanks_are_found_from_afar(play):
    samples, stuck = begun(play, "backlash", {**PLAY, "gap": 2.7e-4, "contact": 180.0})
    found = scattered(samples, stuck, telling(samples, stuck))
    assert found.chi2 < 0.1 * stuck.chi2
    assert found.model.terms[-1].shape["gap"] == pytest.approx(PLAY["gap"], rel=0.06)


def test_it_is_the_same_twice(valve):
    samples, stuck = begun(valve, "cavitation", {**VALVE, "lag": 0.0, "loss": 0.9})
    first, second = (scattered(samples, stuck, telling(samples, stuck)) for _ in range(2))
    assert first.chi2 == second.chi2
    assert first.model.terms == second.model.terms


@pytest.mark.parametrize("last", [
    FittedTerm("stiffness", 9e3), FittedTerm("cavitation", 1.0, {**TORN, "contact": 0.0}),
])
def test_what_has_no_impacts_is_kept(play, last):
    samples = [r.samples for r in play]
    model = ForceModel((*DEVICE, last))
    fit = fit_model(samples, model, ())
    assert fit.chi2 > 10.0 * fit.residual.size
    assert scattered(samples, fit, range(len(samples))) is fit


def test_a_fit_is_not_traded_for_a_worse_one(play):
    samples = [r.samples for r in play]
    model = ForceModel((*DEVICE, FittedTerm("backlash", 1.0, {**PLAY, "gap": 2.1e-4})))
    fit = fit_model(samples, model, ())
    assert scattered(samples, fit, range(len(samples))).chi2 <= fit.chi2 < np.inf
