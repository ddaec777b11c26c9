"""The model error that the best structure leaves, against one that is put in."""

import numpy as np
import pytest

from discover.regression.support import Support
from discover.selection.discrepancy import neighbours, with_discrepancy
from discover.triangle import triangle_of
from tests.discover.spectra import dictionary, force_of, window

SPACE = dictionary("inertia", "viscous-damping", "coulomb-friction", orders=None)
SUPPORT = Support(("inertia", "viscous-damping", "coulomb-friction"))
TRUTH = {"inertia": 300.0, "viscous-damping": 1000.0, "coulomb-friction": 50.0}
PLAN = [(a, f) for f in np.geomspace(0.3, 5.0, 8) for a in (0.005, 0.01, 0.02)]
SPEEDS = np.array([2.0 * np.pi * a * f for a, f in PLAN])


def perturbed(error, *, seed=0, noise=0.002):
    """Return tests whose fundamental is off by independent errors of this size, relative."""
    rng = np.random.default_rng(seed)
    result = []
    for i, (a, f) in enumerate(PLAN):
        force = force_of(TRUTH, a, f)
        rows = window(SPACE, force, a, f, record=i, noise=noise, rng=rng)
        matrix = rows.matrix.copy()
        wrong = error * np.sqrt(rows.power) * rng.standard_normal(2)
        matrix[np.flatnonzero(rows.block == 1), -1] += wrong
        result.append(type(rows)(**{**vars(rows), "matrix": matrix}))
    return result


def test_a_known_error_of_the_fundamental_is_found_and_only_there():
    found = []
    for seed in range(12):
        tests = perturbed(0.03, seed=seed)
        weighed = with_discrepancy(tests, SPACE, SPEEDS, [SUPPORT])
        share = np.array([w.discrepancy / w.power for w in weighed])
        np.testing.assert_allclose(share, np.broadcast_to(share[0], share.shape), rtol=1e-9)
        found.append(np.sqrt(share[0]))
    level = np.mean(found, axis=0)
    # a low quantile over groups is taken, and raised for neighbours that err alike by chance
    assert 0.015 < level[1] < 0.045
    assert np.all(level[2:] < 0.2 * level[1])


def test_noise_alone_is_no_model_error():
    for seed in range(6):
        weighed = with_discrepancy(perturbed(0.0, seed=seed), SPACE, SPEEDS, [SUPPORT])
        share = np.array([w.discrepancy.sum() / w.noise_power for w in weighed])
        assert share.max() < 0.3


def test_it_scales_with_the_error():
    levels = [
        with_discrepancy(perturbed(e, seed=3, noise=1e-6), SPACE, SPEEDS, [SUPPORT])[0]
        for e in (0.01, 0.04)
    ]
    ratio = np.sqrt(levels[1].discrepancy[1] / levels[0].discrepancy[1])
    assert ratio == pytest.approx(4.0, rel=1e-3)


def test_with_it_the_misfit_is_what_chance_gives():
    tests = with_discrepancy(perturbed(0.03, seed=5), SPACE, SPEEDS, [SUPPORT])
    triangle = triangle_of(tests)
    fitted = np.linalg.lstsq(triangle.columns, triangle.target, rcond=None)[0]
    misfit = np.sum((triangle.target - triangle.columns @ fitted) ** 2)
    freedom = triangle.rows - 3
    assert 0.6 < misfit / freedom < 1.7


def test_neighbours_follow_one_another_and_leave_none_out():
    rng = np.random.default_rng(0)
    for size in (1, 3, 8, 24, 60):
        coordinate = rng.uniform(0.0, 1.0, size)
        groups = neighbours(coordinate)
        ranks = np.argsort(np.argsort(coordinate))
        assert all(np.all(np.diff(ranks[g]) == 1) for g in groups)
        assert len({g.size for g in groups}) == 1
        assert set(np.concatenate(groups)) <= set(range(size))
        assert 0 in np.concatenate([ranks[g] for g in groups])
