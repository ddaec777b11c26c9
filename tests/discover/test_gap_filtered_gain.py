"""A gain behind a filter: told from a delay where its corner is in the band, beside it below."""

import numpy as np
import pytest

from discover.gap import close_gap
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign

BASELINE = "fit:inertia,viscous-damping"
GAIN = 0.2


def amplified(time_constant, gain=GAIN):
    """The linear device's force and a share of it behind a low-pass, by their phasors."""

    def law(t, x, v, a):
        omega = (np.sum(a**2) / np.sum(x**2)) ** 0.25
        passed = gain / (1.0 + 1j * omega * time_constant)
        late_a, late_v = omega * v, omega * x  # a quarter of a cycle ago
        force, quarter = 120.0 * a + 800.0 * v, 120.0 * late_a + 800.0 * late_v
        return (1.0 + passed.real) * force - passed.imag * quarter

    return law


@pytest.mark.parametrize(("time_constant", "accuracy"), [(0.02, 0.03), (0.005, 0.25)])
def test_a_gain_that_falls_within_the_band_is_the_sensor_s(time_constant, accuracy):
    found = close_gap(campaign(amplified(time_constant)), BASELINE)
    first = found.rounds[0]
    assert first.effect == "sensor-gain"
    assert first.probability > 0.9
    assert first.parameters["filter_time"] == pytest.approx(time_constant, rel=accuracy)
    assert first.interval[0] < GAIN < first.interval[1]
    assert first.coefficient == pytest.approx(GAIN, rel=accuracy)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


def test_a_gain_that_falls_above_the_band_may_as_well_be_a_delay():
    found = close_gap(campaign(amplified(1e-3)), BASELINE)
    first = found.rounds[0]
    stated = {first.effect, *(name for name, _ in first.alternatives)}
    assert stated >= {"sensor-gain", "time-delay"}


def test_what_a_delay_promises_in_a_straight_line_does_not_rule_a_gain_out():
    """Friction's jump overshoots where slow forces read too little.

    An early force would fit better, if it went on as it begins: named with certainty before.
    """

    def law(t, x, v, a):  # a record lasts whole cycles, so its own spectrum is what passes
        force = 120.0 * a + 800.0 * v + 250.0 * np.tanh(v / 1e-3)
        omega = 2.0 * np.pi * np.fft.rfftfreq(t.size, t[1] - t[0])
        passed = 1.0 - 0.15 / (1.0 + 5e-4j * omega)
        return np.fft.irfft(passed * np.fft.rfft(force), t.size)

    lacking = f"{BASELINE},quadratic-damping,coulomb-friction"
    found = close_gap(campaign(law, noise=3e-3), lacking)
    assert found.rounds[0].effect == "sensor-gain"


def test_a_delay_is_no_gain_behind_a_filter():
    late = 2e-3

    def law(t, x, v, a):
        omega = (np.sum(a**2) / np.sum(x**2)) ** 0.25
        angle = omega * late
        then = omega * x * np.sin(angle) + v * np.cos(angle)
        return 120.0 * (a * np.cos(angle) + omega * v * np.sin(angle)) + 800.0 * then

    found = close_gap(campaign(law), BASELINE)
    first = found.rounds[0]
    assert first.effect == "time-delay"
    assert first.coefficient == pytest.approx(late, rel=0.05)


def test_no_sensor_is_said_to_add_half_of_its_signal_behind_a_filter():
    """With its filter so great a gain is any delay, or any memory of a flow."""
    found = close_gap(campaign(amplified(0.02, 0.45)), BASELINE)
    gains = [r for r in found.rounds if r.effect == "sensor-gain"]
    assert not any(r.parameters["filter_time"] for r in gains)


def test_a_gain_that_a_model_was_given_may_be_greater():
    def law(t, x, v, a):
        return amplified(0.02, 0.41)(t, x, v, a) + 1500.0 * v * np.abs(v)

    given = FittedTerm("sensor-gain", 0.41, {"filter_time": 0.02})
    plain = FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0)
    found = close_gap(campaign(law), ForceModel((*plain, given)))
    assert found.rounds[0].effect == "quadratic-damping"
