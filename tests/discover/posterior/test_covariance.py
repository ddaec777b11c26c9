"""Products and densities under the covariance that models share, against the whole matrix."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.posterior.covariance import Further, Sizes
from discover.posterior.metric import Comparison, curve_given
from discover.posterior.setup import space_of
from discover.posterior.space import departures, parts_of
from discover.records import Record
from discover.rows import record_rows
from models.constitutive import FittedTerm
from models.terms import TERMS
from tests.discover.posterior.small import APART, dense, flat, log_density, rows_of

SIZES = {
    "noise": Sizes(0.0, (0.0, 0.0), 0.0),
    "loud": Sizes(0.0, (0.03, 0.0), 0.0),
    "remainder": Sizes(0.1, (0.0, 0.0), 0.0),
    "own friction": Sizes(0.0, (0.0, 0.0), 8.0),
    "all": Sizes(0.05, (0.01, 0.002), 5.0),
}


def law(t, x, v, a):
    return 120.0 * a + 800.0 * v + 40.0 * np.tanh(v / 2e-3)


@pytest.fixture(scope="module")
def problem():
    space, curve = space_of(rows_of(law, APART, cycles=3), TERMS["coulomb-friction"])
    parts = parts_of(space, [(FittedTerm("inertia", 1.0),), (FittedTerm("viscous-damping", 1.0),)])
    return space, curve, np.concatenate([p.columns for p in parts])


@pytest.mark.parametrize("name", SIZES)
def test_density_of_the_measured_force(problem, name):
    space, _, _ = problem
    here = space.given(SIZES[name])
    force = here.gram([(np.array([here.force]), None)])[0, 0]
    expected = log_density(space.sheet.target.ravel(), dense(space, SIZES[name]))
    assert here.log_centre - 0.5 * force == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("name", SIZES)
def test_products_of_columns_that_are_there_in_part(problem, name):
    space, _, at = problem
    here = space.given(SIZES[name])
    share = np.array([0.0, 0.3, 1.0, 0.7])
    columns = np.concatenate([space.columns[:, at], space.sheet.target[:, None]], axis=1)
    some = np.concatenate([columns, share[:, None, None] * columns[:, :2]], axis=1)
    matrix = flat(some)
    expected = matrix.T @ np.linalg.solve(dense(space, SIZES[name]), matrix)
    found = here.gram([(np.r_[at, here.force], None), (at, share)])
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(found / scale, expected / scale, atol=1e-7)
    across, among = here.beside(here.kept(at, np.ones(2)), Further(columns))
    np.testing.assert_allclose(across / scale[:2, :3], expected[:2, :3] / scale[:2, :3], atol=1e-7)
    np.testing.assert_allclose(among / scale[:3, :3], expected[:3, :3] / scale[:3, :3], atol=1e-7)


def test_products_by_unit_add_up_to_those_of_all(problem):
    space, _, at = problem
    here = space.given(SIZES["all"])
    within, shared = here.by_unit(np.r_[at, here.force])
    share = np.array([0.2, 0.0, 1.0, 1.0])
    matrix = flat(
        share[:, None, None]
        * np.concatenate([space.columns[:, at], space.sheet.target[:, None]], axis=1)
    )
    expected = matrix.T @ np.linalg.solve(dense(space, SIZES["all"]), matrix)
    taken = np.einsum("u,usk->sk", share, shared)
    found = np.einsum("u,ukl->kl", share**2, within) - taken.T @ taken
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(found / scale, expected / scale, atol=1e-7)


def test_products_within_units_leave_what_units_share_of_the_remainder_aside(problem):
    space, _, at = problem
    sizes = SIZES["all"]
    columns = np.concatenate([space.columns[:, at], space.sheet.target[:, None]], axis=1)
    found = space.given(sizes).within(columns)
    own = Sizes(np.sqrt(0.1) * sizes.remainder, sizes.loud, sizes.friction)
    whole = dense(space, own)
    size = space.sheet.target.shape[1]
    for unit, products in enumerate(found):
        part = slice(unit * size, (unit + 1) * size)
        matrix = columns[unit].T
        # Of one unit alone the remainder's kernel is one.
        expected = matrix.T @ np.linalg.solve(whole[part, part], matrix)
        np.testing.assert_allclose(products, expected, rtol=1e-6, atol=1e-6 * expected.max())


def test_a_curve_that_is_marginalised_is_a_part_of_the_covariance(problem):
    space, curve, at = problem
    part = departures(curve, None)
    sizes = SIZES["all"]
    columns = np.concatenate([space.columns[:, at], space.sheet.target[:, None]], axis=1)
    bank = flat(space.columns[:, part.columns])
    found = Comparison(space, columns, part).at(sizes)
    np.testing.assert_array_equal(found.scales, part.scales)
    for k in (0, -1):
        whole = dense(space, sizes) + bank @ np.diag((found.scales[k] * part.spread) ** 2) @ bank.T
        matrix = flat(columns)
        expected = matrix.T @ np.linalg.solve(whole, matrix)
        scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        np.testing.assert_allclose(found.gram[k] / scale, expected / scale, atol=1e-6)
        density = log_density(space.sheet.target.ravel(), whole)
        assert found.log_normal[k] - 0.5 * found.gram[k, -1, -1] == pytest.approx(density, rel=1e-6)


def test_the_curve_s_coefficients_are_those_of_a_ridge(problem):
    space, curve, at = problem
    part, sizes = departures(curve, ()), SIZES["loud"]
    left, slopes = space.sheet.target, space.columns[:, at]
    mean, covariance, moved = curve_given(space, sizes, left, part, part.scales[0], slopes)
    bank = flat(space.columns[:, part.columns])
    weighted = np.linalg.solve(dense(space, sizes), bank)
    precision = bank.T @ weighted + np.diag((part.scales[0] * part.spread) ** -2)
    expected = np.linalg.inv(precision)
    scale = part.scales[0] * part.spread.max()
    np.testing.assert_allclose(covariance / scale**2, expected / scale**2, atol=1e-7)
    wanted = np.linalg.solve(precision, weighted.T @ left.ravel())
    np.testing.assert_allclose(mean / scale, wanted / scale, atol=1e-5)
    size = space.scale(at) / scale
    wanted = -np.linalg.solve(precision, weighted.T @ flat(slopes))
    np.testing.assert_allclose(moved * size, wanted * size, atol=1e-5)


def windows(seed=0):
    """Return a record of random motion, longer than a unit's rows may be."""
    rng = np.random.default_rng(seed)
    time = np.arange(12000) / 200.0
    tones = 2.0 * np.pi * rng.uniform(0.3, 8.0, 60)
    turned = np.outer(time, tones) + rng.uniform(0.0, 6.0, 60)
    size = 1e-3 * np.minimum(1.0, 3.0 / tones)
    x, v, a = np.sin(turned) @ size, np.cos(turned) @ (size * tones), -np.sin(turned) @ (
        size * tones**2
    )
    force = 120.0 * a + 800.0 * v
    force = force + 0.01 * np.std(force) * rng.standard_normal(time.size)
    return record_rows(observe(Record("random.csv", time, force, x)))


def test_rows_that_are_left_out_of_long_records_tell_nothing():
    rows = windows()
    space, curve = space_of([rows], TERMS["coulomb-friction"])
    assert any(u.basis is not None for u in space.sheet.units)
    kinds = space.sheet.loudness.shape[1]
    here = space.given(Sizes(0.0, (0.0,) * kinds, 0.0))
    found = here.gram([(np.r_[curve.columns[:1], here.force], None)])
    whole = np.stack([rows.of_motion(np.sign(rows.motion.velocity)), rows.target])
    np.testing.assert_allclose(found, whole @ whole.T, rtol=2e-2)
    assert here.log_centre - 0.5 * found[1, 1] == pytest.approx(
        -0.5 * float(rows.target @ rows.target), rel=1e-3
    )
