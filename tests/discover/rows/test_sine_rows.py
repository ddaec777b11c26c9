"""Rows of sine tests: the projection of forces at the samples, white where only noise is left."""

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.motion_fit import observe
from discover.records import Record
from discover.rows import force_at_samples, force_rows, record_rows
from discover.rows.columns import force_columns
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import record

FREQUENCY, AMPLITUDE = 1.3, 0.01
LAWS = {
    "inertia": (120.0, {}, lambda t, x, v, a: a),
    "viscous-damping": (800.0, {}, lambda t, x, v, a: v),
    "cubic-stiffness": (4e7, {}, lambda t, x, v, a: x**3),
    "coulomb-friction": (
        40.0, {"transition_speed": 2e-3}, lambda t, x, v, a: np.tanh(v / 2e-3),
    ),
    "thermal-drift": (
        -100.0, {"warming_time": 2.0}, lambda t, x, v, a: -np.expm1(-t / 2.0) * v,
    ),
    "sensor-drift": (
        30.0, {"settling_time": 1.5}, lambda t, x, v, a: -np.expm1(-t / 1.5),
    ),
}  # fmt: skip


def exact(t, x, v, a):
    return 120.0 * a + 800.0 * v


def observed(law, *, noise=0.01, seed=0, cycles=8):
    rng = np.random.default_rng(seed)
    return observe(record(FREQUENCY, AMPLITUDE, law, rng, noise=noise, cycles=cycles))


def true_motion(time):
    omega = 2.0 * np.pi * FREQUENCY
    x = AMPLITUDE * np.sin(omega * time)
    return time, x, AMPLITUDE * omega * np.cos(omega * time), -(omega**2) * x


@pytest.mark.parametrize("name", LAWS)
def test_a_term_s_rows_are_the_projection_of_its_force_at_the_samples(name):
    coefficient, shape, law = LAWS[name]
    rows = record_rows(observed(exact))
    force = coefficient * law(*true_motion(rows.motion.time))
    model = ForceModel((FittedTerm(name, coefficient, shape),))
    wanted = rows.of_motion(force)
    found = force_rows(rows, model)
    assert np.linalg.norm(found - wanted) < 2e-3 * np.linalg.norm(wanted)
    np.testing.assert_allclose(force_columns(rows, model.terms).sum(axis=0), found, atol=1e-9)
    at = force_at_samples(rows.observation, model)
    np.testing.assert_allclose(at, force, atol=5e-3 * np.abs(force).max())


def test_rows_of_the_measured_force_are_those_of_the_samples():
    rows = record_rows(observed(exact))
    np.testing.assert_allclose(rows.target, rows.of_motion(rows.observation.measured), rtol=1e-9)


def test_a_harmonic_shows_in_its_own_two_rows_by_its_length_over_the_noise():
    sigma = 0.5
    rng = np.random.default_rng(3)
    plain = record(FREQUENCY, AMPLITUDE, exact, rng, noise=0.0, cycles=20)
    noisy = Record(
        "a.csv", plain.time, plain.force + sigma * rng.standard_normal(plain.time.size),
        plain.displacement, frequency=FREQUENCY, amplitude=AMPLITUDE,
    )  # fmt: skip
    rows = record_rows(observe(noisy))
    size, harmonic = 3.0, 4
    force = size * np.cos(2.0 * np.pi * harmonic * FREQUENCY * rows.observation.time + 0.4)
    found = rows.of_motion(_on_rows(rows, force))
    own = found[2 * harmonic - 1 : 2 * harmonic + 1]
    expected = size * np.sqrt(rows.observation.time.size / 2.0) / sigma
    assert np.linalg.norm(own) == pytest.approx(expected, rel=0.1)
    assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(own), rel=1e-3)


def _on_rows(rows, force):
    """Return a force at the samples at the rows' moments, which may be means over a few."""
    if rows.motion.time.size == force.size:
        return force
    return np.interp(rows.motion.time, rows.observation.time, force)


@pytest.mark.parametrize("memory", [0.0, 0.9], ids=["white", "drifting"])
def test_what_noise_leaves_is_white(memory):
    """First-order noise, whose spectrum falls by 360 from end to end where it remembers 0.9."""
    squares, rows = [], None
    for seed in range(16):
        rng = np.random.default_rng(seed)
        plain = record(FREQUENCY, AMPLITUDE, exact, rng, noise=0.0, cycles=12)
        noise = lfilter([1.0], [1.0, -memory], rng.standard_normal(plain.time.size + 500))[500:]
        level = 0.02 * np.std(plain.force) / np.std(noise)
        noisy = Record(
            "a.csv", plain.time, plain.force + level * noise, plain.displacement,
            frequency=FREQUENCY, amplitude=AMPLITUDE,
        )  # fmt: skip
        rows = record_rows(observe(noisy))
        left = rows.target - rows.of_motion(_on_rows(rows, exact(*true_motion(plain.time))))
        squares.append(left**2)
    mean = np.mean(squares, axis=0)
    harmonics = mean[1:].copy()[: 2 * (rows.observation.windows[0].omega.size - 1)]
    degrees = 16 * harmonics.size
    assert 16 * np.sum(harmonics) == pytest.approx(degrees, rel=0.15)
    low, high = harmonics[: harmonics.size // 4], harmonics[-harmonics.size // 4 :]
    assert np.mean(low) == pytest.approx(1.0, abs=0.3)
    assert np.mean(high) == pytest.approx(1.0, abs=0.3)
    # The mean and slow changes are known from little: they may be held for more than they are.
    others = np.r_[mean[:1], mean[1 + harmonics.size :]]
    assert 0.1 < np.mean(others) < 1.3


def test_a_long_record_s_cells_stand_for_its_samples():
    """Samples near in phase and time are averaged; what each row says stays."""
    sparse, dense = (
        record_rows(observed_at(rate)) for rate in (250.0, 4000.0)
    )
    assert dense.motion.time.size < dense.observation.time.size
    for name in ("inertia", "coulomb-friction", "thermal-drift"):
        coefficient, shape, _ = LAWS[name]
        model = ForceModel((FittedTerm(name, coefficient, shape),))
        ratio = np.linalg.norm(force_rows(dense, model)) / np.linalg.norm(dense.target)
        other = np.linalg.norm(force_rows(sparse, model)) / np.linalg.norm(sparse.target)
        assert ratio == pytest.approx(other, rel=0.02)


def observed_at(rate):
    rng = np.random.default_rng(1)
    time = np.arange(int(8 * rate / FREQUENCY)) / rate
    motion = true_motion(time)
    force = exact(*motion)
    force = force + 0.01 * np.std(force) * rng.standard_normal(time.size)
    return observe(Record("a.csv", time, force, motion[1], frequency=FREQUENCY))


def test_a_coarser_cycle_weighs_the_same_model():
    rows = record_rows(observed(exact))
    for name, (coefficient, shape, _) in LAWS.items():
        model = ForceModel((FittedTerm(name, coefficient, shape),))
        fine, coarse = force_rows(rows, model), force_rows(rows.coarse, model)
        assert np.linalg.norm(fine - coarse) < 0.01 * np.linalg.norm(fine), name
    assert 4 * rows.coarse.cycle.displacement.size == rows.cycle.displacement.size


@pytest.mark.parametrize("frequency", [1.0, 2.0, 2.5, 4.0])
def test_cells_of_a_test_whose_cycle_is_whole_samples_have_the_motion_of_their_times(frequency):
    """Mean times of cells then lie on the sampling's grid, in no order."""
    time = np.arange(6000) / 500.0
    omega = 2.0 * np.pi * frequency
    x = np.array([float(f"{8e-3 * s:.9g}") for s in np.sin(omega * time)])  # as text holds it
    force = -370.0 * omega**2 * x + 4000.0 * 8e-3 * omega * np.cos(omega * time)
    noise = 3.0 * np.random.default_rng(0).standard_normal(time.size)
    rows = record_rows(observe(Record("a.csv", time, force + noise, x)))
    assert rows.motion.time.size < time.size
    expected = 8e-3 * np.sin(omega * rows.motion.time)
    np.testing.assert_allclose(rows.motion.displacement, expected, atol=1e-6)


def known_to(frequency, rate, harmonic):
    """Return a harmonic's size in its two rows over the fundamental's: what is known of both."""
    time = np.arange(int(12 * rate / frequency)) / rate
    omega = 2.0 * np.pi * frequency
    x = AMPLITUDE * np.sin(omega * time)
    force = 800.0 * AMPLITUDE * omega * np.cos(omega * time)
    force = force + 0.02 * np.std(force) * np.random.default_rng(5).standard_normal(time.size)
    rows = record_rows(observe(Record("a.csv", time, force, x, frequency=frequency)))
    pair = rows.size[2 * harmonic - 1 : 2 * harmonic + 1]
    assert pair[0] == pytest.approx(pair[1], rel=1e-6)
    return pair[0] / rows.size[1]


@pytest.mark.parametrize(
    ("frequency", "rate", "harmonic", "hums"),
    [
        (10.0, 1000.0, 5, True),  # 50 Hz
        (10.0, 1000.0, 6, True),  # 60 Hz
        (10.0, 1000.0, 4, False),
        (10.0, 1000.0, 7, False),
        (10.0, 130.0, 3, True),  # 100 Hz sampled at 130 Hz looks like 30 Hz
        (10.0, 130.0, 4, False),
        (9.3, 1000.0, 5, False),
        (50.0, 5000.0, 1, False),  # a test at the mains' own frequency
        (25.0, 2500.0, 2, False),
        (25.0, 2500.0, 4, True),
    ],
)
def test_a_harmonic_on_a_multiple_of_the_mains_says_little(frequency, rate, harmonic, hums):
    ratio = known_to(frequency, rate, harmonic)
    assert ratio < 0.1 if hums else 0.5 < ratio < 2.0


def test_what_no_term_has_is_as_large_as_the_force_and_falls_with_harmonics():
    rows = record_rows(observed(exact))
    squares = (rows.remainder / rows.size) ** 2
    assert np.sum(squares) == pytest.approx(1.0, rel=1e-9)
    mean, *harmonics = squares.sum(axis=0)[:13]
    sizes = np.array(harmonics).reshape(6, 2).sum(axis=1)
    np.testing.assert_allclose(sizes / sizes[0], np.arange(1.0, 7.0) ** -4, rtol=1e-9)
    assert not np.any(squares[:, 13:])
    # In the motion's phase: a spring's and a damper's first harmonics are one function each.
    for name in ("stiffness", "viscous-damping"):
        own = force_rows(rows, ForceModel((FittedTerm(name, 1.0),)))
        parts = np.abs(rows.remainder @ own) / np.linalg.norm(own)
        assert np.sort(parts)[-2] < 1e-3 * parts.max()
