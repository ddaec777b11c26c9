"""Sine fits against exact signals, the Cramer-Rao bound and invariances."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from discover.sine_fit import fit_sine, harmonic_design, harmonic_series
from models.checks import InputError


def _signal(t: np.ndarray, f: float, phasors: dict[int, complex], mean: float) -> np.ndarray:
    x = np.full_like(t, mean)
    for k, c in phasors.items():
        x = x + abs(c) * np.cos(2 * np.pi * k * f * t + np.angle(c))
    return x


@pytest.mark.parametrize("cycles", [1.7, 2.3, 5.0, 17.31, 240.5])
def test_exact_signal_is_recovered_for_any_number_of_cycles(cycles: float) -> None:
    f = 0.73
    t = 11.2 + np.linspace(0.0, cycles / f, max(400, int(30 * cycles)))
    phasors = {1: 0.02 * np.exp(0.4j), 2: 0.0003j, 3: -0.0011 + 0.0002j}
    fit = fit_sine(t, _signal(t, f, phasors, 0.005) + 2e-5 * (t - t.mean()))
    assert fit.frequency == pytest.approx(f, rel=1e-9)
    assert fit.trend == pytest.approx(2e-5, rel=1e-6)
    assert fit.coefficients[0] == pytest.approx(0.005, rel=1e-9)
    for k, c in phasors.items():
        assert abs(fit.coefficients[k] - c) < 1e-9
    assert fit.coefficients.size == 4
    assert fit.cycles == pytest.approx(cycles, rel=1e-9)
    assert fit.quality == pytest.approx(1.0, abs=1e-12)


def test_coefficients_are_in_the_records_own_time() -> None:
    t = 5.0 + np.arange(900) / 300.0
    fit = fit_sine(t, 3.0 * np.cos(2 * np.pi * 2.6 * t))
    assert abs(fit.coefficients[1] - 3.0) < 1e-9
    rebuilt = harmonic_series(t, fit.frequency, fit.coefficients)
    np.testing.assert_allclose(rebuilt, 3.0 * np.cos(2 * np.pi * 2.6 * t), atol=1e-9)


def test_frequency_error_reaches_the_cramer_rao_bound_and_is_reported() -> None:
    rng = np.random.default_rng(1)
    n, fs, f, sigma = 2000, 100.0, 1.37, 0.1
    t = np.arange(n) / fs
    fits = [
        fit_sine(t, np.sin(2 * np.pi * f * t) + sigma * rng.standard_normal(n)) for _ in range(60)
    ]
    bound = np.sqrt(6.0 / n) * sigma / (np.pi * n / fs)
    spread = np.sqrt(np.mean([(fit.frequency - f) ** 2 for fit in fits]))
    assert spread == pytest.approx(bound, rel=0.25)
    reported = np.median([fit.frequency_std_error for fit in fits])
    assert reported == pytest.approx(bound, rel=0.25)
    assert np.mean([fit.noise_rms for fit in fits]) == pytest.approx(sigma, rel=0.02)
    assert np.mean([fit.white_level for fit in fits]) == pytest.approx(sigma, rel=0.05)


def test_phasor_errors_are_reported_truly_where_noise_is_coloured() -> None:
    rng = np.random.default_rng(2)
    n, fs, f = 8000, 400.0, 2.0
    t = np.arange(n) / fs
    pulls = []
    for _ in range(40):
        noise = np.convolve(rng.standard_normal(n + 200), np.full(40, 0.025), "same")[100 : 100 + n]
        fit = fit_sine(t, np.cos(2 * np.pi * f * t) + 0.1 * noise, frequency=f)
        pulls.append((fit.coefficients[1] - 1.0) / fit.std_errors[1])
    assert np.std(np.real(pulls)) == pytest.approx(1.0, abs=0.4)
    assert np.std(np.imag(pulls)) == pytest.approx(1.0, abs=0.4)


def test_noise_is_rarely_taken_for_harmonics() -> None:
    rng = np.random.default_rng(3)
    t = np.arange(1500) / 100.0
    false = 0
    for _ in range(50):
        fit = fit_sine(t, np.sin(2 * np.pi * 1.1 * t) + 0.05 * rng.standard_normal(t.size))
        false += int(np.count_nonzero(fit.coefficients[2:]))
    assert false <= 3  # 300 tests at 1e-3


def test_weak_distortion_above_the_noise_is_kept() -> None:
    rng = np.random.default_rng(4)
    t = np.arange(4000) / 200.0
    x = np.sin(2 * np.pi * 1.1 * t) + 0.01 * np.cos(2 * np.pi * 3.3 * t)
    fit = fit_sine(t, x + 0.02 * rng.standard_normal(t.size))
    assert abs(fit.coefficients[3] - 0.01) < 4.5 * fit.std_errors[3]
    assert fit.coefficients[2] == 0
    assert fit.distortion == pytest.approx(0.01, abs=0.002)


def test_given_frequency_is_held() -> None:
    t = np.arange(1000) / 100.0
    fit = fit_sine(t, np.sin(2 * np.pi * 1.01 * t), frequency=1.0)
    assert fit.frequency == 1.0
    assert fit.frequency_std_error == 0.0
    assert fit.quality < 0.99


def test_non_uniform_time() -> None:
    rng = np.random.default_rng(5)
    t = np.sort(rng.uniform(0.0, 4.0, 300))
    fit = fit_sine(t, _signal(t, 0.9, {1: 1.0, 3: 0.1j}, 0.2))
    assert fit.frequency == pytest.approx(0.9, rel=1e-9)
    assert abs(fit.coefficients[3] - 0.1j) < 1e-9


def test_square_wave_force_has_its_fourier_series() -> None:
    t = (np.arange(20000) + 0.5) / 2000.0
    fit = fit_sine(t, np.sign(np.sin(2 * np.pi * t)), frequency=1.0, harmonics=9)
    for k in (1, 3, 5, 7, 9):
        assert abs(fit.coefficients[k] + 4j / (np.pi * k)) < 1e-3
    assert np.abs(fit.coefficients[2::2]).max() < 1e-3


def test_sine_is_of_better_quality_than_sweep_and_noise() -> None:
    rng = np.random.default_rng(6)
    t = np.arange(4000) / 200.0
    sine = fit_sine(t, np.sin(9.0 * t) + 0.1 * rng.standard_normal(t.size)).quality
    sweep = fit_sine(t, np.sin(2 * np.pi * (0.5 + 0.2 * t) * t)).quality
    noise = fit_sine(t, rng.standard_normal(t.size)).quality
    assert sine > 0.97
    assert max(sweep, noise) < 0.5


@settings(max_examples=15, deadline=None)
@given(
    f=st.floats(0.3, 8.0),
    phase=st.floats(-3.0, 3.0),
    scale=st.floats(1e-6, 1e6),
    shift=st.floats(-100.0, 100.0),
)
def test_unit_and_time_shift_change_nothing_else(
    f: float, phase: float, scale: float, shift: float
) -> None:
    t = np.arange(2000) / 250.0
    x = np.cos(2 * np.pi * f * t + phase) + 0.02 * np.cos(4 * np.pi * f * t) + 0.3
    plain, other = fit_sine(t, x), fit_sine(t + shift, scale * x)
    assert other.frequency == pytest.approx(plain.frequency, rel=1e-8)
    assert other.amplitude == pytest.approx(scale * plain.amplitude, rel=1e-7)
    turned = plain.coefficients[1] * np.exp(-2j * np.pi * plain.frequency * shift)
    assert abs(other.coefficients[1] / scale - turned) < 1e-5


def test_design_columns_give_phasors_and_series_is_their_sum() -> None:
    t = np.linspace(0.0, 3.0, 50)
    c = np.array([0.5, 1.0 - 2.0j, 0.0, 0.25j])
    beta = [0.5, 1.0, -2.0, 0.0, 0.25]
    np.testing.assert_allclose(
        harmonic_design(t, 0.7, (1, 3)) @ beta, harmonic_series(t, 0.7, c), atol=1e-12
    )
    assert harmonic_design(t, 0.7, 3, trend=True).shape == (50, 8)


def test_inputs_are_not_changed_and_result_is_frozen() -> None:
    t, x = np.arange(100) / 10.0, np.sin(np.arange(100) / 5.0)
    t.flags.writeable = x.flags.writeable = False
    fit = fit_sine(t, x)
    with pytest.raises(ValueError, match="read-only"):
        fit.coefficients[0] = 1.0
    assert fit.to_dict()["coefficients"][0][1] == 0.0


@pytest.mark.parametrize(
    ("t", "x", "message"),
    [
        (np.arange(5.0), np.arange(5.0), "at least 8 values, got 5"),
        (np.arange(10.0), np.ones(10), "varying, got a constant"),
        (np.arange(10.0), np.r_[np.nan, np.arange(9.0)], "finite throughout"),
        (np.arange(10.0)[::-1], np.arange(10.0) % 3, "strictly increasing"),
        (np.arange(10.0), np.arange(11.0), r"of shape \(10,\)"),
    ],
)
def test_bad_input_is_said_with_its_record(t: np.ndarray, x: np.ndarray, message: str) -> None:
    with pytest.raises(InputError, match="run 3: .*" + message):
        fit_sine(t, x, where="run 3")
