"""Records that repeat: means of periods, exact derivatives, and what differs between periods."""

import numpy as np
import pytest

from discover.motion_fit.periodic import observe_periodic
from discover.records import Record

STEP = 1.0 / 500.0


def periodic(periods=8, period=2000, noise=0.0, seed=0):
    rng = np.random.default_rng(seed)
    orders = np.arange(2, 60)
    omega = 2.0 * np.pi * orders / (period * STEP)
    time = STEP * np.arange(periods * period)
    phase = rng.uniform(0.0, 2.0 * np.pi, orders.size)
    wave = np.exp(1j * (np.outer(time, omega) + phase))
    x, v = (np.imag(wave @ (1e-3 * (1j * omega) ** q)) for q in (0, 1))
    half = np.imag(wave @ (1e-3 * (1j * omega) ** 1.5))
    force = 50.0 * half + 2e7 * x**3 + noise * rng.standard_normal(time.size)
    record = Record("p.csv", time, force, x + 1e-9 * rng.standard_normal(time.size))
    return observe_periodic(record, slice(None), period), (x[:period], v[:period], half[:period])


def test_periods_are_averaged_and_derivatives_are_exact():
    seen, (x, v, half) = periodic()
    assert seen.motion.periodic
    np.testing.assert_allclose(seen.motion.velocity, v, atol=1e-6 * np.abs(v).max())
    (window,) = seen.windows
    columns = np.stack([seen.motion.fractional(1.5), seen.motion.displacement**3])
    lines = window.project(columns)
    stacked = np.concatenate((lines.real, lines.imag), axis=1).T
    target = np.concatenate((window.force.real, window.force.imag))
    found = np.linalg.lstsq(stacked, target, rcond=None)[0]
    np.testing.assert_allclose(found, [50.0, 2e7], rtol=1e-4)
    np.testing.assert_allclose(window.project(half), lines[0], atol=1e-5 * np.abs(lines[0]).max())


def test_what_does_not_repeat_is_the_noise():
    ratios = []
    clean = periodic()[0].windows[0]
    for seed in range(6):
        seen, _ = periodic(noise=3.0, seed=seed)
        reference = periodic(seed=seed)[0].windows[0]
        (window,) = seen.windows
        assert seen.force_noise == pytest.approx(3.0, rel=0.05)
        found = 0.5 * np.mean(np.abs(window.force - reference.force)[1:] ** 2)
        ratios.append(window.variance[1:].mean() / found)
        # the mean of eight periods: rms^2 / 8, spread over the lines of half the rate
        assert window.variance[1:].mean() == pytest.approx(9.0 / 8.0 / 2000.0, rel=0.35)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.2)
    assert clean.variance.max() < 1e-6 * clean.power
