"""Intervals of coefficients hold what they claim to, where only noise is left and where more is."""

import numpy as np
import pytest

from discover.gap.standard_error import standard_errors
from discover.motion_fit import observe, observe_all
from discover.naming.fit import fit_model, free_parameters
from discover.naming.rows import record_rows
from discover.records import Record
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device, record

MODEL = ForceModel((
    FittedTerm("inertia", 100.0),
    FittedTerm("viscous-damping", 700.0),
    FittedTerm("coulomb-friction", 20.0, {"transition_speed": 1e-3}),
))
TRUE = (120.0, 800.0)


def errors_over_claimed(seed, spread):
    """Return the coefficients' errors over the standard errors, friction differing by test."""
    rng = np.random.default_rng(500 + seed)

    def law(t, x, v, a):
        friction = 30.0 * (1.0 + spread * rng.standard_normal())
        return device(t, x, v, a) + friction * np.tanh(v / 1e-3)

    rows = [record_rows(o) for o in observe_all(campaign(law, seed=seed).records, 1)]
    fit = fit_model(rows, MODEL, free_parameters(MODEL))
    claimed = standard_errors(rows, fit)
    found = [t.coefficient for t in fit.model.terms]
    return [(found[k] - true) / claimed[k] for k, true in enumerate(TRUE)]


@pytest.mark.parametrize("spread", [0.0, 0.3])
def test_intervals_hold_the_truth_as_often_as_they_say(spread):
    """95 % of intervals: with friction of another size in every test a quarter of them had."""
    seeds = range(20)
    over = np.array([errors_over_claimed(seed, spread) for seed in seeds])
    held = np.mean(np.abs(over) < 1.96, axis=0)
    assert np.all(held >= 0.75)  # 15 of 20: fewer come once in 3,000 such sets of 95 %
    assert np.all(np.median(np.abs(over), axis=0) > 0.1)  # nor are they wide for nothing


def one_long_record(seed):
    """Return the rows of a minute of random motion, in which friction wanders."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 60.0, 0.004)
    omega = 2.0 * np.pi * rng.uniform(0.3, 4.0, 40)
    phase = np.outer(time, omega) + rng.uniform(0.0, 2.0 * np.pi, 40)
    x = 1e-3 * np.sum(np.sin(phase), axis=1)
    v, a = 1e-3 * np.cos(phase) @ omega, -1e-3 * np.sin(phase) @ omega**2
    wanders = np.interp(time, np.arange(0.0, 66.0, 6.0), 1.0 + 0.4 * rng.standard_normal(11))
    force = device(time, x, v, a) + 30.0 * wanders * np.tanh(v / 1e-3)
    force += 0.3 * rng.standard_normal(time.size)
    return [record_rows(observe(Record("long.csv", time, force, x)))]


def test_a_long_record_is_judged_by_its_windows():
    """One record can't be left out; as many intervals as they say hold the viscous damping."""
    held, alike = [], []
    for seed in range(20):
        rows = one_long_record(seed)
        fit = fit_model(rows, MODEL, free_parameters(MODEL))
        error = abs(fit.model.terms[1].coefficient - 800.0)
        held.append(error < 1.96 * standard_errors(rows, fit)[1])
        alike.append(error < 1.96 * np.sqrt(fit.covariance[1, 1]))
    assert sum(held) >= 15
    assert sum(alike) < 15  # as lines that each err anew


def test_what_one_record_alone_tells_keeps_an_interval():
    """Without it nothing is known: the step to nowhere was taken for the error, of 1e7 times."""
    rng = np.random.default_rng(9)
    plan = [(0.5, 0.004), (1.0, 0.008), (2.0, 0.008), (4.0, 0.004), (1.0, 0.014)]

    def law(t, x, v, a):
        friction = 30.0 * (1.0 + 0.3 * rng.standard_normal())
        stop = 2e6 * np.sign(x) * np.maximum(np.abs(x) - 0.0125, 0.0)
        return device(t, x, v, a) + friction * np.tanh(v / 1e-3) + stop

    rows = [record_rows(observe(record(f, a, law, rng))) for f, a in plan]
    stop = FittedTerm("end-stop", 1e6, {"gap": 0.0123, "exponent": 1.2})
    model = ForceModel((*MODEL.terms, stop))
    fit = fit_model(rows, model, free_parameters(model))
    found, claimed = fit.model.terms[3].coefficient, standard_errors(rows, fit)[3]
    assert 0.01 * found < claimed < 3.0 * found
    assert abs(found - 2e6) < 3.0 * claimed
