"""What a force channel does to a force, from closed formulas: droop, a bent scale, low-passes."""

import numpy as np
import pytest
from scipy.signal import butter, group_delay, lfilter

from discover.gap import close_gap
from discover.records import Campaign, Record
from tests.discover.gap_data import PLAN, campaign

BASELINE = "fit:inertia,viscous-damping,quadratic-damping,coulomb-friction"
DROOP, RC = 0.3, 3e-3


def force_of(t, x, v, a):
    return 120.0 * a + 800.0 * v + 1500.0 * v * np.abs(v) + 40.0 * np.tanh(v / 1e-3)


def passed_by(response):
    """Return the law of a force that a channel's response (of omega) passes.

    A record lasts whole cycles: its own spectrum is what passes.
    """

    def law(t, x, v, a):
        omega = 2.0 * np.pi * np.fft.rfftfreq(t.size, t[1] - t[0])
        return np.fft.irfft(response(omega) * np.fft.rfft(force_of(t, x, v, a)), t.size)

    return law


def high_pass(omega):
    return 1j * omega * DROOP / (1.0 + 1j * omega * DROOP)


def butterworth(omega):
    """Two sections of a fourth order, whose delays add up to RC."""
    damping = np.sin(np.pi / 8.0), np.sin(3.0 * np.pi / 8.0)
    s = 1j * omega * RC / (2.0 * sum(damping))
    return 1.0 / np.prod([1.0 + 2.0 * d * s + s**2 for d in damping], axis=0)


def test_a_charge_amplifier_that_droops_is_the_sensor_s():
    found = close_gap(campaign(passed_by(high_pass)), BASELINE)
    first = found.rounds[0]
    assert first.effect == "sensor-gain"
    assert first.probability > 0.9
    assert first.parameters["droop_time"] == pytest.approx(DROOP, rel=0.05)
    assert first.coefficient == pytest.approx(-1.0, abs=0.05)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


@pytest.mark.parametrize("bend", [0.12, -0.12])
def test_a_cell_whose_gain_goes_with_load_is_the_sensor_s(bend):
    full = 1500.0

    def law(t, x, v, a):
        force = force_of(t, x, v, a)
        return force * (1.0 + bend * np.abs(force) / full)

    found = close_gap(campaign(law), BASELINE)
    first = found.rounds[0]
    assert first.effect == "sensor-gain"
    assert first.probability > 0.9
    assert first.parameters["load_power"] == 1.0
    assert first.coefficient / first.parameters["load"] == pytest.approx(bend / full, rel=0.05)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


@pytest.mark.parametrize(
    ("response", "order"),
    [
        (lambda omega: 1.0 / (1.0 + 1j * omega * RC), 1.0),
        pytest.param(butterworth, 4.0, marks=pytest.mark.sweep),
    ],
    ids=["resistor and capacitor", "Butterworth"],
)  # fmt: skip
def test_a_low_pass_in_the_force_channel_is_a_delay(response, order):
    found = close_gap(campaign(passed_by(response), noise=3e-3), BASELINE)
    (first,) = found.rounds
    assert first.effect == "time-delay"
    assert first.parameters["filter_order"] == order
    assert first.probability > 0.9
    assert first.coefficient == pytest.approx(RC, rel=0.05)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


RATE, BEFORE = 160.0, 400
"""Hz of a logger, and samples that its filter saw before the record."""


def logged(read, noise=3e-3):
    """Return tests of which the logger keeps what it reads of the samples, coarse ones."""
    rng, records = np.random.default_rng(5), []
    for frequency, amplitude in PLAN:
        time = np.arange(-BEFORE, round(8.0 * RATE / frequency)) / RATE
        omega = 2.0 * np.pi * frequency
        x, v = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
        force = read(force_of(time, x, v, -(omega**2) * x))[BEFORE:]
        force += noise * np.sqrt(np.mean(force**2)) * rng.standard_normal(force.size)
        records.append(Record(f"{frequency}-{amplitude}.csv", time[BEFORE:], force, x[BEFORE:]))
    return Campaign("logged", tuple(records))


@pytest.mark.sweep
@pytest.mark.xfail(strict=True, reason="a filter before sampling is stated")
def test_a_force_that_was_filtered_after_it_was_sampled_is_a_delay():
    top, bottom = butter(1, 25.0, fs=RATE)
    late = float(group_delay((top, bottom), w=[1e-4])[1][0]) / RATE
    found = close_gap(logged(lambda force: lfilter(top, bottom, force)), BASELINE)
    first = found.rounds[0]
    assert first.effect == "time-delay"
    assert first.probability > 0.9
    assert first.parameters["digital"] == 1.0
    assert first.coefficient == pytest.approx(late, rel=0.01)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


@pytest.mark.xfail(strict=True, reason="a delay is named first")
def test_a_gain_behind_a_logger_s_filter_is_no_delay():
    """Its lag is a twentieth of a sample; a delay had been named with certainty."""
    corner = 55.0

    def read(force):
        top, bottom = butter(1, corner, fs=RATE)
        return force + 0.2 * lfilter(top, bottom, force)

    first = close_gap(logged(read), BASELINE).rounds[0]
    assert first.effect == "sensor-gain"
    assert first.coefficient == pytest.approx(0.2, abs=0.03)
    warped = 1.0 / (2.0 * RATE * np.tan(np.pi * corner / RATE))
    assert first.parameters["filter_time"] == pytest.approx(warped, rel=0.1)
    assert first.parameters["digital"] == 1.0
