from dataclasses import replace

import numpy as np
import pytest

from models.device import Device
from models.flow import channel_impedance
from models.rig import RigPhysics, TestPoint, sine_point
from models.rig.drive import make_drive
from models.rig.physics import flow_law, fluid_force, seal_force
from models.rig.reversal_laws import LAWS
from models.rig.seal import Seal
from models.rig.stepping import Element, transmitted_force

TWELVE = Device.preset("device-12")
LINEAR = RigPhysics(
    friction="laminar", losses="none", wall=True, seal="none", compressibility=False
)
STRETCH = np.array([-1.0, 1.0])


def driven(frequency, amplitude=0.005):
    rng = np.random.default_rng(0)
    return make_drive(sine_point(frequency, amplitude), rng, distortion=0.0)


def line(values, harmonic=1):
    return np.fft.rfft(values)[harmonic] * 2 / values.size


def linear_impedance(omega):
    wall = channel_impedance(TWELVE, omega, part="wall")
    return 1j * omega * TWELVE.inertance + wall + TWELVE.laminar_coefficients.c2


@pytest.mark.parametrize("frequency", [1.0, 12.0])
def test_spring_and_damper_in_series_with_a_linear_device(frequency):
    law = flow_law(TWELVE, LINEAR, top=1.0)
    drive = driven(frequency)
    k, d = 2e7, 2e4
    force = transmitted_force(law, drive, Element(STRETCH, k * STRETCH, d))
    omega = 2 * np.pi * frequency
    device, mount = linear_impedance(omega), k / (1j * omega) + d
    expected = device * mount / (device + mount)
    assert line(force) / line(drive.velocity) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize(
    "physics",
    [
        RigPhysics(compressibility=False),
        *(
            replace(RigPhysics.simple(), seal_values=Seal(sliding=0.0, reversal=law))
            for law in LAWS
        ),
    ],
)
def test_stiff_element_changes_nothing(physics):
    law = flow_law(TWELVE, physics, top=1.0)
    drive = driven(4.0, 0.01)
    stiff = fluid_force(law, drive) + seal_force(law, drive)
    omega = 2 * np.pi * 2000.0
    k = TWELVE.inertance * omega**2
    damper = 2 * 0.7 * TWELVE.inertance * omega
    force = transmitted_force(law, drive, Element(STRETCH, k * STRETCH, damper))
    rms = np.sqrt(np.mean(stiff**2))
    assert np.sqrt(np.mean((force - stiff) ** 2)) < 0.015 * rms


def test_play_transmits_nothing_while_it_is_crossed():
    law = flow_law(TWELVE, RigPhysics.simple(), top=1.0)
    drive = driven(4.0, 0.01)
    gap = 4e-4
    omega = 2 * np.pi * 300.0
    k = TWELVE.inertance * omega**2
    corners = np.array([-gap / 2 - 1.0, -gap / 2, gap / 2, gap / 2 + 1.0])
    element = Element(corners, k * np.array([-1.0, 0, 0, 1.0]), TWELVE.inertance * omega)
    force = transmitted_force(law, drive, element)
    rms = np.sqrt(np.mean(force**2))
    idle = np.abs(force) < 1e-9 * rms
    assert 0.005 < np.mean(idle) < 0.5
    doubled = Element(2 * corners, k * np.array([-1.0, 0, 0, 1.0]) * 2, element.damping)
    wider = transmitted_force(law, drive, doubled)
    assert np.mean(np.abs(wider) < 1e-9 * rms) > np.mean(idle)


def test_seals_before_the_element_are_left_out():
    law = flow_law(TWELVE, RigPhysics.simple(), top=1.0)
    drive = driven(2.0, 0.01)
    k = TWELVE.inertance * (2 * np.pi * 500.0) ** 2
    element = Element(STRETCH, k * STRETCH, 0.5 * k / (2 * np.pi * 500.0))
    force = transmitted_force(law, drive, element, seal_behind=False)
    fluid = fluid_force(law, drive)
    assert np.max(np.abs(force - fluid)) < 0.01 * np.max(np.abs(fluid))


def test_finer_grid_gives_the_same_force():
    # The same motion on half the grid: the change is of the order of the step.
    law = flow_law(TWELVE, RigPhysics.simple(), top=1.0)
    fine = driven(6.0)
    coarse = replace(
        fine,
        position=fine.position[::2],
        velocity=fine.velocity[::2],
        acceleration=fine.acceleration[::2],
    )
    element = Element(STRETCH, 3e7 * STRETCH, 5e4)
    one = transmitted_force(law, fine, element)[::2]
    two = transmitted_force(law, coarse, element)
    assert np.sqrt(np.mean((one - two) ** 2)) < 0.02 * np.sqrt(np.mean(one**2))


def test_transients_are_marched_once_from_rest():
    law = flow_law(TWELVE, RigPhysics.simple(), top=1.0)
    point = TestPoint(1.0, 0.005, cycles=4, sampling=200.0, kind="sweep", upper=4.0)
    drive = make_drive(point, np.random.default_rng(0))
    k = TWELVE.inertance * (2 * np.pi * 300.0) ** 2
    element = Element(STRETCH, k * STRETCH, 0.7 * k / (2 * np.pi * 300.0))
    force = transmitted_force(law, drive, element, seal_behind=False)
    fluid = fluid_force(law, drive)
    assert np.sqrt(np.mean((force - fluid) ** 2)) < 0.01 * np.sqrt(np.mean(fluid**2))
