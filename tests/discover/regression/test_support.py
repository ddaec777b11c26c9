"""Fits with continuous shapes against general optimisers on the whole problem."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import differential_evolution, least_squares, minimize

from discover.library.dictionary import friction_column
from discover.regression.support import ProfiledFit, Support, fitted_terms, solve
from discover.triangle import Triangle, triangle_of
from models.checks import InputError
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 1.0, 3.0, 7.0)]


def engine(space, terms, **options):
    return ProfiledFit(triangle_of(windows(space, terms, PLAN, **options)), space)


def residual_of(space, tests, columns):
    """Return the whitened residual of explicit columns, written without the triangle."""
    rows = np.concatenate([w.whitened for w in tests])
    spectra = [columns(a, f) for a, f in PLAN]
    stacked = np.concatenate(
        [np.concatenate((s.real, s.imag)) / np.sqrt(np.concatenate((w.variance, w.variance)))
         for s, w in zip(spectra, tests, strict=True)]
    )
    return rows[:, -1] - stacked


def lines_of_order(amplitude, frequency, order):
    """Return the lines of D^order A sin: one phasor, by the harmonic rule."""
    lines = np.zeros(8, dtype=complex)
    omega = 2.0 * np.pi * frequency
    lines[1] = -1j * amplitude * (1j * omega) ** order / np.sqrt(2.0)
    return lines


@pytest.mark.parametrize("order", [0.48, 1.3, 1.89])
def test_one_order_is_the_optimum_that_scipy_finds(order):
    space = dictionary("inertia", "viscous-damping", "stiffness")
    tests = windows(space, {("order", order): 500.0, "stiffness": 1e4}, PLAN, noise=0.03, seed=4)
    fit = ProfiledFit(triangle_of(tests), space).fit(
        Support(("stiffness",), free=("fractional-derivative",))
    )

    def residual(p):
        return residual_of(
            space, tests,
            lambda a, f: 500.0 * p[0] * lines_of_order(a, f, p[1])
            + 1e4 * p[2] * lines_of_order(a, f, 0.0),
        )  # fmt: skip

    best = least_squares(residual, [1.0, order, 1.0], xtol=1e-14, ftol=1e-14, gtol=1e-14)
    (fractional, stiffness) = fitted_terms(fit, space)
    assert fit.chi2 == pytest.approx(2.0 * best.cost, rel=1e-8)
    assert fit.shapes[0] == pytest.approx(best.x[1], abs=2e-5)
    assert fractional.shape["order"] == fit.shapes[0]
    assert fractional.coefficient == pytest.approx(500.0 * best.x[0], rel=1e-4)
    assert stiffness.coefficient == pytest.approx(1e4 * best.x[2], rel=1e-4)


def test_noise_free_shapes_are_recovered():
    space = dictionary("inertia", exponents=(0.4, 3.0))
    tests = windows(space, {("order", 1.62): 300.0, ("power", 1.75): 800.0}, PLAN, noise=0.0)
    fit = ProfiledFit(triangle_of(tests), space).fit(
        Support((), free=("fractional-derivative", "power-law-damping"))
    )
    assert fit.shapes == pytest.approx((1.62, 1.75), abs=1e-3)
    fractional, power = fitted_terms(fit, space)
    assert fractional.coefficient == pytest.approx(300.0, rel=5e-3)
    assert power.coefficient == pytest.approx(800.0, rel=5e-3)


def test_two_shapes_reach_the_global_optimum():
    space = dictionary("inertia", exponents=(0.4, 3.0))
    tests = windows(
        space, {("order", 1.62): 300.0, ("power", 1.75): 3000.0}, PLAN, noise=0.01, seed=2
    )
    fits = ProfiledFit(triangle_of(tests), space)
    support = Support((), free=("fractional-derivative", "power-law-damping"))
    fit = fits.fit(support)
    found = differential_evolution(
        lambda p: fits.at(support, p).chi2, [(0.0, 2.0), (0.4, 3.0)], seed=1, popsize=8, maxiter=40
    )
    assert fit.chi2 <= found.fun * (1.0 + 1e-6)


def test_a_shape_given_is_the_fit_with_that_shape_held():
    space = dictionary("inertia", "coulomb-friction", exponents=(0.4, 3.0))
    fits = engine(space, {"inertia": 300.0, ("power", 1.6): 2e3, "coulomb-friction": 90.0})
    held = fits.fit(Support(("inertia",), fixed=(("power-law-damping", 1.75),)))
    free = fits.at(Support(("inertia",), free=("power-law-damping",)), [1.75])
    assert held.chi2 == pytest.approx(free.chi2, rel=1e-12)
    np.testing.assert_allclose(held.coefficients, free.coefficients, rtol=1e-12)


def test_profile_is_the_misfit_of_linear_fits():
    space = dictionary("stiffness", "coulomb-friction")
    fits = engine(space, {("order", 1.5): 400.0, "coulomb-friction": 90.0}, noise=0.05)
    base = fits.triangle.columns[:, [1]]
    values, misfit = fits.profile("fractional-derivative", base)
    for value, found in list(zip(values, misfit, strict=True))[::10]:
        held = fits.at(Support(("coulomb-friction",), free=("fractional-derivative",)), [value])
        assert found == pytest.approx(held.chi2, rel=1e-9)


def test_coefficients_of_the_wrong_sign_are_no_valid_fit():
    space = dictionary("inertia", "viscous-damping", "force-offset", orders=None)
    fits = engine(space, {"inertia": 300.0, "viscous-damping": -50.0, "force-offset": -20.0})
    assert not fits.fit(Support(("inertia", "viscous-damping"))).valid
    assert fits.fit(Support(("inertia", "force-offset"))).valid


def test_an_order_on_a_term_that_is_there_is_no_distinct_model():
    space = dictionary("inertia", "viscous-damping")
    fits = engine(space, {"inertia": 300.0, "viscous-damping": 900.0})
    support = Support(("viscous-damping",), free=("fractional-derivative",))
    assert not fits.at(support, [1.02]).valid
    assert fits.at(support, [2.0]).valid


def test_curve_of_reversal_is_marginalised_as_a_normal_prior():
    """Against the dense Gaussian marginal: covariance sigma^2 I + s^2 Z Z'."""
    rng = np.random.default_rng(3)
    space = dictionary("inertia", "coulomb-friction", orders=None)
    wide = replace(
        space, reversal=(friction_column(0.1), friction_column(0.2)), reversal_scale=1.7
    )
    x, z = rng.standard_normal((40, 2)), rng.standard_normal((40, 2))
    y = x @ [3.0, 1.0] + z @ [1.0, -2.0] + rng.standard_normal(40)
    triangle = Triangle(np.column_stack((x, z, y)), 40, 0.0)
    fit = ProfiledFit(triangle, wide).fit(Support(("inertia", "coulomb-friction")))
    weight = np.linalg.inv(np.eye(40) + 1.7**2 * z @ z.T)
    expected = np.linalg.solve(x.T @ weight @ x, x.T @ weight @ y)
    left = y - x @ expected
    np.testing.assert_allclose(fit.coefficients, expected, rtol=1e-10)
    assert fit.chi2 == pytest.approx(left @ weight @ left, rel=1e-10)


def test_solve_is_least_squares_whatever_the_units():
    rng = np.random.default_rng(5)
    x, y = rng.standard_normal((30, 4)), rng.standard_normal(30)
    found, misfit = solve(x * [1e-9, 1.0, 1e6, 1e9], y)
    expected = minimize(lambda c: np.sum((y - x @ c) ** 2), np.zeros(4), tol=1e-14)
    np.testing.assert_allclose(found * [1e-9, 1.0, 1e6, 1e9], expected.x, atol=1e-5)
    assert misfit == pytest.approx(expected.fun, rel=1e-10)


def test_the_empty_support_leaves_all_of_the_force():
    space = dictionary("inertia", orders=None)
    fits = engine(space, {"inertia": 300.0})
    assert fits.fit(Support(())).chi2 == pytest.approx(fits.triangle.target @ fits.triangle.target)


def test_what_the_dictionary_lacks_is_refused():
    space = dictionary("inertia", orders=None)
    fits = engine(space, {"inertia": 300.0})
    with pytest.raises(InputError, match="in the library"):
        fits.fit(Support((), free=("fractional-derivative",)))
    with pytest.raises(InputError, match="at most two"):
        fits.fit(Support((), free=("fractional-derivative", "power-law-damping", "hysteresis")))
