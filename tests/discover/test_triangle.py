"""A triangle carries the least-squares problem of all its rows, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Record
from discover.triangle import Triangle, merge, reduce_rows, rows_of, triangle_of
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 1.0, 3.0, 7.0)]
TERMS = {"inertia": 300.0, "viscous-damping": 900.0, "coulomb-friction": 200.0}


def collinear(rows=20_000, seed=0):
    """Return neighbouring fractional orders of a random spectrum, and a force of one of them."""
    rng = np.random.default_rng(seed)
    omega = rng.uniform(1.0, 50.0, rows // 2)
    amplitude = rng.standard_normal(omega.size) / omega
    columns = np.array([amplitude * (1j * omega) ** q for q in (1.4, 1.5, 1.6, 1.9, 2.0)])
    force = columns[1] + 0.3 * columns[4]
    both = np.concatenate((columns, force[None]))
    matrix = np.concatenate((both.real, both.imag), axis=1).T
    matrix[:, -1] += 0.1 * rng.standard_normal(rows)
    return matrix


def least_squares(matrix):
    return np.linalg.lstsq(matrix[:, :-1], matrix[:, -1], rcond=None)[0]


def test_collinear_fractional_orders_are_solved_as_on_all_rows():
    matrix = collinear()
    small = reduce_rows(matrix)
    assert small.shape == (6, 6)
    full, reduced = least_squares(matrix), least_squares(small)
    norms = np.linalg.norm(matrix[:, :-1], axis=0)
    assert np.linalg.cond(matrix[:, :-1] / norms) > 100.0
    np.testing.assert_allclose(reduced, full, rtol=1e-12 * np.linalg.cond(matrix[:, :-1] / norms))
    fitted = matrix[:, :-1] @ full
    np.testing.assert_allclose(
        matrix[:, :-1] @ reduced, fitted, rtol=0.0, atol=1e-12 * np.abs(fitted).max()
    )
    misfit = np.sum((matrix[:, -1] - fitted) ** 2)
    assert np.sum((small[:, -1] - small[:, :-1] @ reduced) ** 2) == pytest.approx(misfit, rel=1e-12)


@pytest.mark.parametrize("subset", [(0,), (1, 4), (0, 1, 2), (4, 2)])
def test_every_subset_of_columns_has_the_misfit_of_all_rows(subset):
    matrix = collinear(4000, seed=1)
    small = reduce_rows(matrix)
    misfits = []
    for rows in (matrix, small):
        part = rows[:, [*subset, -1]]
        misfits.append(np.sum((part[:, -1] - part[:, :-1] @ least_squares(part)) ** 2))
    assert misfits[1] == pytest.approx(misfits[0], rel=1e-12)


def test_merging_is_associative_and_in_any_order():
    matrices = [collinear(200, seed=s) for s in range(4)]
    parts = [Triangle(reduce_rows(m), m.shape[0], float(s)) for s, m in enumerate(matrices)]
    ways = (
        merge(parts),
        merge((merge(parts[:2]), merge(parts[2:]))),
        merge((parts[3], merge((parts[1], merge((parts[0], parts[2])))))),
    )
    stacked = np.concatenate(matrices)
    gram = stacked.T @ stacked
    scale = np.sqrt(np.outer(np.diag(gram), np.diag(gram)))
    for way in ways:
        assert way.rows == 800
        assert way.log_determinant == 6.0
        np.testing.assert_allclose(way.matrix.T @ way.matrix / scale, gram / scale, atol=1e-13)


def test_whitening_is_generalised_least_squares():
    space = dictionary("inertia", "viscous-damping", "coulomb-friction", orders=None)
    tests = windows(space, TERMS, PLAN, noise=0.02)
    uneven = [
        replace(
            w,
            variance=w.variance * np.linspace(0.5, 4.0, w.count.size),
            discrepancy=0.1 * w.variance,
        )
        for w in tests
    ]
    triangle = triangle_of(uneven)
    rows = np.concatenate([w.matrix for w in uneven])
    variance = np.concatenate([(w.variance + w.discrepancy)[w.block] for w in uneven])
    inverse = np.diag(1.0 / variance)
    x, y = rows[:, :-1], rows[:, -1]
    expected = np.linalg.solve(x.T @ inverse @ x, x.T @ inverse @ y)
    np.testing.assert_allclose(least_squares(triangle.matrix), expected, rtol=1e-10)
    left = y - x @ expected
    found = triangle.target - triangle.columns @ expected
    assert found @ found == pytest.approx(left @ inverse @ left, rel=1e-10)


def test_rows_and_log_determinant_are_those_of_the_covariance():
    space = dictionary("inertia", orders=None)
    tests = windows(space, {"inertia": 1.0}, PLAN[:3], noise=0.02)
    triangle = triangle_of(tests)
    # the mean's row that stands for no imaginary part is no observation
    count = sum(2 * (w.count.size - 1) + 1 for w in tests)
    repeats = [1] + [2] * (tests[0].count.size - 1)
    covariance = np.concatenate([np.repeat(w.variance, repeats) for w in tests])
    assert triangle.rows == count == covariance.size
    assert triangle.log_determinant == pytest.approx(np.linalg.slogdet(np.diag(covariance))[1])


def test_a_records_columns_explain_its_force_exactly_in_lines():
    frequency, rate = 2.3, 800.0
    time = np.arange(3000) / rate
    theta = 2.0 * np.pi * frequency * time + 0.7
    omega = 2.0 * np.pi * frequency
    velocity = 0.01 * omega * np.cos(theta)
    force = 150.0 * velocity * np.abs(velocity) - 90.0 * 0.01 * omega**2 * np.sin(theta)
    space = dictionary("inertia", "viscous-damping", "quadratic-damping", orders=None)
    seen = observe(Record("a.csv", time, force, 0.01 * np.sin(theta), frequency=frequency))
    (rows,) = rows_of(seen, space, 0)
    found = least_squares(rows.matrix)
    np.testing.assert_allclose(found, [90.0, 0.0, 150.0], atol=1e-7)


def test_inputs_may_be_read_only():
    matrix = collinear(100)
    matrix.flags.writeable = False
    before = matrix.copy()
    merge((Triangle(matrix, 100, 0.0), Triangle(matrix, 100, 0.0)))
    np.testing.assert_array_equal(matrix, before)
