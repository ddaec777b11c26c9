"""Leave-one-record-out by a small solve against refits without the record."""

from dataclasses import replace

import numpy as np
import pytest

from discover.regression.support import ProfiledFit, Support
from discover.selection.materiality import relative_triangle
from discover.selection.prediction import Predictions, leave_out
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 1.0, 3.0)]
SPACE = dictionary("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction")
TERMS = {"inertia": 300.0, "viscous-damping": 1000.0, "coulomb-friction": 50.0}
SUPPORTS = (
    Support(("inertia", "viscous-damping", "coulomb-friction")),
    Support(("inertia",)),
    Support(("coulomb-friction",), free=("fractional-derivative",)),
)


def brute_force(tests, columns):
    """Return each record's relative misfit by a fit to the other records' rows."""
    scaled = [w.matrix / np.sqrt(w.power) for w in tests]
    errors = []
    for left in range(len(tests)):
        rest = np.concatenate([m for i, m in enumerate(scaled) if i != left])
        x = rest[:, :-1] @ columns
        found = np.linalg.lstsq(x, rest[:, -1], rcond=None)[0]
        errors.append(np.sum((scaled[left][:, -1] - scaled[left][:, :-1] @ columns @ found) ** 2))
    return errors


@pytest.mark.parametrize("noise", [1e-3, 0.1])
def test_left_out_errors_equal_those_of_refits(noise):
    tests = windows(SPACE, TERMS, PLAN, noise=noise)
    engine = ProfiledFit(relative_triangle(tests), SPACE)
    fits = [engine.fit(s) for s in SUPPORTS]
    found = leave_out(tests, fits)
    for errors, fit in zip(found.errors, fits, strict=True):
        np.testing.assert_allclose(errors, brute_force(tests, fit.weights), rtol=1e-6)


def test_windows_of_one_record_leave_together():
    tests = windows(SPACE, TERMS, PLAN, noise=0.1)
    halves = [replace(w, record=w.record // 2, share=0.5) for w in tests]
    engine = ProfiledFit(relative_triangle(halves), SPACE)
    fit = engine.fit(SUPPORTS[0])
    found = leave_out(halves, [fit])
    assert found.errors.shape == (1, 3)
    power = [0.5 * (tests[i].power + tests[i + 1].power) for i in (0, 2, 4)]
    scaled = [w.matrix * np.sqrt(0.5 / power[i // 2]) for i, w in enumerate(tests)]
    for record in range(3):
        rest = np.concatenate([m for i, m in enumerate(scaled) if i // 2 != record])
        out = np.concatenate([m for i, m in enumerate(scaled) if i // 2 == record])
        solved = np.linalg.lstsq(rest[:, :-1] @ fit.weights, rest[:, -1], rcond=None)[0]
        misfit = np.sum((out[:, -1] - out[:, :-1] @ fit.weights @ solved) ** 2)
        assert found.errors[0, record] == pytest.approx(misfit, rel=1e-6)


def test_noise_is_the_limit_of_the_truth_and_not_of_a_wrong_model():
    tests = windows(SPACE, TERMS, PLAN, noise=0.02)
    engine = ProfiledFit(relative_triangle(tests), SPACE)
    right, wrong = engine.fit(SUPPORTS[0]), engine.fit(SUPPORTS[1])
    assert leave_out(tests, [right]).noise_share > 0.6
    assert leave_out(tests, [wrong]).noise_share < 0.1


def test_the_smallest_of_equals_stands():
    rng = np.random.default_rng(0)
    base = rng.uniform(0.9, 1.1, 12)
    errors = np.array([base, base * (1.0 + 0.01 * rng.standard_normal(12)), 2.0 * base])
    found = Predictions(errors, np.zeros(12))
    assert found.parsimonious(np.array([5, 3, 1])) == 1
    assert found.parsimonious(np.array([3, 5, 1])) == 0


def test_fits_that_predict_alike_share_and_a_better_one_gains_with_the_records():
    rng = np.random.default_rng(1)
    for count, worse in ((4, 1.1), (4, 2.0), (16, 1.1)):
        # errors that differ by one factor in every record: redrawing them changes nothing, and
        # each record's two numbers, of unknown size, count as one power of the mean square
        base = np.full(count, 1e-4)
        found = Predictions(np.array([base, base * worse**2]), np.zeros(count))
        shares = found.shares(["a", "b"], rng)
        assert shares["b"] / shares["a"] == pytest.approx(worse ** (-2.0 * count))


def test_records_that_err_alike_count_for_less():
    errors = np.array([np.full(16, 1e-4), np.full(16, 1.5e-4)])
    found = Predictions(errors, np.zeros(16))
    alone = found.shares(["a", "b"], np.random.default_rng(0))
    alike = found.shares(["a", "b"], np.random.default_rng(0), witnesses=1.0 / 9.0)
    assert alone["a"] > 0.99
    assert 0.6 < alike["a"] < 0.75


def test_shares_follow_which_records_are_redrawn():
    # one fit is by far the best on each of three records out of four: Beta(3, 1) above one half
    errors = np.array([[1e-9, 1e-9, 1e-9, 1.0], [1.0, 1.0, 1.0, 1e-9]])
    shares = Predictions(errors, np.zeros(4)).shares(["a", "b"], np.random.default_rng(1))
    assert shares["a"] == pytest.approx(7.0 / 8.0, abs=0.1)
    assert sum(shares.values()) == pytest.approx(1.0)
