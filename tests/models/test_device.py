import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from models.checks import InputError
from models.device import PRESETS, Device, Fluid

TWELVE = Device.preset("device-12")
TEN = Device.preset("device-10")


def test_inertance_of_device_12_is_the_published_one():
    assert TWELVE.inertance == pytest.approx(370.38, abs=0.005)
    assert TWELVE.inertance_source == "computed"


def test_device_12_without_transitions():
    assert replace(TWELVE, transition_length=0.0).inertance == pytest.approx(362.15, abs=0.005)


def test_device_10_keeps_the_quoted_inertance_as_measured():
    assert TEN.inertance == 73.82
    assert TEN.inertance_source == "measured"
    assert TEN.computed_inertance == pytest.approx(67.93, abs=0.005)


def test_straight_channel_has_the_inertance_of_a_fluid_line():
    # A straight line of mass m geared by S1/S2: the slope factor must vanish, not the length.
    straight = replace(TWELVE, helix_radius=1e3, turns=1e-3, transition_length=0.0)
    mass = 800.0 * straight.channel_area * 2.0 * math.pi * 1e3 * 1e-3
    assert straight.computed_inertance == pytest.approx(mass * straight.area_ratio**2, rel=1e-9)


def test_laminar_coefficients_from_poiseuille_and_bernoulli():
    # Independent route: pressure drop in the pipe at u = v S1/S2, times the piston area.
    v = 0.2
    u = v * TWELVE.annulus_area / TWELVE.channel_area
    drop = 32.0 * 0.027 * TWELVE.channel_length * u / (2 * 0.005) ** 2
    c1, c2 = TWELVE.laminar_coefficients
    assert c2 * v == pytest.approx(drop * TWELVE.annulus_area, rel=1e-12)
    assert c1 * v**2 == pytest.approx(1.5 * 0.5 * 800.0 * u**2 * TWELVE.annulus_area, rel=1e-12)


def test_turbulent_coefficient_is_blasius_friction():
    v = 0.3
    u = v * TEN.area_ratio
    d, rho, mu = 0.012, 802.0, 0.00168
    blasius = 0.3164 * (rho * u * d / mu) ** -0.25
    drop = blasius * TEN.channel_length / d * 0.5 * rho * u**2
    c1, c2, c3 = TEN.turbulent_coefficients
    # 0.0664 is Blasius' 0.3164/2 over 2^1.25, rounded.
    assert c1 * v**1.75 == pytest.approx(drop * TEN.annulus_area, rel=2e-3)
    assert c2 == TEN.laminar_coefficients.c1
    assert c3 == pytest.approx(2 * math.pi * mu * 0.025 * (2 * 7 * 0.006) / 1e-4, rel=1e-12)


def test_no_film_without_clearance():
    assert TWELVE.turbulent_coefficients.c3 is None


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_table_round_trip(name):
    device = Device.preset(name)
    assert Device.from_dict(device.to_dict()) == device


def test_preset_with_values_beside_it():
    device = Device.from_dict({"preset": "device-10", "turns": 8, "fluid": {"viscosity": 0.01}})
    assert (device.turns, device.fluid.viscosity, device.fluid.density) == (8, 0.01, 802.0)


def test_null_inertance_gives_the_computed_one():
    device = Device.from_dict({"preset": "device-10", "inertance": None})
    assert device.inertance_source == "computed"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rod_radius": 0.03}, "rod_radius must be below the cylinder_radius"),
        ({"rod_radius": 0.028}, "rod_radius"),
        ({"helix_pitch": 0.009}, "helix_pitch must be at least the channel's diameter"),
        ({"channel_radius": 0.2, "helix_pitch": 1.0}, "channel_radius must be below"),
        ({"piston_clearance": 0.1}, "piston_clearance must be below the gap"),
        ({"transition_length": -0.1}, "transition_length"),
        ({"turns": 0}, "turns"),
        ({"turns": math.nan}, "turns"),
        ({"measured_inertance": -1.0}, "inertance"),
        ({"coulomb_friction": -1.0}, "coulomb_friction"),
    ],
)
def test_impossible_geometry_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(TWELVE, **change)


@pytest.mark.parametrize(("density", "viscosity"), [(0.0, 1.0), (1.0, -1.0), (math.inf, 1.0)])
def test_impossible_fluid_is_refused(density, viscosity):
    with pytest.raises(InputError, match="fluid"):
        Fluid(density=density, viscosity=viscosity)


def test_errors_name_place_and_key():
    with pytest.raises(InputError, match=r"campaign\.toml: bore must be one of .* unknown key"):
        Device.from_dict({"preset": "device-12", "bore": 1.0}, where="campaign.toml")
    with pytest.raises(InputError, match="helix_radius must be given"):
        Device.from_dict({"rod_radius": 0.01, "cylinder_radius": 0.02, "channel_radius": 0.005})
    with pytest.raises(InputError, match="preset must be one of device-12, device-10"):
        Device.preset("device-11")
    with pytest.raises(InputError, match=r"device\.fluid: viscosity"):
        Device.from_dict({"preset": "device-12", "fluid": {"viscosity": "thick"}})
    with pytest.raises(InputError, match="density must be given"):
        Device.from_dict({**TWELVE.to_dict(), "fluid": {"viscosity": 1.0}})


@given(st.floats(0.2, 5.0))
def test_inertance_does_not_depend_on_the_size_of_the_unit(scale):
    # Lengths times s, density over s^3: the same masses, so the same inertance.
    lengths = ("rod_radius", "cylinder_radius", "channel_radius", "helix_radius", "helix_pitch")
    values = {key: getattr(TWELVE, key) * scale for key in (*lengths, "transition_length")}
    scaled = replace(TWELVE, **values, fluid=Fluid(800.0 / scale**3, 0.027))
    assert scaled.inertance == pytest.approx(TWELVE.inertance, rel=1e-12)
