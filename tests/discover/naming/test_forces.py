"""A model's force on a record: which test it is, and samples that a late channel needs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.gap import close_gap
from discover.motion_fit import observe, observe_all
from discover.naming.forces import model_force, of_test
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

MODEL = ForceModel((FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0)))


def with_term(name, value, **shape):
    return ForceModel((*MODEL.terms, FittedTerm(name, value, shape)))


@pytest.mark.parametrize("delay", [-0.0043, 0.0043])
@pytest.mark.parametrize("lost", [slice(-7, -3), slice(2, 5), slice(0, 0)])
def test_a_channel_aligned_by_a_spline_is_late_at_the_ends_too(delay, lost):
    """Also where samples are missing there: what is before or after the record is the motion's."""
    record = campaign(device, noise=0.0).records[0]
    kept = np.delete(np.arange(record.time.size), lost)
    shorter = replace(
        record, time=record.time[kept], force=record.force[kept],
        displacement=record.displacement[kept],
    )
    observation = observe(shorter)
    late = model_force(observation, with_term("time-delay", delay, resampled=3.0))
    omega = 2.0 * np.pi * record.frequency
    then = observation.time - delay
    exact = -120.0 * omega**2 * np.sin(omega * then) + 800.0 * omega * np.cos(omega * then)
    assert np.abs(late - record.amplitude * exact).max() < 0.003 * record.amplitude * omega * 1000.0


@pytest.mark.parametrize("delay", [2e-5, 0.02])
def test_a_low_pass_passes_a_sine_by_its_phasor_beside_a_zero_that_moves(delay):
    """Where it is too fast for the cycle's grid, and where it shows there."""
    record = campaign(device, noise=0.0).records[0]
    observation = observe(record)
    drift = FittedTerm("sensor-drift", 7.0, {"settling_time": 3.0})
    filtered = FittedTerm("time-delay", delay, {"filter_order": 2.0})
    found = model_force(observation, ForceModel((*MODEL.terms, drift, filtered)))
    omega = 2.0 * np.pi * record.frequency
    passed = 1.0 / (1.0 + 1j * omega * delay + 0.5 * (1j * omega * delay) ** 2)
    phasor = record.amplitude * (-120.0 * omega**2 + 800.0j * omega) * passed
    sine = np.imag(phasor * np.exp(1j * omega * observation.time))
    moved = -7.0 * np.expm1(-observation.time / 3.0)
    np.testing.assert_allclose(found, sine + moved, atol=1e-4 * np.abs(phasor))


@pytest.mark.parametrize(
    ("made", "passed"),
    [
        ({}, lambda s: np.exp(-s * 3e-3)),
        ({"filter_order": 1.0}, lambda s: 1.0 / (1.0 + s * 3e-3)),
        ({"resampled": 3.0}, lambda s: np.exp(-s * 3e-3)),
    ],
    ids=["late", "filtered", "aligned"],
)  # fmt: skip
def test_a_gain_behind_a_filter_reads_a_late_channel_by_both_phasors(made, passed):
    record = campaign(device, noise=0.0).records[0]
    observation = observe(record)
    late = FittedTerm("time-delay", 3e-3, made)
    gain = FittedTerm("sensor-gain", 0.2, {"filter_time": 8e-3})
    found = model_force(observation, ForceModel((*MODEL.terms, late, gain)))
    s = 2j * np.pi * record.frequency
    phasor = record.amplitude * (120.0 * s**2 + 800.0 * s) * passed(s)
    phasor *= 1.0 + 0.2 / (1.0 + s * 8e-3)
    exact = np.imag(phasor * np.exp(s * observation.time))
    np.testing.assert_allclose(found, exact, atol=1e-4 * np.abs(phasor))


@pytest.mark.parametrize(
    "made",
    [{"resampled": 1.0}, {"filter_order": 1.0, "digital": 1.0}, {"filter_order": 1.0}],
    ids=["aligned", "digital", "filtered"],
)
def test_impacts_are_resolved_behind_a_late_channel_whatever_was_asked_before(made):
    """What is remembered of a coarse cycle is not said of a fine one, nor the other way."""
    record = campaign(device, noise=0.0).records[0]
    play = {"gap": 1e-3, "contact": 200.0, "loss": 0.15, "inside": 0.0}
    late = 3e-3 if len(made) == 2 or "resampled" in made else 9.0 / 8192 / record.frequency
    terms = FittedTerm("backlash", 1.0, play), FittedTerm("time-delay", late, made)
    model = ForceModel((*MODEL.terms, *terms))
    fresh = {fine: model_force(observe(record), model, resolved=fine) for fine in (False, True)}
    assert np.abs(fresh[True] - fresh[False]).max() > 0.1
    for order in ((False, True), (True, False)):
        same = observe(record)
        for fine in order:
            np.testing.assert_array_equal(model_force(same, model, resolved=fine), fresh[fine])


@pytest.mark.parametrize("slow", [0.02, 0.08])
def test_a_slow_filter_rounds_the_jumps_of_an_aligned_channel(slow):
    record = campaign(device, noise=0.0).records[0]
    observation = observe(record)
    shape = {"transition_speed": 1e-3 * 2.0 * np.pi * record.frequency * record.amplitude}
    model = ForceModel(
        (
            FittedTerm("coulomb-friction", 50.0, shape),
            FittedTerm("time-delay", 3e-3, {"resampled": 1.0}),
            FittedTerm("sensor-gain", 0.2, {"filter_time": slow}),
        )
    )
    step = record.time[1] - record.time[0]
    long = step * np.arange(-4000, record.time.size)
    jumps = 50.0 * np.tanh(np.cos(2.0 * np.pi * record.frequency * long) / 1e-3)
    dense = np.linspace(long[0], long[-1], 40 * long.size)
    late = np.interp(dense - 3e-3, long, jumps)
    kept = np.exp(-(dense[1] - dense[0]) / slow)
    passed = np.interp(long, dense, lfilter([1.0 - kept], [1.0, -kept], late))
    exact = (np.interp(long - 3e-3, long, jumps) + 0.2 * passed)[4000:]
    exact = exact[np.searchsorted(record.time, observation.time - 0.5 * step)]
    found = model_force(observation, model)
    np.testing.assert_allclose(found, exact, atol=0.01 * 50.0)


@pytest.mark.parametrize("phase", [0.0, 0.3])
@pytest.mark.parametrize("delay", [3e-3, 6e-3, 8e-3])
def test_a_low_pass_rounds_friction_s_jumps_as_its_differential_equation_does(delay, phase):
    """Jumps far shorter than the samples and than the filter, which is within few samples.

    They lie on points of a cycle's grid, or between them.
    """
    record = campaign(device, noise=0.0).records[0]
    place = record.amplitude * np.sin(2.0 * np.pi * record.frequency * record.time + phase)
    observation = observe(replace(record, displacement=place))
    shape = {"transition_speed": 1e-3 * 2.0 * np.pi * record.frequency * record.amplitude}
    friction = FittedTerm("coulomb-friction", 50.0, shape)
    filtered = FittedTerm("time-delay", delay, {"filter_order": 1.0})
    found = model_force(observation, ForceModel((friction, filtered)))
    dense = np.linspace(0.0, 2.0, 2_000_001)  # cycles; in the second the filter has settled
    sign = np.tanh(np.cos(2.0 * np.pi * dense + phase) / 1e-3)
    kept = np.exp(-(dense[1] / record.frequency) / delay)
    passed = 50.0 * lfilter([1.0 - kept], [1.0, -kept], sign)
    exact = np.interp(1.0 + np.mod(observation.time * record.frequency, 1.0), dense, passed)
    np.testing.assert_allclose(found, exact, atol=0.02 * 50.0)


@pytest.mark.parametrize("delay", [1e-4, 4e-3])
def test_a_digital_low_pass_works_on_the_samples_that_came_before(delay):
    """Of a first order: y[n] = y[n-1] + k (x[n] + x[n-1] - 2 y[n-1]), k = step/(step + 2 delay)."""
    record = campaign(device, noise=0.0).records[0]
    observation = observe(record)
    shape = {"transition_speed": 1e-3 * 2.0 * np.pi * record.frequency * record.amplitude}
    friction = FittedTerm("coulomb-friction", 50.0, shape)
    filtered = FittedTerm("time-delay", delay, {"filter_order": 1.0, "digital": 1.0})
    found = model_force(observation, ForceModel((friction, filtered)))
    step = record.time[1] - record.time[0]
    long = step * np.arange(-500, record.time.size)
    jumps = 50.0 * np.tanh(np.cos(2.0 * np.pi * record.frequency * long) / 1e-3)
    passed, k = np.zeros_like(jumps), step / (step + 2.0 * delay)
    for n in range(1, jumps.size):
        passed[n] = passed[n - 1] + k * (jumps[n] + jumps[n - 1] - 2.0 * passed[n - 1])
    exact = passed[500:][np.searchsorted(record.time, observation.time - 0.5 * step)]
    np.testing.assert_allclose(found, exact, atol=1e-3 * 50.0)


def test_a_gain_is_there_from_its_test_on():
    observations = observe_all(campaign(device, noise=0.0).records, 1)
    assert [o.test for o in observations] == list(range(1, 9))
    model = with_term("sensor-gain", 0.2, from_test=4.0)
    for o in observations:
        gain = 1.2 if o.test >= 4 else 1.0
        plain = model_force(o, MODEL)
        step = 1e-5 * np.abs(plain).max()  # between points of the steady cycle
        np.testing.assert_allclose(model_force(o, model), gain * plain, atol=step)
    alone = observe(campaign(device).records[0])  # of no campaign: as after the change
    assert of_test(alone, model) is model


def test_a_gain_that_grows_from_test_to_test_counts_once_where_the_channel_is_late():
    growing = FittedTerm("sensor-gain", 0.2, {"from_test": 2.0, "over": 4.0})
    late = FittedTerm("time-delay", 2e-3)
    for o in observe_all(campaign(device, noise=0.0).records, 1):
        gain = 1.0 + 0.2 * min((o.test - 1) / 4.0, 1.0)
        plain = model_force(o, ForceModel((*MODEL.terms, late)))
        found = model_force(o, ForceModel((*MODEL.terms, growing, late)))
        np.testing.assert_allclose(found, gain * plain, atol=1e-5 * np.abs(plain).max())


def test_a_gain_that_changed_between_two_tests_is_named_with_the_test():
    plain = campaign(device, seed=4)
    records = tuple(
        replace(r, force=1.15 * r.force) if place >= 3 else r
        for place, r in enumerate(plain.records, start=1)
    )
    found = close_gap(replace(plain, records=records), "fit:inertia,viscous-damping")
    (only,) = found.rounds
    assert only.effect == "sensor-gain"
    assert found.to_dict()["rounds"][0]["parameters"]["from_test"] == 3.0
    assert only.coefficient == pytest.approx(0.15, abs=0.003)
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_what_is_remembered_of_a_cycle_is_not_said_of_another_model():
    """Forces with memory, one after the other on the same test, are those on a test of its own."""
    record = campaign(device, noise=0.0).records[0]
    same = observe(record)
    for size, reach, delay in ((50.0, 1e-4, 0.0), (90.0, 1e-4, 2e-3), (90.0, 3e-4, 2e-3)):
        springs = FittedTerm("hysteresis", size, {"yield_displacement": reach})
        late = ForceModel((*MODEL.terms, springs, FittedTerm("time-delay", delay)))
        np.testing.assert_array_equal(model_force(same, late), model_force(observe(record), late))
