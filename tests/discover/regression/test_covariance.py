"""Standard errors and intervals against exact covariances and against repeated experiments."""

import numpy as np
import pytest
from scipy.stats import t as student

from discover.regression.covariance import jacobian_of, uncertainty
from discover.regression.support import ProfiledFit, Support, fitted_terms
from discover.triangle import triangle_of
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 1.0, 3.0, 7.0)]
LINEAR = {"inertia": 300.0, "viscous-damping": 900.0, "coulomb-friction": 200.0}
FRACTIONAL = Support(("coulomb-friction",), free=("fractional-derivative",))


def linear(noise=0.02, seed=0):
    space = dictionary("inertia", "viscous-damping", "coulomb-friction", orders=None)
    tests = windows(space, LINEAR, PLAN, noise=noise, seed=seed)
    fits = ProfiledFit(triangle_of(tests), space)
    return tests, fits, fits.fit(Support(tuple(LINEAR)))


def test_a_linear_models_covariance_is_the_inverse_of_its_normal_matrix():
    tests, fits, fit = linear()
    rows = np.concatenate([w.whitened for w in tests])[:, :-1]
    expected = np.sqrt(np.diag(np.linalg.inv(rows.T @ rows)))
    found = uncertainty(fits, fit)
    np.testing.assert_allclose(found.std_errors, expected, rtol=1e-9)
    np.testing.assert_allclose(
        found.intervals, fit.coefficients[:, None] + 1.959963985 * np.outer(expected, [-1, 1]),
        rtol=1e-6,
    )  # fmt: skip
    wider = uncertainty(fits, fit, scale=4.0, freedom=5.0, level=0.9)
    np.testing.assert_allclose(wider.std_errors, 2.0 * expected, rtol=1e-9)
    np.testing.assert_allclose(
        np.ptp(wider.intervals, axis=1), 4.0 * student.ppf(0.95, 5.0) * expected, rtol=1e-9
    )


def test_clusters_widen_as_the_sandwich_and_never_narrow():
    tests, fits, fit = linear()
    rows = np.concatenate([w.whitened for w in tests])[:, :-1]
    inverse = np.linalg.inv(rows.T @ rows)
    plain = uncertainty(fits, fit).std_errors
    wide = uncertainty(fits, fit, meat=9.0 * rows.T @ rows).std_errors
    np.testing.assert_allclose(wide, 3.0 * np.sqrt(np.diag(inverse)), rtol=1e-8)
    np.testing.assert_allclose(
        uncertainty(fits, fit, meat=0.01 * rows.T @ rows).std_errors, plain, rtol=1e-8
    )


def test_the_jacobian_is_the_slope_of_the_fitted_force():
    space = dictionary("coulomb-friction", exponents=(0.4, 3.0))
    tests = windows(space, {("order", 1.5): 400.0, "coulomb-friction": 90.0}, PLAN)
    fits = ProfiledFit(triangle_of(tests), space)
    fit = fits.fit(FRACTIONAL)
    columns = fits.triangle.columns @ jacobian_of(fit, space)
    step = 1e-5

    def force(order):
        held = fits.at(FRACTIONAL, [order])
        return fits.triangle.columns @ held.weights @ fit.coefficients

    numeric = (force(fit.shapes[0] + step) - force(fit.shapes[0] - step)) / (2.0 * step)
    np.testing.assert_allclose(columns[:, -1], numeric, atol=1e-7 * np.abs(numeric).max())


def repeated(count):
    """Return truth, estimates and reported intervals of repeated experiments."""
    space = dictionary("coulomb-friction")
    truth = {("order", 1.53): 400.0, "coulomb-friction": 90.0}
    rows = []
    for seed in range(count):
        tests = windows(space, truth, PLAN, noise=0.05, seed=seed)
        fits = ProfiledFit(triangle_of(tests), space)
        fit = fits.fit(FRACTIONAL)
        found = uncertainty(fits, fit)
        term = fitted_terms(fit, space)[0]
        rows.append(
            (fit.shapes[0], *found.shape_intervals[0], found.shape_std_errors[0],
             term.coefficient, *found.intervals[0], found.std_errors[0])
        )  # fmt: skip
    return np.array(rows)


def test_intervals_cover_order_and_si_coefficient_as_often_as_they_say():
    found = repeated(250)
    order, low, high, order_error, product, product_low, product_high, product_error = found.T
    # 250 draws of 95 %: three standard deviations of the count are 0.041
    for cover in (
        np.mean((low < 1.53) & (high > 1.53)),
        np.mean((product_low < 400.0) & (product_high > 400.0)),
    ):
        assert 0.909 < cover <= 0.991
    assert np.median(order_error) == pytest.approx(order.std(), rel=0.15)
    assert np.median(product_error) == pytest.approx(product.std(), rel=0.15)
    assert order.mean() == pytest.approx(1.53, abs=4.0 * order.std() / np.sqrt(250))


def test_si_errors_do_not_depend_on_the_library_s_scaling():
    errors = []
    for reference in (1.0, 10.0, 40.0):
        space = dictionary("coulomb-friction", reference=reference)
        tests = windows(
            space, {("order", 1.53): 400.0, "coulomb-friction": 90.0}, PLAN, noise=0.05, seed=1
        )
        fits = ProfiledFit(triangle_of(tests), space)
        fit = fits.fit(FRACTIONAL)
        found = uncertainty(fits, fit)
        errors.append(
            (fitted_terms(fit, space)[0].coefficient, found.std_errors[0], *found.intervals[0],
             *found.shape_intervals[0])
        )  # fmt: skip
    np.testing.assert_allclose(errors[1:], [errors[0]] * 2, rtol=1e-3)


def test_a_profile_that_never_rises_ends_at_the_bounds():
    """At one frequency an order beside inertia and damping is no more than both of them."""
    space = dictionary("inertia", "viscous-damping", "stiffness", "force-offset")
    tests = windows(space, {"inertia": 300.0, "viscous-damping": 900.0}, [(0.01, 2.0)])
    fits = ProfiledFit(triangle_of(tests), space)
    support = Support(("inertia", "viscous-damping"), free=("fractional-derivative",))
    found = uncertainty(fits, fits.fit(support))
    np.testing.assert_allclose(found.shape_intervals[0], [0.0, 2.0])
