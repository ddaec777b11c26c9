"""Kinks inside a record are found, and treated like starts."""

import numpy as np
import pytest

from models.fractional import derivative, fractional_derivative
from models.fractional.kinks import find_kinks
from tests.models.fractional import oracles

OMEGA = 2.0 * np.pi


@pytest.mark.parametrize("power", [1, 2, 3])
@pytest.mark.parametrize("place", [3.0, 3.00037, 7.90051])
def test_place_and_jump(power, place):
    t = 1e-3 * np.arange(12_000)
    x = np.sin(t) + 0.3 * np.clip(t - place, 0.0, None) ** power
    (kink,) = find_kinks(x)
    assert kink.position == pytest.approx(place * 1e3, abs=2e-3)
    assert not kink.jumps[:power].any()
    assert kink.jumps[power] * 1e3**power == pytest.approx(0.3, rel=1e-3)


def test_several_of_different_size():
    t = 1e-3 * np.arange(12_000)
    places = [2.0003, 5.5, 9.0001]
    sizes = [1.0, -0.1, 0.5]
    parts = [c * np.clip(t - p, 0.0, None) ** 3 for c, p in zip(sizes, places, strict=True)]
    found = find_kinks(np.cos(t) + sum(parts))
    assert [k.position * 1e-3 for k in found] == pytest.approx(places, abs=1e-5)


@pytest.mark.parametrize("seed", range(3))
def test_none_in_noise_or_smooth_records(seed):
    t = 1e-3 * np.arange(5000)
    noise = 1e-3 * np.random.default_rng(seed).standard_normal(t.size)
    assert find_kinks(np.sin(5.0 * t) + noise) == ()
    assert find_kinks(np.sin(5.0 * t)) == ()
    assert find_kinks(np.sin(5.0 * t**2)) == ()
    assert find_kinks(np.zeros(1000)) == ()
    assert find_kinks(t[:20]) == ()


def test_kink_that_noise_hides_from_neighbouring_samples():
    t = 1e-4 * np.arange(100_000)
    noise = 1e-10 * np.random.default_rng(3).standard_normal(t.size)
    x = np.sin(t) + 0.3 * np.clip(t - 3.00037, 0.0, None) ** 2 + noise
    assert find_kinks(x) == ()
    (kink,) = find_kinks(x, 64)
    assert kink.position == pytest.approx(30_003.7, abs=1.0)
    assert kink.jumps[2] * 1e8 == pytest.approx(0.3, rel=1e-2)


@pytest.mark.parametrize("count", [100_000, 400_000])
@pytest.mark.parametrize("order", [0.5, 1.2, 1.5])
def test_kinks_of_fine_sampling(order, count):
    dt = 10.0 / count
    t = dt * np.arange(count)
    near = int(2.3 / dt) + np.geomspace(2, count // 20, 40).astype(int)
    chosen = np.unique(np.concatenate([near, np.linspace(1, count - 1, 40).astype(int)]))
    exact = oracles.tapered_derivative("cubic", 2.3, order, OMEGA, t[chosen])
    found = derivative(oracles.tapered("cubic", 2.3, OMEGA, t), order, dt)[chosen]
    assert oracles.relative_rms(found, exact) < 1e-8


@pytest.mark.parametrize("order", [0.5, 1.5])
@pytest.mark.parametrize("length", [1.0, 2.0, 2.3])
def test_cubic_smoothstep(order, length):
    dt = 20.0 / 10_000
    t = dt * np.arange(10_000)
    x = oracles.tapered("cubic", length, OMEGA, t)
    near = int(length / dt) + np.arange(-3, 12)
    chosen = np.unique(np.concatenate([near, np.linspace(1, t.size - 1, 40).astype(int)]))
    exact = oracles.tapered_derivative("cubic", length, order, OMEGA, t[chosen])
    result = fractional_derivative(x, order, dt)
    error = np.max(np.abs(result.values[chosen] - exact)) / OMEGA**order
    plain = derivative(x, order, dt, scheme=result.scheme)[chosen]
    assert error < 1e-6
    assert error < 1e-2 * np.max(np.abs(plain - exact)) / OMEGA**order
    assert result.error < 1e-6


@pytest.mark.parametrize(("place", "bar"), [(0.005, 1e-4), (3.99, 1e-6), (3.999, 1e-6)])
def test_kink_next_to_an_end_does_little_harm(place, bar):
    # There is no room for a fit on both sides: the kink stays, the rest must not suffer.
    t = 1e-3 * np.arange(4000)
    found = derivative(np.sin(t) + np.clip(t - place, 0.0, None) ** 2, 0.5, 1e-3)[1::400]
    exact = oracles.sine(0.5, 1.0, 0.0, t[1::400], caputo=True)
    exact += oracles.power(2, 0.5, np.clip(t - place, 0.0, None))[1::400]
    np.testing.assert_allclose(found, exact, atol=bar)
