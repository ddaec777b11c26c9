"""Every term: its symmetry, its unit, what it does to its input."""

import numpy as np
import pint
import pytest

from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion, harmonic_motion
from models.terms import TERMS, find_term

UNITS = pint.UnitRegistry()
COEFFICIENTS = np.array([0.0, -0.01j, 0.0, 0.001 + 0.0005j])
FREQUENCY = 2.0
SHAPES = {
    "power-law-damping": {"exponent": 1.6},
    "fractional-derivative": {"order": 1.7},
    "coulomb-friction": {"transition_speed": 0.02},
    "cubic-stiffness": {"closure": 0.03, "span": 0.02},
    "stribeck-friction": {"stribeck_velocity": 0.05, "transition_speed": 0.004},
    "end-stop": {"gap": 0.006, "exponent": 1.5},
    "hysteresis": {"yield_displacement": 0.002},
    "position-dependent-friction": {"power": 1.0},
    "thermal-drift": {"warming_time": 0.3, "saturation": 0.7},
    "sensor-drift": {"settling_time": 0.3},
    "sensor-clipping": {"limit": 40.0},
    "sensor-gain": {"threshold": 10.0},
    "cavitation": {"limit": 40.0, "contact": 300.0},
    "backlash": {"gap": 1e-3, "contact": 300.0, "loss": 0.5},
    "series-compliance": {"loss": 0.1},
    "unsteady-friction": {"diffusion_time": 2.0},
    "relaxation": {"relaxation_time": 0.4},
    "saturating-damping": {"knee_speed": 0.05},
}
SIZES = {"displacement": 0.01, "speed": 0.13, "force": 70.0}  # of what is tested
COEFFICIENT = {"series-compliance": 1e-5, "time-delay": 3e-3, "cavitation": 0.8, "sensor-gain": 0.1}
DEVICE = (("inertia", 30.0), ("viscous-damping", 200.0))
FORCES = sorted(i for i, t in TERMS.items() if t.acts == "force")
ODD = {
    "inertia", "viscous-damping", "quadratic-damping", "power-law-damping", "coulomb-friction",
    "fractional-derivative", "stiffness", "cubic-stiffness", "stribeck-friction", "end-stop",
    "hysteresis", "thermal-drift", "unsteady-friction", "relaxation", "saturating-damping",
}  # fmt: skip
EVEN = {
    "force-offset", "asymmetric-damping", "position-dependent-friction", "sensor-drift",
    "quadratic-stiffness",
}  # fmt: skip
WITHOUT_SIDE = {
    "backlash", "sensor-clipping", "sensor-gain", "series-compliance", "time-delay",
}  # fmt: skip


def motion_of(scale=1.0, *, time=1.0, coefficients=COEFFICIENTS, samples=256):
    return harmonic_motion(scale * coefficients, FREQUENCY / time, samples=samples)


def shape_of(identifier):
    """Return the shape that is tested: of a term that is not among `SHAPES` the defaults."""
    parameters = find_term(identifier).parameters
    scaled = {p.name: p.default * SIZES[p.scaled_by] for p in parameters if p.scaled_by}
    return {**{n: v for n, v in scaled.items() if v}, **SHAPES.get(identifier, {})}


def column(identifier, motion, **shape):
    term = find_term(identifier)
    return term.column(motion, term.shape({**shape_of(identifier), **shape}))


def device_with(identifier, *, flipped_side=False):
    shape = shape_of(identifier)
    if flipped_side:
        shape["side"] = 1.0
    fitted = FittedTerm(identifier, COEFFICIENT.get(identifier, 1.0), shape)
    return ForceModel((*(FittedTerm(i, c) for i, c in DEVICE), fitted))


@pytest.mark.parametrize("identifier", sorted(ODD | EVEN))
def test_the_mirrored_motion_mirrors_odd_terms_and_leaves_even_ones(identifier):
    sign = -1.0 if identifier in ODD else 1.0
    there, back = (column(identifier, motion_of(s)) for s in (1.0, -1.0))
    assert np.abs(there).max() > 0.0
    np.testing.assert_allclose(back, sign * there, atol=1e-10 * np.abs(there).max())


def test_friction_along_the_stroke_is_odd_with_the_square():
    there, back = (column("position-dependent-friction", motion_of(s), power=2.0) for s in (1, -1))
    np.testing.assert_allclose(back, -there, atol=1e-12)


@pytest.mark.parametrize("identifier", sorted(WITHOUT_SIDE))
def test_effects_without_a_side_mirror_an_odd_device(identifier):
    model = device_with(identifier)
    there, back = model.force(motion_of()), model.force(motion_of(-1.0))
    np.testing.assert_allclose(back, -there, atol=1e-6 * np.abs(there).max())


def test_cavitation_of_the_mirrored_device_is_on_the_other_side():
    there = device_with("cavitation").force(motion_of())
    back = device_with("cavitation", flipped_side=True).force(motion_of(-1.0))
    np.testing.assert_allclose(back, -there, atol=1e-6 * np.abs(there).max())
    bare = ForceModel(device_with("cavitation").terms[:2]).force(motion_of())
    assert np.abs(there - bare).max() > 1.0


def factor(unit, mass, length, time):
    """Return by what a value in this unit grows when the base units shrink by these factors."""
    dimensions = UNITS.parse_units(unit or "dimensionless").dimensionality
    known = {"[mass]": mass, "[length]": length, "[time]": time}
    assert set(dimensions) <= set(known)
    return float(np.prod([known[d] ** float(p) for d, p in dimensions.items()]))


@pytest.mark.parametrize("identifier", sorted(TERMS))
def test_units_are_those_of_the_formula(identifier):
    """The force of the same device in grams, millimetres and another unit of time is the same."""
    mass, length, time = 1e3, 1e2, 7.0
    model = device_with(identifier)
    scaled = []
    for fitted in model.terms:
        parameters = {p.name: p.unit for p in fitted.term.parameters}
        shape = {k: v * factor(parameters[k], mass, length, time) for k, v in fitted.shape.items()}
        unit = fitted.unit.replace("rad", "").replace(" ", "*")  # N (s/m)^p
        scaled.append(
            FittedTerm(fitted.id, fitted.coefficient * factor(unit, mass, length, time), shape)
        )
    found = ForceModel(tuple(scaled)).force(motion_of(length, time=time))
    expected = model.force(motion_of()) * mass * length / time**2
    np.testing.assert_allclose(found, expected, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("identifier", sorted(TERMS))
def test_the_motion_is_not_changed(identifier):
    source = motion_of()
    arrays = [source.time, source.displacement, source.velocity, source.acceleration]
    before = [a.copy() for a in arrays]
    for array in arrays:
        array.flags.writeable = False
    device_with(identifier).force(source)
    for array, old in zip(arrays, before, strict=True):
        np.testing.assert_array_equal(array, old)


@pytest.mark.parametrize("identifier", sorted(set(TERMS) - {"time-delay"}))
def test_an_effect_of_no_size_changes_nothing(identifier):
    model = device_with(identifier)
    bare = ForceModel(model.terms[:2])
    nothing = ForceModel((*model.terms[:2], FittedTerm(identifier, 0.0, model.terms[2].shape)))
    np.testing.assert_allclose(
        nothing.force(motion_of()), bare.force(motion_of()), atol=1e-9
    )


def test_a_delay_in_the_steady_state_is_the_earlier_force():
    bare = ForceModel(device_with("inertia").terms[:2])
    late = device_with("time-delay").force(motion_of())
    turn = np.exp(-2j * np.pi * FREQUENCY * np.arange(4) * 3e-3)
    earlier = bare.force(motion_of(coefficients=COEFFICIENTS * turn))
    np.testing.assert_allclose(late, earlier, atol=1e-9)


@pytest.mark.parametrize("identifier", ["viscous-damping", "quadratic-damping", "power-law-damping",
                                        "coulomb-friction", "stribeck-friction"])
def test_damping_takes_energy_at_every_instant(identifier):
    source = motion_of()
    assert np.all(column(identifier, source) * source.velocity >= 0.0)


@pytest.mark.parametrize("identifier", ["inertia", "stiffness", "cubic-stiffness", "end-stop"])
def test_stores_give_back_all_energy_over_a_cycle(identifier):
    source = motion_of(samples=8192)
    power = column(identifier, source) * source.velocity
    assert abs(power.mean()) < 1e-6 * np.abs(power).max()


def test_special_shapes_are_the_plain_terms():
    source = motion_of()
    for powers, plain in ((1.0, "viscous-damping"), (2.0, "quadratic-damping")):
        np.testing.assert_allclose(
            column("power-law-damping", source, exponent=powers), column(plain, source), atol=1e-14
        )
    for order, plain in ((0.0, "stiffness"), (1.0, "viscous-damping"), (2.0, "inertia")):
        np.testing.assert_allclose(
            column("fractional-derivative", source, order=order), column(plain, source), atol=1e-11
        )


def test_a_cube_that_levels_off_is_a_cube_first_and_a_spring_in_the_end():
    source = motion_of()
    x = source.displacement
    for span, expected in ((100.0, x**3), (1e-7, 1e-14 * x)):
        found = column("cubic-stiffness", source, closure=0.0, span=span)
        far = np.abs(x) > 1e-3
        np.testing.assert_allclose(found[far], expected[far], rtol=1e-6)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_enclosed_gas_is_an_offset_a_spring_and_a_quadratic_spring_that_closes(side):
    """At constant temperature its pressure goes as one over the length that is left."""
    source, length = motion_of(), 0.05
    x = side * source.displacement
    gas = length / (length - x)
    found = column("quadratic-stiffness", source, closure=length, side=side)
    np.testing.assert_allclose(1.0 + x / length + found / length**2, gas, rtol=1e-12)


def test_friction_over_a_transition_tends_to_the_jump():
    source = motion_of()
    sharp = column("coulomb-friction", source, transition_speed=0.0)
    moving = np.abs(source.velocity) > 1e-3
    np.testing.assert_allclose(
        column("coulomb-friction", source, transition_speed=1e-4)[moving], sharp[moving], atol=1e-6
    )


def test_names_and_parameters_that_are_not_there_are_refused_with_those_that_are():
    with pytest.raises(InputError, match="inertia"):
        find_term("inertance")
    with pytest.raises(InputError, match="exponent"):
        find_term("power-law-damping").shape({"order": 1.0})
    with pytest.raises(InputError, match=r"hysteresis\.yield_displacement"):
        find_term("hysteresis").shape({})


def test_a_motion_made_elsewhere_serves_as_well():
    source = motion_of()
    copied = Motion(
        source.time, source.displacement, source.velocity, source.acceleration,
        source.differentiate, "weyl", periodic=True,
    )  # fmt: skip
    for identifier in FORCES:
        np.testing.assert_array_equal(column(identifier, copied), column(identifier, source))
