"""What changes from test to test of a campaign, or differs between them by how they were sampled.

Forces are closed formulas with what is hidden put on in the laboratory's own terms: oil that is
warmer in every test, an amplifier that warms up, a converter that takes its channels in turn.
"""

from dataclasses import replace

import numpy as np
import pytest

from discover.gap import close_gap
from discover.motion_fit import observe_all
from discover.naming.forces import model_force
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

MODEL = "fit:inertia,viscous-damping"


def each(change, *, seed=4):
    """Return the campaign with the force of every test, numbered from 1, changed."""
    plain = campaign(device, seed=seed)
    records = tuple(
        replace(r, force=change(number, r)) for number, r in enumerate(plain.records, start=1)
    )
    return replace(plain, records=records)


def test_oil_that_is_warmer_in_every_test_is_thermal_drift():
    order = np.random.default_rng(3).permutation(8)

    def thinner(number, r):
        omega = 2.0 * np.pi * r.frequency
        velocity = r.amplitude * omega * np.cos(omega * r.time)
        return r.force - 800.0 * (1.0 - np.exp(-0.04 * (number - 1))) * velocity

    plain = campaign(device, seed=4)
    mixed = replace(plain, records=tuple(plain.records[i] for i in order))
    records = tuple(replace(r, force=thinner(n, r)) for n, r in enumerate(mixed.records, start=1))
    found = close_gap(replace(mixed, records=records), MODEL)
    assert [r.effect for r in found.rounds] == ["thermal-drift"]
    assert found.rounds[0].probability > 0.9
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_a_gain_that_grows_with_every_test_is_named_as_one():
    found = close_gap(each(lambda number, r: (1.0 + 0.02 * (number - 1)) * r.force), MODEL)
    (only,) = found.rounds
    assert only.effect == "sensor-gain"
    assert only.coefficient == pytest.approx(0.14, abs=0.01)
    assert only.parameters["over"] == 7.0
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_an_amplifier_that_warms_up_in_every_test_is_a_sensor_s_gain():
    def warming(_, r):
        return (1.0 - 0.1 * np.exp(-r.time / (0.3 * r.time[-1] ** 0.5))) * r.force

    found = close_gap(each(warming), MODEL)
    assert found.rounds[0].effect == "sensor-gain"
    assert found.rounds[0].parameters["settling_time"] > 0.0
    assert found.final_held_out_gap_percent < 0.5 * found.gap_percent


def test_a_zero_that_moves_between_tests_is_the_sensor_s():
    found = close_gap(each(lambda number, r: r.force + 4.0 * (number - 1)), MODEL)
    assert [r.effect for r in found.rounds] == ["sensor-drift"]
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_a_zero_that_is_another_one_in_every_test_is_the_sensor_s_and_predicts_no_other_test():
    zeros = 12.0 * np.random.default_rng(2).standard_normal(8)
    found = close_gap(each(lambda number, r: r.force + zeros[number - 1]), MODEL)
    assert [r.effect for r in found.rounds] == ["sensor-drift"]
    stated = [t.fitted.coefficient for t in found.mended if t.fitted.id == "sensor-drift"]
    np.testing.assert_allclose(stated, zeros, atol=1.0)
    assert found.final_gap_percent < 1.1 * found.noise_percent
    assert found.final_held_out_gap_percent > 3.0 * found.noise_percent
    (warning,) = [f.text for f in found.findings if f.level == "warning"]
    assert "zero the channel before each test" in warning


@pytest.mark.parametrize("model", [MODEL, MODEL + ",force-offset"])
def test_zeros_of_their_own_about_a_common_one_are_still_each_its_own(model):
    zeros = 20.0 + 12.0 * np.random.default_rng(2).standard_normal(8)
    found = close_gap(each(lambda number, r: r.force + zeros[number - 1]), model)
    assert [r.effect for r in found.rounds] == ["sensor-drift"]
    assert found.final_gap_percent < 1.1 * found.noise_percent


def test_one_delay_in_samples_that_fits_nearly_is_kept_as_it_predicts_other_tests():
    rng = np.random.default_rng(4)

    def shifted(_, r):
        omega = 2.0 * np.pi * r.frequency
        late = 3.0 * r.step * (1.0 + 0.02 * rng.standard_normal())
        then = omega * (r.time - late)
        force = r.amplitude * omega * (800.0 * np.cos(then) - 120.0 * omega * np.sin(then))
        return force + 0.01 * np.sqrt(np.mean(force**2)) * rng.standard_normal(then.size)

    found = close_gap(each(shifted), MODEL)
    assert found.rounds[0].effect == "time-delay"
    assert found.rounds[0].parameters["sampling"] > 0.0
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_a_stop_pushes_at_one_end_and_is_not_named_for_what_pulls_at_the_other():
    def law(t, x, v, a):
        upper, lower = np.maximum(x - 0.008, 0.0), np.maximum(-0.01 - x, 0.0)
        return device(t, x, v, a) + 2e4 * upper + 1.2e4 * lower

    found = close_gap(campaign(law), MODEL)
    stops = [t.fitted for t in found.mended if t.fitted.id == "end-stop"]
    assert all(t.coefficient > 0.0 for t in stops)


def test_one_slope_in_all_tests_is_one_number():
    found = close_gap(each(lambda _, r: r.force + 3.0 * r.time), MODEL)
    (slope,) = [t.fitted for t in found.mended if t.fitted.id == "sensor-drift"]
    assert slope.coefficient == pytest.approx(3.0, rel=0.05)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


def test_a_law_that_no_formula_follows_is_still_one_law_for_all_tests():
    """The zero creeps by a logarithm of time: it predicts other tests, which own values can't."""
    found = close_gap(each(lambda _, r: r.force + 9.0 * np.log1p(r.time / 0.2)), MODEL)
    assert found.rounds[0].effect == "sensor-drift"
    assert not any(t.fitted.shape.get("only", 0.0) for t in found.mended)
    assert found.final_held_out_gap_percent < 0.2 * found.held_out_gap_percent


def test_seals_whose_friction_falls_as_they_warm_are_thermal_drift():
    def rubbing(_, r):
        omega = 2.0 * np.pi * r.frequency
        velocity = r.amplitude * omega * np.cos(omega * r.time)
        return r.force + 15.0 * (1.0 + np.exp(-r.time / 3.0)) * np.tanh(velocity / 3e-4)

    found = close_gap(each(rubbing), MODEL + ",coulomb-friction")
    assert [r.effect for r in found.rounds] == ["thermal-drift"]
    assert found.rounds[0].parameters["power"] == 0.0
    assert found.rounds[0].unit == "N"
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_channels_that_are_some_samples_apart_are_late_by_more_at_a_lower_rate():
    """Sampling rates of this campaign are 125 to 1000 Hz: one delay in seconds leaves most."""
    plain = campaign(device, seed=5)
    records = tuple(
        replace(r, time=r.time[2:], force=r.force[:-2], displacement=r.displacement[2:])
        for r in plain.records
    )
    found = close_gap(replace(plain, records=records), MODEL)
    (only,) = found.rounds
    assert only.effect == "time-delay"
    assert only.parameters["sampling"] == pytest.approx(1000.0)
    assert only.coefficient == pytest.approx(2e-3, rel=0.01)
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_loggers_that_are_started_by_hand_are_late_by_another_time_in_every_test():
    """Force and displacement on two clocks: the force is measured at other times of the motion."""
    rng = np.random.default_rng(8)
    late = rng.uniform(0.0, 8e-3, 8)

    def shifted(number, r):
        omega = 2.0 * np.pi * r.frequency
        then = omega * (r.time - late[number - 1])
        force = r.amplitude * omega * (800.0 * np.cos(then) - 120.0 * omega * np.sin(then))
        return force + 0.01 * np.sqrt(np.mean(force**2)) * rng.standard_normal(then.size)

    found = close_gap(each(shifted), MODEL)
    assert [r.effect for r in found.rounds] == ["time-delay"]
    stated = [t.fitted.coefficient for t in found.mended if t.fitted.id == "time-delay"]
    np.testing.assert_allclose(stated, late, atol=1e-3)
    np.testing.assert_allclose(stated[-2:], late[-2:], atol=2e-5)
    assert found.final_gap_percent < 1.1 * found.noise_percent
    assert found.final_held_out_gap_percent > 3.0 * found.noise_percent
    assert any("one trigger" in f.text for f in found.findings)


def test_a_model_of_what_changes_has_its_value_in_each_test():
    observations = observe_all(campaign(device, noise=0.0).records, 1)
    plain = ForceModel((FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0)))
    shape = {"from_test": 2.0, "over": 7.0}
    gains = ForceModel((*plain.terms, FittedTerm("sensor-gain", 0.7, shape)))
    zeros = ForceModel((*plain.terms, FittedTerm("sensor-drift", 14.0, shape)))
    warming = FittedTerm("sensor-gain", 0.2, {"settling_time": 3.0})
    for o in observations:
        force = model_force(o, plain)
        step = 1e-5 * np.abs(force).max()  # between points of the steady cycle
        late = o.test - 1
        np.testing.assert_allclose(model_force(o, gains), (1.0 + 0.1 * late) * force, atol=step)
        np.testing.assert_allclose(model_force(o, zeros), force + 2.0 * late, atol=step)
        found = model_force(o, ForceModel((*plain.terms, warming)))
        elapsed = o.time - o.time[0]
        expected = (1.2 - 0.2 * np.exp(-elapsed / 3.0)) * force
        np.testing.assert_allclose(found, expected, atol=step)
