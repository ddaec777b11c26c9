"""A channel's low-pass against Butterworth's |H|^2 = 1 / (1 + (w/w_c)^2n) and its delay."""

import numpy as np
import pytest
from scipy.signal import butter, group_delay, lfilter

from models.motion import Motion, sine_motion
from models.terms.low_pass import earlier, low_passed, low_passed_cycle, low_passed_samples

DELAY = 0.02
DAMPINGS = {
    1: [0.5], 2: [np.sqrt(0.5)], 3: [0.5, 0.5], 4: np.sin(np.pi / 8.0 * np.array([1.0, 3.0])),
}  # fmt: skip
"""Ratios of the poles' pairs, evenly spread over a half circle; a first order has half a pair."""
CORNERS = {order: 2.0 * sum(ratios) / DELAY for order, ratios in DAMPINGS.items()}
"""rad/s."""
ORDERS = sorted(CORNERS)


def at_samples(time, speed):
    still = np.zeros_like(time)
    return Motion(time, still, speed, still, lambda orders: still, "none")


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("frequency", [0.5, 4.0, 15.0])
def test_a_steady_sine_is_passed_as_butterworth_has_it(order, frequency):
    angle = 2.0 * np.pi * np.arange(256) / 256
    passed = low_passed_cycle(np.cos(angle), 1.0 / (256 * frequency), DELAY, order)
    line = np.fft.rfft(passed)[1] / 128
    omega = 2.0 * np.pi * frequency
    share = (omega / CORNERS[order]) ** (2 * order)
    assert abs(line) ** 2 == pytest.approx(1.0 / (1.0 + share), rel=1e-9)
    if frequency == 0.5:
        assert -np.angle(line) / omega == pytest.approx(DELAY, rel=5e-3)


@pytest.mark.parametrize("order", ORDERS)
def test_moments_before_sum_up_to_the_same(order):
    ago, weights = earlier(order)
    for omega in (1.0, 10.0, 25.0):
        angle = omega * DELAY * ago
        passed = np.sum(weights * np.exp(-1j * angle))
        share = (omega / CORNERS[order]) ** (2 * order)
        assert abs(passed) ** 2 == pytest.approx(1.0 / (1.0 + share), rel=2e-4)


@pytest.mark.parametrize("order", ORDERS)
def test_a_slope_passes_late_and_what_was_settled_stays(order):
    time = np.linspace(0.0, 1.0, 2001)
    still = np.zeros_like(time)
    motion = at_samples(time, still)
    ramp = np.maximum(time - 0.2, 0.0) + 3.0
    passed = low_passed(ramp, motion, DELAY, order)
    assert np.allclose(passed[:400], 3.0, atol=1e-9)
    assert passed[-1] == pytest.approx(ramp[-1] - DELAY, abs=1e-6)


@pytest.mark.parametrize("order", ORDERS)
def test_a_record_ends_in_the_steady_state_of_its_cycle(order):
    cycle = sine_motion(1.0, 3.0)
    steady = low_passed(cycle.velocity, cycle, DELAY, order)
    time = np.arange(12 * cycle.velocity.size) * cycle.step
    speed = np.tile(cycle.velocity, 12)
    late = low_passed(speed, at_samples(time, speed), DELAY, order)[-steady.size :]
    assert np.allclose(late, steady, atol=2e-4 * np.abs(steady).max())


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("corner", [8.0, 40.0])
def test_a_digital_low_pass_is_that_which_scipy_designs_for_the_sampling_rate(order, corner):
    rate = 100.0
    top, bottom = butter(order, corner, fs=rate)
    late = float(group_delay((top, bottom), w=[1e-4])[1][0]) / rate
    jumps = np.sign(np.sin(0.3 * np.arange(400.0)))
    jumps[:5] = 0.0  # settled as it begins
    passed = low_passed_samples(jumps, 1.0 / rate, late, order)
    np.testing.assert_allclose(passed, lfilter(top, bottom, jumps), atol=1e-5)
    motion = at_samples(np.arange(400) / rate, jumps)
    np.testing.assert_array_equal(low_passed(jumps, motion, late, order, digital=True), passed)
