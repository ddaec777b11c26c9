"""Noisy records: what auto makes of them, the low-pass and its cut-off."""

import numpy as np
import pytest

from models.fractional import (
    band_limited_derivative,
    derivative,
    fractional_derivative,
    low_pass,
    noise_cutoff,
)
from models.fractional.noise import roughness
from models.fractional.quadrature import noise_gains
from tests.models.fractional import oracles

DT = 1e-3
OMEGA = 2 * np.pi * 5.0
ORDER = 1.89


def noise(count, size=1e-4, seed=0):
    return size * np.random.default_rng(seed).standard_normal(count)


@pytest.mark.parametrize("cycles", [10, 50.3])
@pytest.mark.parametrize("phase", [0.0, 0.9])
def test_sine_far_better_than_plain_gl(cycles, phase):
    t = DT * np.arange(int(cycles * 200))
    x = np.sin(OMEGA * t + phase) + noise(t.size)
    chosen = np.unique(np.linspace(1, t.size - 7, 150).astype(int))
    exact = oracles.sine(ORDER, OMEGA, phase, t[chosen], caputo=True)
    result = fractional_derivative(x, ORDER, DT)
    plain = derivative(x, ORDER, DT, scheme="gl")[chosen]
    error = oracles.relative_rms(result.values[chosen], exact)
    assert 20.0 * error < oracles.relative_rms(plain, exact)
    assert error < 3.0 * result.error


@pytest.mark.parametrize("order", [1.0, 1.5, 1.89])
def test_tapered_sine_far_better_than_plain_gl(order):
    # No sum of harmonics: this one has to be low-passed.
    t = DT * np.arange(8000)
    x = oracles.tapered("quintic", 2.0, OMEGA, t) + noise(t.size, seed=2)
    chosen = np.arange(27, t.size, 53)
    exact = oracles.tapered_derivative("quintic", 2.0, order, OMEGA, t[chosen])
    result = fractional_derivative(x, order, DT)
    assert result.scheme == "band-limited+bdf6"
    assert OMEGA / (2 * np.pi) < result.cutoff < 15.0
    error = oracles.relative_rms(result.values[chosen], exact)
    plain = oracles.relative_rms(derivative(x, order, DT, kind="grunwald-letnikov")[chosen], exact)
    assert error < plain / (20.0 if order > 1.8 else 5.0)
    assert 0.1 * result.error < error < 3.0 * result.error


def test_noise_level():
    t = DT * np.arange(5000)
    assert roughness(np.sin(OMEGA * t) + noise(5000)).noise == pytest.approx(1e-4, rel=0.1)
    assert roughness(np.sin(OMEGA * t)).noise < 1e-14
    single = np.sin(OMEGA * t).astype(np.float32).astype(float)
    assert 1e-9 < roughness(single).noise < 6e-8


@pytest.mark.parametrize(("scheme", "steps"), [("gl", 1), ("bdf2", 2), ("bdf4", 4), ("bdf6", 6)])
def test_noise_comes_through_as_a_single_sample_does(scheme, steps):
    # White noise is samples of chance size: its rms grows by the norm of what one of them makes.
    orders = [0.0, 0.3, 0.5, 1.0, 1.5, 1.9, 2.0]
    one = np.zeros(4000)
    one[100] = 1.0
    made = np.linalg.norm(derivative(one, orders, 1.0, scheme=scheme)[:, :164], axis=1)
    gains = noise_gains(np.array(orders), 1)[:, steps - 1]
    np.testing.assert_allclose(gains, made, rtol=1e-6)
    # Every second sample: each whole difference falls by the stride it is taken over.
    halves = noise_gains(np.array([0.0, 1.0, 2.0]), 2)[:, steps - 1]
    np.testing.assert_allclose(halves * [1.0, 2.0, 4.0], gains[[0, 3, 6]], rtol=1e-12)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("count", [1000, 10_000])
def test_cutoff_stands_just_above_the_signal(seed, count):
    t = DT * np.arange(count)
    x = np.sin(OMEGA * t) + 0.1 * np.sin(3 * OMEGA * t) + noise(count, seed=seed)
    found = noise_cutoff(x, DT, ORDER)
    assert 15.0 < found < 15.0 + 8.0 / (count * DT)


def test_cutoff_of_a_clean_record_is_high():
    t = DT * np.arange(4000)
    assert noise_cutoff(np.sin(OMEGA * t), DT, 1.0) > 4.0
    white = np.random.default_rng(0).standard_normal(4000)
    assert noise_cutoff(white, DT, 1.0) >= 1.0


def test_low_pass_keeps_and_removes_without_phase():
    t = DT * np.arange(4000)
    inner = slice(400, -400)
    slow = np.sin(OMEGA * t + 0.3)
    found = low_pass(slow + np.sin(2 * np.pi * 60.0 * t), DT, cutoff=20.0)
    assert np.max(np.abs(found - slow)[inner]) < 1e-3
    # The ends stay close too: nothing wraps round.
    drift = slow + 5.0 * t
    assert np.max(np.abs(low_pass(drift, DT, cutoff=20.0) - drift)) < 0.05


def test_same_filter_for_force_and_motion():
    # F = 3 D^1.5 x + 2 v: filtered force equals the band-limited terms, away from the ends.
    rng = np.random.default_rng(1)
    t = DT * np.arange(20_000)
    lines = 2 * np.pi * np.linspace(0.5, 30.0, 60)
    phases = rng.uniform(0, 2 * np.pi, 60)

    def motion(order):
        turned = np.outer(t, lines) + phases + order * np.pi / 2
        return np.sin(turned) @ lines**order

    force = 3.0 * motion(1.5) + 2.0 * motion(1.0)
    terms = band_limited_derivative(motion(0.0), [1.5, 1.0], DT, cutoff=10.0)
    found = low_pass(force, DT, cutoff=10.0)
    inner = slice(1000, -1000)
    assert oracles.relative_rms((3.0 * terms[0] + 2.0 * terms[1])[inner], found[inner]) < 1e-3


@pytest.mark.parametrize("edge_noise", [1e-6, 1e-2])
def test_ends_do_not_swing_out_where_much_lies_above_the_band(edge_noise):
    # Equal lines up to three times the cut-off: the extension must not fit what it can't carry.
    rng = np.random.default_rng(1)
    t = DT * np.arange(10_000)
    lines = 2 * np.pi * np.linspace(0.5, 30.0, 60)
    phases = rng.uniform(0, 2 * np.pi, 60)
    x = np.sin(np.outer(t, lines) + phases).sum(axis=1)
    gain = np.clip(2.0 - lines / (2 * np.pi * 10.0), 0.0, 1.0)  # roughly the low-pass
    size = np.sqrt(np.sum(gain * lines))  # of the half derivative, as an upper bound
    found = band_limited_derivative(x, [0.5], DT, cutoff=10.0, edge_noise=edge_noise)[0]
    assert np.max(np.abs(found)) < 8.0 * size


@pytest.mark.parametrize("order", [0.5, 1.0, 1.89])
def test_band_limited_sine(order):
    t = DT * np.arange(5000)
    found = band_limited_derivative(np.sin(OMEGA * t), [order], DT, cutoff=8.0)[0]
    exact = OMEGA**order * np.sin(OMEGA * t + order * np.pi / 2)
    assert oracles.relative_rms(found[1000:-1000], exact[1000:-1000]) < 5e-3
    assert oracles.relative_rms(found, exact) < 3e-2


@pytest.mark.parametrize("cutoff", [1.07, 1.14, 1.77, 1.78, 2.28, 5.65, 10.87])
def test_a_line_just_below_the_end_of_the_low_pass_is_no_error(cutoff):
    # There the gain is nothing but rounding, of either sign.
    t = 1e-3 * np.arange(8000)
    found = band_limited_derivative(np.sin(3.0 * t), [1.0], 1e-3, cutoff=cutoff)[0]
    inner = slice(2000, -2000)
    assert oracles.relative_rms(found[inner], 3.0 * np.cos(3.0 * t)[inner]) < 5e-3
