from dataclasses import replace

import numpy as np
import pytest

from models.checks import InputError
from models.device import Device
from models.flow import channel_force
from models.rig import RigPhysics, sine_point
from models.rig.drive import make_drive
from models.rig.physics import flow_law, flow_velocity, fluid_force, seal_force
from models.rig.seal import Seal

TWELVE = Device.preset("device-12")
TEN = Device.preset("device-10")
BARE = RigPhysics(friction="laminar", losses="none", wall=False, seal="none", compressibility=False)


def driven(frequency, amplitude=0.005, distortion=0.0, seed=0):
    rng = np.random.default_rng(seed)
    return make_drive(sine_point(frequency, amplitude), rng, distortion=distortion)


def line(values, harmonic=1):
    return np.fft.rfft(values)[harmonic] * 2 / values.size


def bessel_impedance(device, omega):
    """Womersley's own form in 40 digits: S1^2 l i w rho/(pi r^2)/(1 - 2 J1/(s J0))."""
    import mpmath

    with mpmath.workdps(40):
        rho, mu = device.fluid.density, device.fluid.viscosity
        r = mpmath.mpf(device.channel_radius)
        s = r * mpmath.sqrt(omega * rho / mu) * mpmath.exp(mpmath.mpc(0, 0.75) * mpmath.pi)
        bracket = 1 - 2 * mpmath.besselj(1, s) / (s * mpmath.besselj(0, s))
        line_ = mpmath.mpc(0, omega) * rho / (mpmath.pi * r**2) / bracket
        return complex(device.annulus_area**2 * device.channel_length * line_)


def test_simple_physics_is_equation_5():
    drive = driven(2.0, 0.01, distortion=0.01)
    # Seals that reach their limit at a finite speed: others approach Eq. 5's jump more slowly.
    physics = replace(RigPhysics.simple(), seal_values=Seal(sliding=0.0))
    law = flow_law(TWELVE, physics, top=1.0)
    c1 = 3 * 800.0 * TWELVE.annulus_area**3 / (4 * TWELVE.channel_area**2)
    c2 = 8 * 0.027 * TWELVE.channel_length * TWELVE.annulus_area**2
    c2 /= TWELVE.channel_radius**2 * TWELVE.channel_area
    v = drive.velocity
    expected = 370.38251222729 * drive.acceleration + c2 * v + c1 * v * np.abs(v)
    scale = np.max(np.abs(expected))
    np.testing.assert_allclose(fluid_force(law, drive), expected, atol=1e-6 * scale)
    away = np.abs(v) > 0.01
    np.testing.assert_allclose(seal_force(law, drive)[away], 400.0 * np.sign(v[away]), rtol=1e-3)


@pytest.mark.parametrize("frequency", [0.1, 1.0, 15.0])
def test_laminar_flow_has_the_exact_oscillatory_impedance_once(frequency):
    # No transitions and hardly any pitch: inertance is exactly the plug's.
    device = replace(TWELVE, transition_length=0.0, helix_pitch=0.01)
    drive = driven(frequency)
    law = flow_law(device, replace(BARE, wall=True), top=1.0)
    impedance = line(fluid_force(law, drive)) / line(drive.velocity)
    assert impedance == pytest.approx(bessel_impedance(device, 2 * np.pi * frequency), rel=1e-3)


def test_correlations_exceed_poiseuille_and_are_those_of_the_flow_layer():
    law = flow_law(TWELVE, replace(BARE, friction="correlations"), top=0.5)
    speed = np.array([-0.4, 0.013, 0.4])
    np.testing.assert_allclose(law.drag(speed), channel_force(TWELVE, speed), rtol=1e-5)
    assert law.drag(speed)[2] > 1.5 * TWELVE.laminar_coefficients.c2 * 0.4


def test_turbulent_channel_grows_with_a_power_between_blasius_and_quadratic():
    law = flow_law(TEN, RigPhysics(losses="none", compressibility=False), top=0.5)
    low, high = law.drag(np.array([0.3, 0.45]))
    assert 1.6 < np.log(high / low) / np.log(1.5) < 2.0


def test_losses_grow_beyond_the_textbook_at_creep_only():
    two, book, none = (
        flow_law(TWELVE, replace(BARE, losses=kind), top=1.0).drag(np.array([1e-3, 1.0]))
        for kind in ("two-k", "textbook", "none")
    )
    ratio = (two - none) / (book - none)
    assert ratio[0] > 5.0
    assert ratio[1] == pytest.approx(1.57 / 1.5, rel=0.03)


def test_yielding_oil_is_a_spring_in_series():
    # Linear device: F = Z v/(1 + Z i w/k).
    physics = replace(BARE, wall=True, compressibility=True)
    device = replace(TWELVE, transition_length=0.0, helix_pitch=0.01)
    law = flow_law(device, physics, top=1.0)
    drive = driven(12.0)
    omega = 2 * np.pi * 12.0
    stiff = bessel_impedance(device, omega)
    expected = stiff / (1 + 1j * omega * stiff / law.oil_stiffness)
    found = line(fluid_force(law, drive)) / line(drive.velocity)
    assert found == pytest.approx(expected, rel=1e-3)
    assert abs(expected / stiff) > 1.02


def test_stiffer_oil_tends_to_none_with_first_order():
    drive = driven(10.0)
    stiff = fluid_force(flow_law(TWELVE, RigPhysics(compressibility=False), top=1.0), drive)
    errors = []
    for modulus in (1e11, 2e11):
        law = flow_law(TWELVE, RigPhysics(bulk_modulus=modulus), top=1.0)
        errors.append(np.max(np.abs(fluid_force(law, drive) - stiff)))
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.05)


def test_harmonic_balance_leaves_no_residual_in_nonlinear_flow():
    physics = RigPhysics(wall=False, bulk_modulus=2e8)
    law = flow_law(TEN, physics, top=1.0)
    drive = driven(12.0)
    v = flow_velocity(law, drive)
    rate = 1j * drive.omega
    spring = np.fft.rfft(drive.velocity - v)[1:] * law.oil_stiffness / rate[1:]
    flow = np.fft.rfft(v)[1:] * rate[1:] * TEN.inertance + np.fft.rfft(law.drag(v))[1:]
    assert np.max(np.abs(spring - flow)) < 1e-6 * np.max(np.abs(flow))
    assert np.max(np.abs(v - drive.velocity)) > 1e-3 * np.max(np.abs(v))


@pytest.mark.parametrize("device", [TWELVE, TEN], ids=["12", "10"])
@pytest.mark.parametrize("physics", [RigPhysics(), RigPhysics.simple()], ids=["full", "simple"])
@pytest.mark.parametrize("frequency", [0.1, 10.0])
def test_the_device_only_takes_energy(device, physics, frequency):
    law = flow_law(device, physics, top=1.0)
    drive = driven(frequency, distortion=0.01)
    assert np.mean(fluid_force(law, drive) * drive.velocity) > 0.0
    assert np.mean(seal_force(law, drive) * drive.velocity) > 0.0


def test_dry_friction_is_the_devices_or_the_given_or_none():
    def sliding(**values):
        return flow_law(TWELVE, RigPhysics(**values), top=1.0).seal.sliding

    assert sliding() == 400.0
    assert sliding(dry_friction=20.0) == 20.0
    assert sliding(seal="none", dry_friction=20.0) == 0.0


def test_unknown_parts_are_refused():
    with pytest.raises(InputError, match="rig physics: friction must be one of"):
        RigPhysics(friction="rough")
    with pytest.raises(InputError, match="bulk_modulus"):
        RigPhysics(bulk_modulus=0.0)
