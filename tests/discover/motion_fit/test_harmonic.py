"""Lines of sine tests against forces whose harmonics are known."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.motion_fit.harmonic import observe_sine
from discover.records import Record
from discover.sine_fit import SineFit
from models.checks import InputError

AMPLITUDE = 0.01


def sine_record(force_of, *, frequency=1.3, cycles=7.37, rate=400.0, start=2.0, phase=0.4, **more):
    """Return a sine record x = A sin(w t + phase); `force_of` takes that angle."""
    time = start + np.arange(int(cycles / frequency * rate)) / rate
    angle = 2.0 * np.pi * frequency * time + phase
    return Record("a.csv", time, force_of(angle), AMPLITUDE * np.sin(angle), **more)


def seen(record, *, frequency=1.3, phase=0.4):
    """Return the observation with the motion given exactly."""
    phasor = -1j * AMPLITUDE * np.exp(1j * phase)
    exact = SineFit(
        frequency, 0.0, np.array([0.0, phasor]), np.zeros(2), 0.0, 0.0, 0.0,
        np.zeros(record.time.size), 1.0, float(np.ptp(record.time)) * frequency,
    )
    return observe_sine(record, slice(None), frequency, exact)


def random_force(seed, harmonics=9):
    """Return a force of random harmonics of the angle, and its phasors against that angle."""
    rng = np.random.default_rng(seed)
    phasors = rng.standard_normal(harmonics + 1) + 1j * rng.standard_normal(harmonics + 1)
    phasors[0] = phasors[0].real
    orders = np.arange(harmonics + 1)
    return lambda angle: np.real(np.exp(1j * np.outer(angle, orders)) @ phasors), phasors


def expected_lines(phasors, size):
    lines = np.zeros(size, dtype=complex)
    lines[: phasors.size] = phasors
    lines[1:] /= np.sqrt(2.0)
    return lines


@pytest.mark.parametrize("cycles", [1.6, 3.0, 7.37, 20.5])
@pytest.mark.parametrize("seed", [0, 1])
def test_random_harmonics_are_found_exactly_in_broken_cycles(cycles, seed):
    force, phasors = random_force(seed)
    (window,) = seen(sine_record(force, cycles=cycles)).windows
    np.testing.assert_allclose(window.force, expected_lines(phasors, window.force.size), atol=1e-9)
    np.testing.assert_allclose(window.omega, 2.0 * np.pi * 1.3 * np.arange(window.force.size))


def test_squared_lines_add_up_to_the_mean_square():
    force, _ = random_force(2)
    record = sine_record(force, cycles=8.0, frequency=1.25)
    (window,) = seen(record, frequency=1.25).windows
    assert window.power == pytest.approx(np.mean(record.force**2), rel=5e-3)
    angle = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    assert np.sum(np.abs(window.force) ** 2) == pytest.approx(np.mean(force(angle) ** 2), rel=1e-9)


def test_the_rest_is_the_mean_square_of_what_no_line_holds():
    rng = np.random.default_rng(3)
    noise = rng.standard_normal(4000)
    force, _ = random_force(3)
    record = sine_record(lambda angle: force(angle) + 0.5 * noise, cycles=13.0, rate=400.0)
    (window,) = seen(record).windows
    assert record.force.size == 4000
    # 31 harmonics, the mean and the trend take 64 of 4000 degrees of freedom
    assert window.rest == pytest.approx(0.25 * (1.0 - 64 / 4000), rel=0.08)


def test_phase_is_counted_from_the_motion_s_own():
    """A spring's line is -i A k / sqrt 2, a damper's real and positive, whenever the record is."""
    for start, phase in ((0.0, 0.0), (2.0, 0.4), (-7.3, 3.0)):
        for law, line in ((np.sin, -1j), (np.cos, 1.0)):
            record = sine_record(lambda a, law=law: 5.0 * law(a), start=start, phase=phase)
            (window,) = seen(record, phase=phase).windows
            assert abs(window.force[1] - 5.0 * line / np.sqrt(2.0)) < 1e-9


def test_shift_in_time_changes_no_line():
    force, _ = random_force(4)
    early, late = (seen(sine_record(force, start=s)).windows[0].force for s in (0.0, 1000.0))
    np.testing.assert_allclose(early, late, atol=1e-8)


def test_columns_pass_the_same_map_as_the_force():
    force, phasors = random_force(5)
    observed = seen(sine_record(force))
    (window,) = observed.windows
    angle = 2.0 * np.pi * 1.3 * observed.time + 0.4
    columns = np.stack([force(angle), np.cos(angle), np.ones_like(angle)])
    lines = window.project(columns)
    np.testing.assert_allclose(lines[0], window.force, atol=1e-10)
    np.testing.assert_allclose(lines[0], expected_lines(phasors, lines.shape[1]), atol=1e-9)
    np.testing.assert_allclose(lines[2], np.eye(lines.shape[1])[0], atol=1e-9)


def test_jumps_of_friction_alias_in_force_and_column_alike():
    """The column is the same function at the same samples, so no line is left over."""
    record = sine_record(lambda a: 40.0 * np.sign(np.cos(a)), rate=77.0, cycles=11.3)
    observed = seen(record)
    (window,) = observed.windows
    left = window.force - 40.0 * window.project(np.sign(observed.motion.velocity))
    assert np.abs(left).max() < 1e-9


def test_derivatives_of_any_order_follow_the_harmonic_rule():
    observed = seen(sine_record(np.sin))
    omega, angle = 2.0 * np.pi * 1.3, 2.0 * np.pi * 1.3 * observed.time + 0.4
    for order in (0.48, 1.0, 1.89):
        expected = AMPLITUDE * omega**order * np.sin(angle + 0.5 * np.pi * order)
        np.testing.assert_allclose(
            observed.motion.fractional(order), expected, atol=1e-9 * AMPLITUDE * omega**order
        )


def test_an_earlier_motion_is_the_one_of_earlier_samples():
    observed = seen(sine_record(np.sin))
    angle = 2.0 * np.pi * 1.3 * (observed.time - 2e-3) + 0.4
    earlier = observed.at(observed.time - 2e-3).displacement
    np.testing.assert_allclose(earlier, AMPLITUDE * np.sin(angle), atol=1e-12)


def test_a_straight_drift_of_the_force_is_in_no_line():
    force, phasors = random_force(6)
    drifting = sine_record(force)
    drifted = Record(
        "a.csv", drifting.time, drifting.force + 0.7 * (drifting.time - 3.0), drifting.displacement
    )
    observed = seen(drifted)
    (window,) = observed.windows
    np.testing.assert_allclose(window.force[1:10], expected_lines(phasors, 10)[1:], atol=1e-9)
    assert observed.drift == pytest.approx(0.7, rel=1e-9)


def test_variance_of_lines_is_that_of_repeated_noise():
    rng = np.random.default_rng(7)
    force, phasors = random_force(7)
    lines, variances = [], []
    for _ in range(60):
        noisy = sine_record(force, cycles=8.4, rate=200.0)
        noise = rng.standard_normal(noisy.time.size)
        record = Record("a.csv", noisy.time, noisy.force + noise, noisy.displacement)
        (window,) = seen(record).windows
        lines.append(window.force - expected_lines(phasors, window.force.size))
        variances.append(window.variance)
    lines, stated = np.array(lines)[:, 1:], np.mean(variances, axis=0)[1:]
    found = 0.5 * np.mean(np.abs(lines) ** 2, axis=0)
    # 120 draws a line: 13 %; over all 31 lines 2.3 %; stated a little high, by design
    assert np.mean(stated / found) == pytest.approx(1.05, abs=0.12)
    assert np.all((stated / found > 0.6) & (stated / found < 1.8))


@pytest.mark.parametrize("phase", [0.0, 0.9, 2.5, 4.6])
def test_a_digitised_force_curve_gets_the_phase_of_its_motion(phase):
    rng = np.random.default_rng(8)
    frequency = 0.5
    omega = 2.0 * np.pi * frequency
    time = np.sort(rng.uniform(0.0, 2.1 / frequency, 240))
    angle = omega * time + phase
    v = 0.02 * omega * np.cos(angle)
    force = -370.0 * 0.02 * omega**2 * np.sin(angle) + 8e3 * v * np.abs(v) + 400.0 * np.sign(v)
    record = Record(
        "fig2.csv", time, force + 5.0 * rng.standard_normal(240), frequency=frequency,
        amplitude=0.02, uniform=False,
    )  # fmt: skip
    observed = observe(record)
    assert observed.phase_fitted
    assert observed.amplitude == pytest.approx(0.02)
    wave = observed.motion.displacement @ np.exp(-1j * omega * observed.time)
    truth = np.sin(omega * observed.time + phase) @ np.exp(-1j * omega * observed.time)
    # steps of one degree, and noise
    assert abs(np.angle(wave / truth)) < np.radians(2.0)


def test_a_measured_motion_is_not_called_fitted():
    assert not seen(sine_record(np.sin)).phase_fitted


def test_too_few_cycles_or_samples_are_refused():
    with pytest.raises(InputError, match="usable cycles"):
        seen(sine_record(np.sin, cycles=1.2))
    with pytest.raises(InputError, match="sampling"):
        seen(sine_record(np.sin, rate=2.7, cycles=40.0))


def test_without_amplitude_there_is_no_motion():
    time = np.arange(400) / 100.0
    record = Record("f.csv", time, np.sin(2 * np.pi * time), frequency=1.0)
    with pytest.raises(InputError, match="amplitude"):
        observe_sine(record, slice(None), 1.0, None)
