"""Identification: both methods meet at one optimum, and the products are what was put in."""

import math

import numpy as np
import pytest

from discover.identification import (
    INERTIAL,
    ULTRA_LOW,
    Trial,
    identify_by_evolution,
    identify_by_projection,
)
from models.checks import InputError
from models.device import Device
from models.motion import sine_motion

TWELVE = Device.preset("device-12")


def womersley_free_force(frequency, amplitude, *, seed=None, noise=0.0):
    """Force of mass, quadratic and linear damping and friction, written out here."""
    motion = sine_motion(amplitude, frequency, samples=400)
    v, a = motion.velocity, motion.acceleration
    force = 365.0 * a + 820.0 * v * np.abs(v) + 5100.0 * v + 400.0 * np.sign(v)
    if noise:
        rng = np.random.default_rng(seed)
        force = force + noise * np.abs(force).max() * rng.standard_normal(force.size)
    return Trial(motion, force)


def fractional_trial(order, product, frequency, amplitude):
    """D^order of a sine written out by Eq. 4, without the package's operators."""
    motion = sine_motion(amplitude, frequency, samples=300)
    omega = 2 * math.pi * frequency
    force = product * amplitude * omega**order * np.sin(omega * motion.time + order * math.pi / 2)
    return Trial(motion, force + 400.0 * np.sign(motion.velocity))


CASES = [
    pytest.param([womersley_free_force(12.0, 0.005)], INERTIAL, id="12 Hz, as M2"),
    pytest.param([womersley_free_force(0.5, 0.02, seed=3, noise=0.05)], ULTRA_LOW, id="0.5 Hz"),
    pytest.param(
        [womersley_free_force(f, 0.005, seed=5, noise=0.02) for f in (3.0, 8.0, 15.0)],
        INERTIAL,
        id="three records with noise",
    ),
]


@pytest.mark.parametrize(("trials", "bounds"), CASES)
def test_projection_meets_the_evolution_with_a_fiftieth_of_the_evaluations(trials, bounds):
    by_evolution = identify_by_evolution(trials, TWELVE, order_bounds=bounds)
    by_projection = identify_by_projection(trials, TWELVE, order_bounds=bounds)
    assert by_projection.objective == pytest.approx(by_evolution.objective, rel=1e-6)
    assert by_projection.order == pytest.approx(by_evolution.order, rel=1e-6)
    assert by_projection.product == pytest.approx(by_evolution.product, rel=1e-6)
    assert by_evolution.evaluations >= 50 * by_projection.evaluations


@pytest.mark.parametrize(("order", "product"), [(1.89, 581.5), (1.98, 700.0), (1.62, 2000.0)])
def test_exact_records_give_their_parameters_back(order, product):
    found = identify_by_projection([fractional_trial(order, product, 6.0, 0.005)], TWELVE)
    assert found.order == pytest.approx(order, abs=1e-7)
    assert found.product == pytest.approx(product, rel=1e-6)
    assert found.error_percent < 1e-5


def test_optimum_at_a_bound_is_found_there():
    trial = fractional_trial(1.2, 900.0, 6.0, 0.005)
    found = identify_by_projection([trial], TWELVE, order_bounds=INERTIAL)
    assert found.order == 1.5
    by_evolution = identify_by_evolution([trial], TWELVE, order_bounds=INERTIAL)
    assert by_evolution.order == pytest.approx(1.5, rel=1e-6)
    assert found.objective == pytest.approx(by_evolution.objective, rel=1e-6)


def test_product_at_its_bound_is_the_constrained_optimum():
    # A force so small that b0 would have to be negative.
    trial = fractional_trial(1.9, 200.0, 6.0, 0.005)
    found = identify_by_projection([trial], TWELVE)
    by_evolution = identify_by_evolution([trial], TWELVE)
    assert found.b0 == 0.0
    assert found.objective == pytest.approx(by_evolution.objective, rel=1e-6)


def test_without_a_device_only_the_product_is_identified():
    trial = fractional_trial(1.89, 581.5, 6.0, 0.005)
    alone = identify_by_projection([trial], friction=400.0)
    assert alone.b0 is None and alone.inertance_source is None
    with_device = identify_by_projection([trial], TWELVE)
    assert alone.product == pytest.approx(with_device.product, rel=1e-7)
    other = Device.from_dict({"preset": "device-12", "inertance": 2.0 * TWELVE.inertance})
    doubled = identify_by_projection([trial], other, b0_bounds=(-0.9, 30.0))
    assert doubled.product == pytest.approx(with_device.product, rel=1e-7)
    assert 1.0 + doubled.b0 == pytest.approx(0.5 * (1.0 + with_device.b0), rel=1e-7)
    assert doubled.inertance_source == "measured"


def test_order_of_a_single_record_is_that_of_its_phase():
    # At one frequency D^order is a mixture of v and a: any linear device has an "order".
    motion = sine_motion(0.005, 4.0)
    mass, damping, omega = 370.0, 6000.0, 2 * math.pi * 4.0
    trial = Trial(motion, mass * motion.acceleration + damping * motion.velocity)
    found = identify_by_projection([trial], friction=0.0, order_bounds=(1.0, 2.0))
    expected = 1.0 + 2.0 / math.pi * math.atan(omega * mass / damping)
    assert found.order == pytest.approx(expected, abs=1e-7)
    assert found.error_percent < 1e-5


def test_scaling_force_and_friction_scales_the_product():
    trial = womersley_free_force(8.0, 0.005)
    once = identify_by_projection([trial], friction=400.0)
    thrice = identify_by_projection([Trial(trial.motion, 3.0 * trial.force)], friction=1200.0)
    assert thrice.order == pytest.approx(once.order, abs=1e-7)
    assert thrice.product == pytest.approx(3.0 * once.product, rel=1e-6)
    assert thrice.error_percent == pytest.approx(once.error_percent, rel=1e-9)


def test_bad_input_is_named():
    trial = fractional_trial(1.89, 581.5, 6.0, 0.005)
    with pytest.raises(InputError, match="trials must be at least one"):
        identify_by_projection([], TWELVE)
    with pytest.raises(InputError, match="upper bound of the order"):
        identify_by_projection([trial], TWELVE, order_bounds=(1.5, 1.2))
    with pytest.raises(InputError, match="friction must be given"):
        identify_by_projection([trial])
    with pytest.raises(InputError, match=r"force must be of shape \(300,\)"):
        Trial(trial.motion, trial.force[:-1])
