"""What records cover, and a shape's parameters moved within it."""

from dataclasses import replace

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.rows import record_rows
from discover.rows.columns import finite_slope, moved, scales_of
from models.constitutive import FittedTerm
from tests.discover.gap_data import device, record

PLAN = {(0.5, 0.012): 8, (2.0, 0.003): 20}


@pytest.fixture(scope="module")
def observations():
    rng = np.random.default_rng(0)
    return [
        observe(record(f, a, device, rng, noise=1e-4, cycles=cycles))
        for (f, a), cycles in PLAN.items()
    ]


def numbered(observations, *tests):
    return [record_rows(replace(o, test=n)) for o, n in zip(observations, tests, strict=True)]


def test_each_is_the_greatest_or_the_least_of_the_records(observations):
    scales = scales_of(numbered(observations, 1, 2))
    (slow, wide), (fast, narrow) = PLAN
    speeds = sorted(2.0 * np.pi * f * a for f, a in PLAN)
    assert (scales.displacement, scales.least_displacement) == pytest.approx(
        (wide, narrow), rel=0.01
    )
    assert (scales.least_speed, scales.speed) == pytest.approx(speeds, rel=0.01)
    assert (scales.least_omega, scales.omega) == pytest.approx(
        (2.0 * np.pi * slow, 2.0 * np.pi * fast), rel=1e-3
    )
    forces = sorted(
        s * np.hypot(120.0 * 2.0 * np.pi * f, 800.0)
        for s, (f, _) in zip((2.0 * np.pi * f * a for f, a in PLAN), PLAN, strict=True)
    )
    assert scales.peaks == pytest.approx(forces, rel=0.01)
    assert scales.force == scales.peaks[-1]
    assert scales.duration == pytest.approx(8 / slow, rel=0.02)


def test_tests_are_known_where_all_are(observations):
    assert scales_of(numbered(observations, 3, 5)).tests == (3, 5)
    assert scales_of(numbered(observations, 3, 0)).tests == ()


def test_sampling_is_told_where_it_differs(observations):
    # Both have 250 samples a cycle.
    assert scales_of(numbered(observations, 1, 2)).sampling == pytest.approx(500.0, rel=1e-6)
    assert scales_of(numbered(observations, 1, 2)[:1]).sampling == 0.0


@pytest.mark.parametrize(
    ("name", "shape"),
    [("coulomb-friction", {"transition_speed": 2e-3}), ("sensor-gain", {"load_power": 1.0})],
)
def test_a_shape_moves_a_little_inside_its_bounds(observations, name, shape):
    scales = scales_of(numbered(observations, 1, 2))
    term = FittedTerm(name, 1.0, shape).term
    (parameter,) = (p for p in term.parameters if p.name in shape)
    size = scales.size(parameter.scaled_by)
    for share in (0.0, 0.3, 1.0):
        low, high = parameter.lower * size, parameter.upper * size
        value = low + share * (high - low)
        other, step = moved(term, {parameter.name: value, "also": 1.0}, parameter.name, scales)
        assert other["also"] == 1.0
        assert other[parameter.name] - value == pytest.approx(step, rel=1e-6)
        assert low <= other[parameter.name] <= high
        assert 0.0 < abs(step) < 0.01 * (high - low)


def test_a_slope_without_a_square_is_none():
    given = np.array([1.0, -1e99, 1e101, -1e200, np.inf, np.nan])
    np.testing.assert_array_equal(finite_slope(given), [1.0, -1e99, 0.0, 0.0, 0.0, 0.0])
