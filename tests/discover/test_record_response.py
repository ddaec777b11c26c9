import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.record_curves import response
from discover.records import Record
from discover.rows import compared_with

MASS, DAMPING, NOISE, RATE = 60.0, 800.0, 3.0, 500.0
TIME = np.arange(10_000) / RATE


def answer(x, v, a, *, added=0.0, seed=0):
    """Response of the exact linear model to a record with white noise and `added` in its force."""
    exact = MASS * a + DAMPING * v
    noise = NOISE * np.random.default_rng(seed).standard_normal(TIME.size)
    record = Record("a.csv", TIME, exact + added + noise, x)
    (observed,) = observe_all([record], 1)
    modelled = observed.at_samples(
        MASS * observed.motion.acceleration + DAMPING * observed.motion.velocity
    )
    return response(compared_with(observed, modelled)), observed


def sine(frequency=2.0, amplitude=0.01):
    w = 2.0 * np.pi * frequency
    x, v = amplitude * np.cos(w * TIME), -amplitude * w * np.sin(w * TIME)
    return x, v, -(w**2) * x


def many_tones():
    rng = np.random.default_rng(5)
    x, v, a = np.zeros((3, TIME.size))
    for w, p in zip(2.0 * np.pi * rng.uniform(0.5, 6.0, 60), rng.uniform(0, 6.28, 60), strict=True):
        wave = 1e-3 * np.exp(1j * (w * TIME + p))
        x, v, a = x + wave.real, v + (1j * w * wave).real, a - (w**2 * wave).real
    return x, v, a


def exact_stiffness(frequency):
    w = 2.0 * np.pi * frequency
    return -MASS * w**2 + 1j * w * DAMPING


def test_a_sine_test_has_the_stiffness_of_its_model_at_its_frequency():
    found, _ = answer(*sine())
    assert found.stiffness_frequency == pytest.approx([2.0], rel=1e-4)
    assert found.stiffness == pytest.approx([exact_stiffness(2.0)], rel=1e-3)
    assert found.model_stiffness == pytest.approx([exact_stiffness(2.0)], rel=1e-3)


def test_what_is_left_of_an_exact_model_is_the_noise_that_was_added():
    found, _ = answer(*sine())
    assert found.error_over_noise == pytest.approx(1.0, abs=0.05)
    level = NOISE * np.sqrt(2.0 / RATE)  # one-sided density of white noise
    assert np.median(found.left) == pytest.approx(level, rel=0.1)
    assert np.median(found.noise) == pytest.approx(level, rel=0.1)
    assert found.outside_percent <= 15.0  # 6 of 40, where 2 are expected
    assert np.max(np.abs(found.over_phase)) < 5.0 * NOISE / np.sqrt(TIME.size / 48)


def test_a_force_that_only_one_direction_has_shows_in_its_half_of_the_cycle():
    x, v, a = sine()
    found, _ = answer(x, v, a, added=20.0 * (v > 0.0))
    going_down = (found.phase > 0.03) & (found.phase < 0.47)
    going_up = (found.phase > 0.53) & (found.phase < 0.97)
    assert found.over_phase[going_down] == pytest.approx(0.0, abs=1.5)
    assert found.over_phase[going_up] == pytest.approx(20.0, abs=1.5)
    assert found.outside_percent > 80.0


def test_a_force_channel_that_reads_too_much_shows_as_gain():
    x, v, a = sine()
    found, _ = answer(x, v, a, added=0.05 * (MASS * a + DAMPING * v))
    assert found.gain_percent == pytest.approx(5.0, abs=0.1)


def test_a_random_record_is_coherent_and_as_stiff_as_its_model():
    found, observed = answer(*many_tones())
    assert observed.kind != "sine"
    inside = (found.stiffness_frequency > 1.0) & (found.stiffness_frequency < 5.5)
    assert inside.sum() >= 10
    # Welch's segments leak between lines that do not fall on their bins, in both forces alike.
    assert found.stiffness[inside] == pytest.approx(found.model_stiffness[inside], rel=0.02)
    ratio = np.abs(found.stiffness[inside] / exact_stiffness(found.stiffness_frequency[inside]))
    assert np.median(ratio) == pytest.approx(1.0, abs=0.1)
    assert np.median(found.coherence[inside]) > 0.8


def test_a_record_of_one_segment_has_no_coherence_to_tell():
    short = slice(0, 100)
    x, v, a = many_tones()
    force = MASS * a + DAMPING * v + NOISE * np.random.default_rng(1).standard_normal(TIME.size)
    thin = np.arange(0, TIME.size, 50)[short]
    (observed,) = observe_all([Record("a.csv", TIME[thin], force[thin], x[thin])], 1)
    if observed.kind == "sine":
        pytest.fail("a record of many tones was taken for a sine test")
    found = response(compared_with(observed, np.zeros(observed.measured.size)))
    assert np.all(np.isnan(found.coherence))
