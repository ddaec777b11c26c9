import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from models.checks import InputError
from models.device import Device
from models.flow import (
    channel_impedance,
    effective_order,
    excess_impedance,
    normalised_impedance,
    wall_modes,
    womersley_number,
)

TWELVE = Device.preset("device-12")


def exact(womersley, part="total"):
    """z^2/(1 - 2 J1/(s J0)) with s = i^(3/2) Wo, as Womersley wrote it, in 60 digits."""
    with mpmath.workdps(60):
        s = mpmath.mpf(womersley) * mpmath.exp(mpmath.mpc(0, 0.75) * mpmath.pi)
        plug = mpmath.mpc(0, 1) * mpmath.mpf(womersley) ** 2
        bracket = 1 - 2 * mpmath.besselj(1, s) / (s * mpmath.besselj(0, s))
        total = plug / bracket
        return complex({"total": total, "wall": total - plug - 8, "excess": total - 8}[part])


@pytest.mark.parametrize("part", ["total", "wall", "excess"])
@pytest.mark.parametrize("wo", [1e-6, 1e-2, 0.5, 3.0, 12.0, 60.0])
def test_against_womersleys_formula_in_sixty_digits(wo, part):
    expected = exact(wo, part)
    found = complex(normalised_impedance(wo, part=part))
    assert abs(found - expected) <= 1e-12 * abs(expected)


def test_low_limit_is_poiseuille_with_four_thirds_of_the_mass():
    wo = 1e-3
    value = complex(normalised_impedance(wo))
    assert value.real == pytest.approx(8.0, rel=1e-6)
    assert value.imag == pytest.approx(4.0 / 3.0 * wo**2, rel=1e-6)


@pytest.mark.parametrize("wo", [1e4, 1e6, 1e9, 1e120])
def test_high_limit_is_plug_with_stokes_layer(wo):
    wall = complex(normalised_impedance(wo, part="wall"))
    # 2 z I3/I2 = 2 z - 5 + 15/(4 z) + ...
    z = wo * np.exp(0.25j * math.pi)
    assert abs(wall - (2.0 * z - 5.0 + 3.75 / z)) <= 1e-9 * abs(wall)
    assert complex(normalised_impedance(wo)).imag == pytest.approx(wo**2, rel=3.0 / wo + 1e-6)


def test_no_seam_where_the_series_takes_over():
    wo = 1e4 * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    wall = normalised_impedance(wo, part="wall")
    assert abs(wall[1] / wall[0] - 1.0) < 1e-8
    for part in ("total", "drag"):
        order = effective_order(wo, by="amplitude", part=part)
        assert order[0] == pytest.approx(order[1], abs=1e-7)


@pytest.mark.parametrize("by", ["phase", "amplitude"])
def test_effective_order_tends_to_one_and_two(by):
    low, high = effective_order([1e-4, 1e7], by=by)
    assert low == pytest.approx(1.0, abs=1e-6)
    assert high == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize("by", ["phase", "amplitude"])
def test_order_of_the_drag_tends_to_one_and_three_halves(by):
    low, high = effective_order([1e-4, 1e7], by=by, part="drag")
    assert low == pytest.approx(1.0, abs=1e-6)
    assert high == pytest.approx(1.5, abs=1e-6)


@pytest.mark.parametrize("part", ["total", "drag"])
def test_order_by_amplitude_is_the_slope_of_the_force(part):
    for wo in (0.3, 2.0, 8.0, 50.0):
        with mpmath.workdps(40):

            def size(log_omega, wo=wo):
                w = mpmath.mpf(wo) * mpmath.exp(log_omega / 2)
                z = w * mpmath.exp(mpmath.mpc(0, 0.25) * mpmath.pi)
                wall = 2 * z * mpmath.besseli(3, z) / mpmath.besseli(2, z)
                plug = z**2 if part == "total" else 0
                return mpmath.log(abs(8 + plug + wall)) + log_omega

            slope = float(mpmath.diff(size, 0))
        assert effective_order(wo, by="amplitude", part=part) == pytest.approx(slope, abs=1e-9)


def test_order_by_phase_stays_between_one_and_two_and_rises():
    order = effective_order(np.geomspace(1e-3, 1e5, 200))
    assert np.all((order >= 1.0) & (order <= 2.0))
    assert np.all(np.diff(order) > 0.0)


def test_womersley_number_of_device_12():
    expected = 0.005 * math.sqrt(2 * math.pi * 3.0 * 800.0 / 0.027)
    assert womersley_number(TWELVE, 3.0) == pytest.approx(expected, rel=1e-13)


def test_device_impedance_is_passive_conjugate_and_starts_at_poiseuille():
    omega = np.linspace(-300.0, 300.0, 61)
    value = channel_impedance(TWELVE, omega)
    np.testing.assert_allclose(value, np.conj(value[::-1]), rtol=1e-14)
    assert np.all(value.real > 0.0)
    assert value[30] == pytest.approx(TWELVE.laminar_coefficients.c2, rel=1e-12)
    rest = value - TWELVE.laminar_coefficients.c2
    np.testing.assert_allclose(excess_impedance(TWELVE, omega), rest, atol=1e-6)


def test_plug_part_is_the_inertance_of_a_flat_helix():
    flat = replace(TWELVE, helix_pitch=0.01, transition_length=0.0)
    slope = flat.helix_pitch / (2 * math.pi * flat.helix_radius)
    plug = complex(channel_impedance(flat, 7.0, part="plug"))
    assert plug.imag == pytest.approx(7.0 * flat.computed_inertance * (1 + slope**2), rel=1e-12)
    assert plug.real == 0.0


def test_modes_are_the_wall_impedance():
    modes = wall_modes(TWELVE, count=64)
    omega = 2 * math.pi * np.array([0.1, 1.0, 15.0, 100.0])
    lags = 1j * omega[:, None] / (1j * omega[:, None] + modes.rates)
    found = modes.gain * lags.sum(axis=1) + 1j * omega * modes.remainder
    np.testing.assert_allclose(found, channel_impedance(TWELVE, omega, part="wall"), rtol=1e-3)


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="womersley must be >= 0"):
        normalised_impedance(-1.0)
    with pytest.raises(InputError, match="impedance: part"):
        normalised_impedance(1.0, part="all")
    with pytest.raises(InputError, match="effective order: by"):
        effective_order(1.0, by="eye")
