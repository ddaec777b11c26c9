"""Exact search against brute force, high precision, non-negative least squares, scikit-learn."""

from itertools import combinations

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls
from scipy.signal import lfilter
from sklearn.linear_model import LinearRegression, OrthogonalMatchingPursuit
from sklearn.model_selection import LeaveOneGroupOut, cross_val_predict

from discover.regression import best_subsets
from discover.regression.best_subset import compress
from discover.regression.term_count import (
    by_criterion,
    by_leaving_out,
    effective_samples,
    leave_group_out,
)
from models.checks import InputError


def problem(seed, rows=60, count=9):
    rng = np.random.default_rng(seed)
    columns = rng.normal(size=(rows, count)) * np.geomspace(1e-3, 1e4, count)
    columns[:, 4] = 2.0 * columns[:, 3] + 1e-3 * columns[:, 4]  # nearly collinear
    force = columns[:, 1] * 3.0 + columns[:, 6] * 1e-2 + rng.normal(size=rows)
    return columns, force


def least_squares(columns, force, indices):
    chosen = columns[:, list(indices)]
    scale = np.linalg.norm(chosen, axis=0)
    coefficients = np.linalg.lstsq(chosen / scale, force, rcond=None)[0] / scale
    return coefficients, float(np.sum((force - chosen @ coefficients) ** 2))


def brute_force(columns, force, size, *, forced=(), nonnegative=(), exclusive=()):
    found = []
    for indices in combinations(range(columns.shape[1]), size):
        if not set(forced) <= set(indices):
            continue
        if any(len(set(group) & set(indices)) > 1 for group in exclusive):
            continue
        coefficients, misfit = least_squares(columns, force, indices)
        if any(c < 0.0 for i, c in zip(indices, coefficients, strict=True) if i in nonnegative):
            continue
        found.append((misfit, indices, coefficients))
    return sorted(found, key=lambda f: f[0])


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"forced": (8, 2)},
        {"nonnegative": (0, 3, 5, 7)},
        {"exclusive": ((0, 1, 2), (2, 6, 7))},
        {"forced": (1,), "nonnegative": tuple(range(9)), "exclusive": ((3, 4), (1, 5))},
    ],
)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_agrees_with_every_least_squares_fit_one_by_one(seed, options):
    columns, force = problem(seed)
    path = best_subsets(columns, force, max_terms=4, keep=6, **options)
    for size in range(1, 5):
        expected = brute_force(columns, force, size, **options)[:6]
        found = path.sizes[size]
        assert [s.indices for s in found] == [f[1] for f in expected]
        for subset, (misfit, _, coefficients) in zip(found, expected, strict=True):
            assert subset.misfit == pytest.approx(misfit, rel=1e-10)
            np.testing.assert_allclose(subset.coefficients, coefficients, rtol=1e-8)


def test_nearly_collinear_columns_keep_their_accuracy():
    """Neighbouring fractional orders of one sum of sines, judged at 50 digits."""
    t = np.linspace(0.0, 1.0, 24, endpoint=False)
    orders = 1.80 + 0.004 * np.arange(7)
    omega = 2.0 * np.pi * np.array([1.0, 2.0, 5.0])
    columns = np.array(
        [np.sum(omega**q * np.sin(np.outer(t, omega) + 0.5 * np.pi * q), axis=1) for q in orders]
    ).T
    assert np.linalg.cond(columns) > 1e11
    force = columns[:, 2] - 0.4 * columns[:, 5] + 1e-3 * np.cos(37.0 * t)
    path = best_subsets(columns, force, max_terms=3, keep=50)
    mpmath.mp.dps = 50
    exact = {}
    for size in (1, 2, 3):
        for indices in combinations(range(7), size):
            matrix = mpmath.matrix(columns[:, list(indices)].tolist())
            right = mpmath.matrix(force.tolist())
            fit = mpmath.lu_solve(matrix.T * matrix, matrix.T * right)
            rest = right - matrix * fit
            exact[indices] = float((rest.T * rest)[0])
        listed = [s for s in path.sizes[size] if s.indices in exact]
        assert len(listed) == sum(len(k) == size for k in exact)
        for subset in listed:
            assert subset.misfit == pytest.approx(exact[subset.indices], rel=1e-6)
        best = min((k for k in exact if len(k) == size), key=exact.__getitem__)
        assert path.best(size).indices == best


def test_a_clean_signal_is_found_below_round_off_of_the_misfit():
    rng = np.random.default_rng(5)
    columns = rng.normal(size=(80, 12))
    force = columns[:, [2, 5, 9]] @ [1.0, 1e-9, -3.0]  # the middle term is 1e-18 of the energy
    assert best_subsets(columns, force, max_terms=4).best(3).indices == (2, 5, 9)


@pytest.mark.parametrize("seed", range(4))
def test_sign_constraints_reach_the_nonnegative_least_squares_optimum(seed):
    rng = np.random.default_rng(seed)
    columns, force = rng.normal(size=(40, 8)), rng.normal(size=40)
    path = best_subsets(columns, force, max_terms=8, nonnegative=range(8))
    best = min(s[0].misfit for s in path.sizes if s)
    assert best == pytest.approx(nnls(columns, force)[1] ** 2, rel=1e-10)


def test_orthogonal_columns_enter_as_in_matching_pursuit():
    rng = np.random.default_rng(3)
    columns = np.linalg.qr(rng.normal(size=(50, 20)))[0]
    force = rng.normal(size=50)
    path = best_subsets(columns, force, max_terms=4)
    for size in range(1, 5):
        pursuit = OrthogonalMatchingPursuit(n_nonzero_coefs=size, fit_intercept=False)
        expected = pursuit.fit(columns, force).coef_
        assert path.best(size).indices == tuple(np.flatnonzero(expected))


@settings(max_examples=25, deadline=None)
@given(
    st.integers(0, 1000),
    st.lists(st.floats(1e-6, 1e6), min_size=6, max_size=6),
    st.floats(1e-6, 1e6),
)
def test_units_change_neither_subsets_nor_the_force_explained(seed, units, force_unit):
    rng = np.random.default_rng(seed)
    columns, force = rng.normal(size=(30, 6)), rng.normal(size=30)
    path = best_subsets(columns, force, max_terms=3, keep=1)
    scaled = best_subsets(columns * units, force * force_unit, max_terms=3, keep=1)
    for size in range(4):
        one, other = path.best(size), scaled.best(size)
        assert one.indices == other.indices
        back = other.coefficients * np.array(units)[list(other.indices)] / force_unit
        np.testing.assert_allclose(back, one.coefficients, rtol=1e-9)
        assert other.misfit == pytest.approx(one.misfit * force_unit**2, rel=1e-9)


def test_a_triangle_gives_what_its_rows_give():
    columns, force = problem(7, rows=20_000)
    triangle = compress(np.column_stack([columns, force]))
    assert triangle.shape == (10, 10)
    full = best_subsets(columns, force, max_terms=4)
    small = best_subsets(triangle[:, :-1], triangle[:, -1], max_terms=4)
    for size in range(5):
        assert full.best(size).indices == small.best(size).indices
        assert full.best(size).misfit == pytest.approx(small.best(size).misfit, rel=1e-10)
        np.testing.assert_allclose(
            full.best(size).coefficients, small.best(size).coefficients, rtol=1e-8
        )


def test_zero_and_repeated_columns_never_stand_beside_each_other():
    rng = np.random.default_rng(2)
    columns = rng.normal(size=(30, 5))
    columns[:, 1] = 0.0
    columns[:, 4] = -7.0 * columns[:, 2]
    path = best_subsets(columns, rng.normal(size=30), max_terms=5, keep=40)
    listed = [s.indices for subsets in path.sizes for s in subsets]
    assert not any(1 in indices or {2, 4} <= set(indices) for indices in listed)
    assert path.sizes[4] == () and path.best(5) is None
    assert {(0, 2, 3), (0, 3, 4)} <= set(listed)


def test_inputs_are_not_changed():
    columns, force = problem(0)
    before = columns.copy(), force.copy()
    columns.flags.writeable = force.flags.writeable = False
    best_subsets(columns, force, forced=[3])
    np.testing.assert_array_equal(columns, before[0])
    np.testing.assert_array_equal(force, before[1])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"max_terms": 0}, "max_terms must be a whole number >= 1, got 0"),
        ({"keep": 1.5}, "keep must be a whole number >= 1, got 1.5"),
        ({"forced": [9]}, "forced must be column indices from 0 to 8, got 9"),
        ({"nonnegative": [0.5]}, "nonnegative must be column indices"),
        ({"exclusive": [[0, -1]]}, "exclusive must be column indices from 0 to 8, got -1"),
        ({"forced": [0, 1], "max_terms": 1}, r"max_terms must be at least 2 \(forced\), got 1"),
        ({"forced": [0, 1], "exclusive": [[0, 1, 2]]}, "at most one column of an exclusive"),
        ({"exclusive": [[0, 1]] * 63}, "exclusive must be at most 62 groups, got 63"),
    ],
)
def test_options_that_make_no_sense_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        best_subsets(*problem(0), **options)


def test_data_that_make_no_sense_are_refused():
    columns, force = problem(0)
    with pytest.raises(InputError, match="target must be of length 60, got 59"):
        best_subsets(columns, force[:-1])
    with pytest.raises(InputError, match="columns must be finite throughout"):
        best_subsets(np.full((60, 2), np.nan), force)
    with pytest.raises(InputError, match="independent columns whose signs can be met"):
        best_subsets(columns, -columns[:, 0], forced=[0], nonnegative=[0], max_terms=1)
    with pytest.raises(InputError, match=r"small enough for 200 columns, got 2.6e\+09 subsets"):
        best_subsets(np.ones((3, 200)), np.ones(3), max_terms=5)


def groups_of(rows=60, groups=6):
    return np.arange(rows) % groups


def test_leaving_a_group_out_equals_fitting_without_it():
    columns, force = problem(4)
    labels = groups_of()
    subset = best_subsets(columns, force, max_terms=3).best(3)
    chosen = columns[:, list(subset.indices)]
    rows = np.column_stack([columns, force])
    left = leave_group_out([rows[labels == g] for g in range(6)], subset)
    predicted = cross_val_predict(
        LinearRegression(fit_intercept=False), chosen, force, groups=labels, cv=LeaveOneGroupOut()
    )
    for g in range(6):
        inside = labels == g
        own = np.sum((force - predicted)[inside] ** 2)
        assert left.prediction[g] == pytest.approx(own, rel=1e-9)
        misfit = least_squares(columns[~inside], force[~inside], subset.indices)[1]
        assert left.training[g] == pytest.approx(misfit, rel=1e-9)


def test_a_term_that_one_group_alone_shows_can_not_be_predicted():
    columns, force = problem(4)
    labels = groups_of()
    columns[labels != 2, 1] = 0.0
    subset = best_subsets(columns, force, max_terms=1, forced=[1]).best(1)
    rows = np.column_stack([columns, force])
    left = leave_group_out([rows[labels == g] for g in range(6)], subset)
    assert np.flatnonzero(np.isinf(left.prediction)).tolist() == [2]
    assert left.training[2] == pytest.approx(np.sum(force[labels != 2] ** 2))


def test_the_number_of_terms_is_the_true_one():
    """Three true terms of thirty, forty seeds.

    One standard error is exceeded by chance in at most 16 % of cases: 6 of 40. The criterion's
    charge for the search keeps it under 1 in 20, where the plain one errs more often.
    """
    sizes = {"leave-group-out": [], "ebic": [], "bic": []}
    for seed in range(40):
        rng = np.random.default_rng(seed)
        columns = rng.normal(size=(400, 30))
        force = columns[:, :3] @ [1.0, -0.7, 0.5] + rng.normal(size=400)
        path = best_subsets(columns, force, max_terms=5, keep=32)
        rows = np.column_stack([columns, force]).reshape(20, 20, 31)
        sizes["leave-group-out"].append(by_leaving_out(path, list(rows)).size)
        for rule in ("ebic", "bic"):
            sizes[rule].append(by_criterion(path, 30, samples=400.0, criterion=rule).size)
    right = {rule: sizes[rule].count(3) for rule in sizes}
    assert min(min(found) for found in sizes.values()) == 3
    assert right["leave-group-out"] >= 34
    assert right["ebic"] >= 38
    assert right["bic"] < right["ebic"]


def test_effective_samples_of_an_autoregression():
    """First order, r = 0.8: worth (1 - r) / (1 + r) of its samples."""
    noise = np.random.default_rng(8).normal(size=(10, 20_000))
    series = lfilter([1.0], [1.0, -0.8], noise, axis=1)
    worth = np.mean([effective_samples(row) for row in series])
    assert worth == pytest.approx(20_000 / 9.0, rel=0.05)
