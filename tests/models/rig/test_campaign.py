import numpy as np
import pytest

from models.checks import InputError
from models.device import Device
from models.rig import (
    Chain,
    Limits,
    Plan,
    RigPhysics,
    random_device,
    run,
    sine_plan,
    sine_point,
    transient_plan,
)

TWELVE = Device.preset("device-12")
PLAN = Plan((sine_point(0.5, 0.02), sine_point(4.0, 0.01, held_out=True)))


def test_the_seed_decides_everything():
    one, two, three = (run(TWELVE, PLAN, seed=s) for s in (1, 1, 2))
    for a, b, c in zip(one, two, three, strict=True):
        np.testing.assert_array_equal(a.force, b.force)
        np.testing.assert_array_equal(a.displacement, b.displacement)
        assert not np.array_equal(a.force, c.force)
        assert not np.array_equal(a.true_force, c.true_force)


def test_noise_and_chain_leave_the_truth_alone():
    loud = run(TWELVE, PLAN, seed=1, chain=Chain(noise=0.1))
    quiet = run(TWELVE, PLAN, seed=1, chain=Chain.ideal())
    for a, b in zip(loud, quiet, strict=True):
        np.testing.assert_array_equal(a.true_force, b.true_force)
        np.testing.assert_array_equal(b.force, b.true_force)
        np.testing.assert_array_equal(b.displacement, b.true_displacement)


def test_records_are_labelled():
    slow, fast = run(TWELVE, PLAN, seed=1)
    assert (slow.file, slow.frequency, slow.amplitude) == ("0.5hz-20mm.csv", 0.5, 0.02)
    assert (slow.held_out, fast.held_out) == (False, True)
    assert slow.time[0] == 0.0
    assert slow.time.size == slow.force.size == slow.true_force.size
    assert slow.time.size == round(PLAN.points[0].duration * PLAN.points[0].sampling)


def test_noise_is_of_each_record_or_of_the_campaign():
    quiet = {"hum": 0.0, "displacement_noise": 0.0, "bits": 0}
    own = run(TWELVE, PLAN, seed=1, chain=Chain(noise=0.01, **quiet))
    shared = run(TWELVE, PLAN, seed=1, chain=Chain(noise=0.01, reference="campaign", **quiet))
    for r in own:
        ratio = np.std(r.force - r.true_force) / np.sqrt(np.mean(r.true_force**2))
        assert ratio == pytest.approx(0.01, rel=0.15)
    sizes = [np.std(r.force - r.true_force) for r in shared]
    assert sizes[0] == pytest.approx(sizes[1], rel=0.15)


def test_delay_reaches_back_before_the_record():
    chain = Chain(noise=0.0, hum=0.0, displacement_noise=0.0, bits=0, delay=0.02)
    plain = run(TWELVE, PLAN, seed=1, chain=Chain.ideal())[1]
    late = run(TWELVE, PLAN, seed=1, chain=chain)[1]
    shift = round(0.02 * PLAN.points[1].sampling)
    scale = np.max(np.abs(plain.true_force))
    difference = late.force[shift:] - plain.force[:-shift]
    assert np.max(np.abs(difference)) < 1e-3 * scale
    # A sine test has always run: one period later the force before the record is the same.
    period = round(PLAN.points[1].sampling / 4.0)
    assert np.max(np.abs(late.force[:shift] - late.force[period : period + shift])) < 1e-3 * scale
    with pytest.raises(InputError, match="delay must be at most"):
        run(TWELVE, PLAN, seed=1, chain=Chain(delay=1.0))


@pytest.mark.parametrize("name", ["device-12", "device-10"])
def test_forces_stay_within_the_rigs_limit(name):
    device = Device.preset(name)
    limits = Limits()
    for record in run(device, sine_plan(device, limits=limits), seed=0):
        # The limit is kept with what distortion and yielding oil add to the estimate.
        assert np.max(np.abs(record.true_force)) < 1.1 * limits.force


def test_whole_campaign_has_about_36_records_of_useful_length():
    records = run(TWELVE, sine_plan(TWELVE, held_out=4), seed=0)
    assert 28 <= len(records) <= 36
    assert sum(r.held_out for r in records) == 4
    assert all(1000 <= r.time.size <= 12000 for r in records)
    assert len({r.file for r in records}) == len(records)


def test_transients_run_from_rest():
    plan = transient_plan(duration=10.0, sampling=500.0, band=(0.5, 5.0))
    sweep, random = run(TWELVE, plan, seed=1, chain=Chain.ideal())
    for r in (sweep, random):
        assert r.frequency is None
        assert r.amplitude is None
        assert abs(r.true_force[0]) < 1e-3 * np.max(np.abs(r.true_force))
    assert random.held_out


def test_every_effect_kind_works_on_transients():
    plan = transient_plan(duration=6.0, sampling=500.0, band=(0.5, 5.0))
    base = run(TWELVE, plan, seed=1, physics=RigPhysics.simple())
    for name in ("backlash", "cavitation", "time-delay", "hysteresis", "fractional-derivative"):
        hidden = run(TWELVE, plan, seed=1, physics=RigPhysics.simple(), hidden={name: 0.1})
        change = sum(
            np.sum((b.true_force - a.true_force) ** 2) for a, b in zip(base, hidden, strict=True)
        )
        total = sum(np.sum(a.true_force**2) for a in base)
        assert np.sqrt(change / total) == pytest.approx(0.1, rel=0.01), name


def test_force_scales_with_the_units_of_mass():
    # Density, viscosity and friction times three: every force is three times as large.
    from dataclasses import replace

    from models.device import Fluid

    physics = RigPhysics(compressibility=False)
    heavy = replace(TWELVE, fluid=Fluid(2400.0, 0.081), coulomb_friction=1200.0)
    for a, b in zip(
        run(TWELVE, PLAN, seed=1, physics=physics),
        run(heavy, PLAN, seed=1, physics=physics),
        strict=True,
    ):
        np.testing.assert_allclose(3.0 * a.true_force, b.true_force, rtol=1e-9, atol=1e-6)


def test_random_devices_can_be_tested():
    devices = [random_device(np.random.default_rng([1, i]), name=f"d{i}") for i in range(12)]
    assert len({d.inertance for d in devices}) == 12
    for device in devices:
        assert 40.0 < device.inertance < 800.0
        assert len(sine_plan(device)) >= 20
    again = random_device(np.random.default_rng([1, 3]), name="d3")
    assert again == devices[3]
