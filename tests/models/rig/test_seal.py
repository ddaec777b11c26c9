from dataclasses import replace

import numpy as np
import pytest

from models.checks import InputError
from models.rig import random_device
from models.rig.reversal_laws import LAWS
from models.rig.seal import Seal, draw_seal, presliding_friction, smooth_friction


def loop(amplitude, frequency, samples=8192):
    angle = 2 * np.pi * np.arange(samples) / samples
    omega = 2 * np.pi * frequency
    return amplitude * np.sin(angle), amplitude * omega * np.cos(angle)


def work(x, force):
    """Closed loop integral of F dx by the trapezoidal rule."""
    steps = np.roll(x, -1) - x
    return float(np.sum(0.5 * (force + np.roll(force, -1)) * steps))


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_smooth_law_is_odd_saturates_and_is_half_at_its_half_speed(law):
    seal = Seal(sliding=300.0, half_speed=1e-3, reversal=law)
    v = np.array([1e-3, 1e3])
    np.testing.assert_array_equal(smooth_friction(seal, -v), -smooth_friction(seal, v))
    assert smooth_friction(seal, v)[0] == pytest.approx(150.0, rel=1e-9)
    assert smooth_friction(seal, v)[1] == pytest.approx(300.0, rel=1e-5)


def test_a_device_keeps_its_seals_and_another_has_others():
    devices = [random_device(np.random.default_rng([2, i])) for i in range(40)]
    seals = [draw_seal(device) for device in devices]
    assert seals == [draw_seal(replace(d, turns=3.0, coulomb_friction=1.0)) for d in devices]
    assert {seal.reversal for seal in seals} == set(LAWS)
    assert len({seal.half_speed for seal in seals}) == 40
    assert all(0.8e-4 <= seal.half_speed <= 1.6e-4 for seal in seals)
    assert draw_seal(devices[0], stream=1).half_speed != seals[0].half_speed


def test_work_of_a_cycle_tends_to_coulombs():
    x, v = loop(0.01, 1.0)
    seal = Seal(sliding=300.0, breakaway=1.0, presliding=1e-6)
    assert work(x, presliding_friction(x, v, seal=seal)) == pytest.approx(12.0, rel=1e-3)


def test_small_motion_meets_a_spring():
    x, v = loop(1e-8, 1.0)
    seal = Seal(sliding=300.0, breakaway=1.0, presliding=1e-4)
    force = presliding_friction(x, v, seal=seal)
    stiffness = np.ptp(force) / np.ptp(x)
    assert stiffness == pytest.approx(300.0 / 1e-4, rel=1e-3)


def test_presliding_without_a_fall_does_not_know_the_rate():
    seal = Seal(sliding=300.0, breakaway=1.0)
    slow, fast = (presliding_friction(*loop(0.001, f), seal=seal) for f in (0.01, 10.0))
    np.testing.assert_allclose(slow, fast, rtol=1e-12)


def test_friction_falls_with_speed_from_breakaway_to_sliding():
    seal = Seal(sliding=300.0, breakaway=1.4, stribeck_speed=0.01)
    slow = presliding_friction(*loop(0.01, 1e-4), seal=seal)
    fast = presliding_friction(*loop(0.01, 50.0), seal=seal)
    assert np.max(slow) == pytest.approx(420.0, rel=1e-3)
    assert fast[0] == pytest.approx(300.0, rel=1e-3)


def test_impossible_seals_are_refused():
    with pytest.raises(InputError, match="seal: breakaway"):
        Seal(sliding=1.0, breakaway=0.9)
    with pytest.raises(InputError, match="seal: presliding"):
        Seal(sliding=1.0, presliding=0.0)
