"""Motion in time against Mittag-Leffler functions, scipy's solvers, and exact friction."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from pymittagleffler import mittag_leffler
from scipy.integrate import solve_ivp

from models.checks import InputError
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel, ioim_turbulent
from models.device import Device
from models.simulation import (
    PeriodicPast,
    no_load,
    sampled_load,
    simulate,
    sine_load,
    sweep_load,
)
from models.structure import Mount, Structure, chain, oscillator

CYCLE = 2.0 * np.pi


def fractional(coefficient: float, order: float) -> ForceModel:
    return ForceModel((FittedTerm("fractional-derivative", coefficient, {"order": order}),))


def mittag_leffler_oscillator(
    c: float, p: int, q: int, x0: float, v0: float, t: NDArray[np.float64]
) -> NDArray[np.float64]:
    """x'' + c D^(p/q) x + x = 0 (Caputo) by partial fractions in s^(1/q), t > 0."""
    polynomial = np.zeros(2 * q + 1)
    polynomial[0] = 1.0
    polynomial[2 * q - p] += c
    polynomial[-1] += 1.0
    roots = np.roots(polynomial)
    residues = 1.0 / np.polyval(np.polyder(polynomial), roots)

    def inverse(power: float) -> NDArray[np.float64]:
        second = 1.0 / q - power
        total = sum(
            r * mittag_leffler(w * t ** (1.0 / q), 1.0 / q, second)
            for w, r in zip(roots, residues, strict=True)
        )
        return np.real(t ** (second - 1.0) * total)

    moved = x0 * (1.0 - inverse(-1.0)) + v0 * (t - inverse(-2.0))
    return moved if p > q else moved - v0 * c * inverse(p / q - 2.0)


ORDERS = [(1, 4), (1, 2), (7, 5), (3, 2), (19, 10)]


@pytest.mark.parametrize(("p", "q"), ORDERS)
@pytest.mark.parametrize("c", [0.25, 1.0])
def test_two_cycles_at_ten_thousand_steps(p: int, q: int, c: float) -> None:
    response = simulate(
        oscillator(1.0, 1.0, fractional(c, p / q)),
        step=2 * CYCLE / 10_000, duration=2 * CYCLE, displacement=1.0, velocity=0.5,
        estimate_error=False,
    )  # fmt: skip
    at = np.arange(50, 10_001, 50)
    exact = mittag_leffler_oscillator(c, p, q, 1.0, 0.5, response.time[at])
    assert np.abs(response.displacement[at, 0] - exact).max() <= 1e-6 * np.abs(exact).max()


@pytest.mark.parametrize(("p", "q"), ORDERS)
@pytest.mark.parametrize("c", [0.05, 0.5])
def test_twenty_cycles_after_extrapolation(p: int, q: int, c: float) -> None:
    response = simulate(
        oscillator(1.0, 1.0, fractional(c, p / q)),
        step=20 * CYCLE / 10_000, duration=20 * CYCLE, displacement=1.0, velocity=0.5,
        richardson=True,
    )  # fmt: skip
    at = np.arange(50, 10_001, 50)
    exact = mittag_leffler_oscillator(c, p, q, 1.0, 0.5, response.time[at])
    error = np.abs(response.displacement[at, 0] - exact).max()
    assert error <= 1e-6 * np.abs(exact).max()
    assert response.extrapolated
    assert response.error is not None
    assert error <= response.error.displacement[0]


@pytest.mark.parametrize(("p", "q"), ORDERS)
def test_second_order_from_the_first_step_on(p: int, q: int) -> None:
    steps = np.array([250, 500, 1000, 2000])
    errors = []
    for n in steps:
        response = simulate(
            oscillator(1.0, 1.0, fractional(0.4, p / q)),
            step=2 * CYCLE / n, duration=2 * CYCLE, displacement=1.0, velocity=-1.0,
        )  # fmt: skip
        exact = mittag_leffler_oscillator(0.4, p, q, 1.0, -1.0, response.time[1:])
        errors.append(np.abs(response.displacement[1:, 0] - exact).max())
        assert response.error is not None
        assert 0.8 < response.error.displacement[0] / errors[-1] < 1.25
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order >= 1.9


def massless(order: float) -> Structure:
    """D^a x + x = 0: the device alone carries the spring."""
    return Structure([[0.0]], [[0.0]], [[1.0]], (Mount(fractional(1.0, order)),))


def massless_motion(order: float, t: NDArray[np.float64]) -> NDArray[np.float64]:
    """From x = 1, v = 0.5: E_a(-t^a) + 0.5 t E_(a,2)(-t^a)."""
    z = -(t**order)
    return np.real(mittag_leffler(z, order, 1.0) + 0.5 * t * mittag_leffler(z, order, 2.0))


@pytest.mark.parametrize("order", [1.1, 1.2, 1.5, 1.8, 1.95])
@pytest.mark.parametrize(("cycles", "richardson"), [(2, False), (20, True)])
def test_fractional_oscillator_without_mass(order: float, cycles: int, richardson: bool) -> None:
    response = simulate(
        massless(order), step=cycles * CYCLE / 10_000, duration=cycles * CYCLE, displacement=1.0,
        velocity=0.5, estimate_error=False, richardson=richardson,
    )  # fmt: skip
    exact = massless_motion(order, response.time[1:])
    assert np.abs(response.displacement[1:, 0] - exact).max() <= 1e-6
    assert abs(response.energy.residual) <= 1e-10


def test_second_order_without_mass_and_whatever_is_kept() -> None:
    errors = []
    for n in (512, 1024, 2048, 4096):
        response = simulate(
            massless(1.3), step=2 * CYCLE / n, duration=2 * CYCLE, displacement=1.0, velocity=0.5,
            keep_every=2, estimate_error=False,
        )  # fmt: skip
        exact = massless_motion(1.3, response.time[1:])
        errors.append(np.abs(response.displacement[1:, 0] - exact).max())
    assert np.log2(errors[0] / errors[-1]) / 3.0 >= 1.9


def test_whole_orders_equal_spring_damper_and_inerter() -> None:
    terms = [("stiffness", 0.0), ("viscous-damping", 1.0), ("inertia", 2.0)]
    for name, order in terms:
        plain = oscillator(1.0, 2.0, ForceModel((FittedTerm(name, 0.7),)))
        same = oscillator(1.0, 2.0, fractional(0.7, order))
        a, b = (
            simulate(s, sine_load(1.0, 0.3), step=0.01, duration=5.0, estimate_error=False)
            for s in (plain, same)
        )
        np.testing.assert_array_equal(a.displacement, b.displacement)


@pytest.mark.parametrize(
    ("whole", "near", "start", "speed"),
    [(0.0, 1e-7, 0.0, 0.3), (1.0, 1.0 - 1e-7, 1.0, 0.3), (1.0, 1.0 + 1e-7, 1.0, 0.0),
     (2.0, 2.0 - 1e-7, 1.0, 0.3)],
)  # fmt: skip
def test_orders_tend_to_the_whole_ones(
    whole: float, near: float, start: float, speed: float
) -> None:
    # Caputo's derivative of order 0+ and 1+ is that of x - x(0) and v - v(0).
    a, b = (
        simulate(
            oscillator(1.0, 2.0, fractional(0.7, order)),
            step=0.002, duration=10.0, displacement=start, velocity=speed, estimate_error=False,
        )
        for order in (whole, near)
    )  # fmt: skip
    np.testing.assert_allclose(a.displacement, b.displacement, rtol=0.0, atol=1e-6)


def test_whole_orders_against_scipy() -> None:
    device = Device.preset("device-10")
    law = ForceModel(
        (
            FittedTerm("inertia", 73.82),
            FittedTerm("quadratic-damping", 3000.0),
            FittedTerm("viscous-damping", 150.0),
            FittedTerm("cubic-stiffness", 4e6),
        )
    )
    structure = chain([200.0, 50.0], [2e5, 8e4], [100.0, 50.0], [Mount(law, 1, 0)])
    assert device.inertance > 0.0
    shake = sine_load(3.0, 2.0, acts="base", phase=0.4)
    mass = structure.mass + 73.82 * np.array([[1.0, -1.0], [-1.0, 1.0]])

    def rate(t: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        x, v = y[:2], y[2:]
        s, u = x[1] - x[0], v[1] - v[0]
        force = 3000.0 * u * abs(u) + 150.0 * u + 4e6 * s**3
        base = float(shake.history(np.array([t]))[0])
        total = -structure.mass.sum(axis=1) * base - structure.damping @ v
        total -= structure.stiffness @ x + np.array([-force, force])
        return np.concatenate([v, np.linalg.solve(mass, total)])

    exact = solve_ivp(
        rate, (0.0, 1.0), np.zeros(4), method="DOP853", rtol=1e-13, atol=1e-16,
        t_eval=np.linspace(0.0, 1.0, 11),
    )  # fmt: skip
    response = simulate(structure, shake, step=2e-5, duration=1.0, richardson=True, keep_every=5000)
    error = np.abs(response.displacement.T - exact.y[:2]).max()
    assert error <= 1e-8 * np.abs(exact.y[:2]).max()


FRICTION = 0.2


def rubbing(*others: FittedTerm, friction: float = FRICTION) -> ForceModel:
    return ForceModel((FittedTerm("coulomb-friction", friction), *others))


@pytest.mark.parametrize("order", [0.5, 1.5])
def test_below_the_limit_nothing_moves_to_the_last_bit(order: float) -> None:
    law = rubbing(FittedTerm("fractional-derivative", 0.3, {"order": order}))
    response = simulate(
        oscillator(1.0, 1.0, law), sine_load(0.999 * FRICTION, 0.11), step=0.01, duration=200.0
    )
    assert not response.displacement.any()
    assert not response.velocity.any()
    moving = simulate(
        oscillator(1.0, 1.0, law), sine_load(1.01 * FRICTION, 0.11), step=0.01, duration=200.0
    )
    assert moving.displacement.any()


def test_stuck_between_two_masses_moves_as_one() -> None:
    law = rubbing(friction=100.0)
    structure = chain([1.0, 2.0], [9.0, 0.0], None, [Mount(law, 1, 0)])
    response = simulate(structure, sine_load(1.0, 0.3), step=0.001, duration=10.0)
    np.testing.assert_array_equal(response.velocity[:, 0], response.velocity[:, 1])
    rigid = simulate(oscillator(3.0, 9.0), sine_load(1.0, 0.3), step=0.001, duration=10.0)
    np.testing.assert_allclose(response.displacement[:, 0], rigid.displacement[:, 0], atol=1e-12)


@pytest.mark.parametrize("start", [0.9, 1.33, 2.9, 3.05])
def test_friction_oscillator_stops_in_the_half_cycle_of_theory(start: float) -> None:
    # Each half-cycle takes 2 f0/k off the amplitude; it stops where the spring can't overcome f0.
    half_cycles, rest = 0, start
    while abs(rest) > FRICTION:
        rest = -np.sign(rest) * (abs(rest) - 2.0 * FRICTION)
        half_cycles += 1
    response = simulate(
        oscillator(1.0, 1.0, rubbing()), step=1e-3, duration=40.0, displacement=start,
        estimate_error=False,
    )  # fmt: skip
    moving = response.velocity[:, 0] != 0.0
    last = response.time[np.nonzero(moving)[0][-1]]
    assert abs(last - half_cycles * np.pi) < 3e-3
    assert abs(response.displacement[-1, 0] - rest) < 1e-5
    stopped = response.displacement[response.time > last + 0.01, 0]
    assert (stopped == stopped[0]).all()


def test_second_order_through_reversals() -> None:
    # Strong enough to slide on without sticking; each half-cycle is a shifted cosine.
    def exact(t: NDArray[np.float64]) -> NDArray[np.float64]:
        half = np.floor(t / np.pi)
        amplitude = 10.0 - 2.0 * FRICTION * half
        sign = np.where(half % 2 == 0, 1.0, -1.0)
        return sign * (FRICTION + (amplitude - FRICTION) * np.cos(t - half * np.pi))

    errors = []
    for n in (400, 800, 1600, 3200):
        response = simulate(
            oscillator(1.0, 1.0, rubbing()), step=10.0 / n, duration=10.0, displacement=10.0,
            estimate_error=False,
        )  # fmt: skip
        errors.append(np.abs(response.displacement[:, 0] - exact(response.time)).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert rates.mean() >= 1.9


def every_effect() -> ForceModel:
    return ForceModel(
        (
            FittedTerm("inertia", 0.4),
            FittedTerm("viscous-damping", 0.1),
            FittedTerm("quadratic-damping", 0.2),
            FittedTerm("power-law-damping", 0.1, {"exponent": 1.75}),
            FittedTerm("asymmetric-damping", 0.03),
            FittedTerm("asymmetric-damping", 0.02, {"power": 1.5, "side": -1.0}),
            FittedTerm("stiffness", 0.3),
            FittedTerm("cubic-stiffness", 0.5),
            FittedTerm("end-stop", 3.0, {"gap": 0.3, "exponent": 1.5, "side": 0.0}),
            FittedTerm("force-offset", 0.05),
            FittedTerm("coulomb-friction", 0.1),
            FittedTerm("stribeck-friction", 0.05, {"stribeck_velocity": 0.1}),
            FittedTerm("coulomb-friction", 0.04, {"transition_speed": 0.05}),
            FittedTerm("coulomb-friction", 0.03, {"transition_speed": 0.05, "form": 1.0}),
            FittedTerm("fractional-derivative", 0.2, {"order": 0.6}),
            FittedTerm("fractional-derivative", 0.3, {"order": 1.7}),
        )
    )


def test_energy_balance_closes() -> None:
    structure = chain([1.0, 0.5], [4.0, 2.0], [0.02, 0.01], [Mount(every_effect(), 1, 0)])
    response = simulate(
        structure, sweep_load(2.0, 0.05, 2.0, 60.0), step=0.005, duration=60.0, displacement=0.1
    )
    assert abs(response.energy.residual) <= 1e-10
    assert response.energy.input != 0.0


@pytest.mark.parametrize("form", [0.0, 1.0])
def test_friction_over_a_range_of_speed_slows_a_mass_by_its_curve(form: float) -> None:
    # Speeds from the time that separating the variables gives, in closed form.
    speed, friction, start = 0.05, 0.04, 0.3
    shape = {"transition_speed": speed, "form": form}
    law = ForceModel((FittedTerm("coulomb-friction", friction, shape),))
    response = simulate(oscillator(1.0, 0.0, law), step=1e-3, duration=6.0, velocity=start)
    v = response.velocity[:, 0]
    moving = v > 1e-3
    u = np.append(start, v[moving])
    root = np.hypot(u, speed)
    falls = speed * np.log(u / (speed + root)) if form else speed * np.log(np.sinh(u / speed))
    curve = root + falls if form else falls
    expected = (curve[0] - curve[1:]) / friction
    np.testing.assert_allclose(response.time[moving], expected, atol=2e-3)


@pytest.mark.parametrize(("form", "sharpness"), [(0.0, 2.5), (0.0, 0.7), (1.0, 0.6), (1.0, 3.0)])
def test_friction_of_another_knee_slows_a_mass_by_its_curve(form: float, sharpness: float) -> None:
    def pull(_: float, v: NDArray[np.float64]) -> NDArray[np.float64]:
        u = np.maximum(v, 0.0) / 0.05  # a step of the solver may end below
        if form:
            return -0.04 * u / (1.0 + u ** (2.0 * sharpness)) ** (0.5 / sharpness)
        return -0.04 * np.tanh(u**sharpness) ** (1.0 / sharpness)

    shape = {"transition_speed": 0.05, "form": form, "sharpness": sharpness}
    law = ForceModel((FittedTerm("coulomb-friction", 0.04, shape),))
    response = simulate(oscillator(1.0, 0.0, law), step=1e-3, duration=8.0, velocity=0.3)
    exact = solve_ivp(pull, (0.0, 8.0), [0.3], t_eval=response.time, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(response.velocity[:, 0], exact.y[0], atol=2e-6)


def test_friction_in_two_parts_slows_a_mass_by_both() -> None:
    def pull(_: float, v: NDArray[np.float64]) -> NDArray[np.float64]:
        return -0.03 * np.tanh(v / 0.05) - 0.01 * np.tanh(v / 0.2)

    shape = {"transition_speed": 0.05, "other_speed": 0.2, "other_share": 0.25}
    law = ForceModel((FittedTerm("coulomb-friction", 0.04, shape),))
    response = simulate(oscillator(1.0, 0.0, law), step=1e-3, duration=8.0, velocity=0.3)
    exact = solve_ivp(pull, (0.0, 8.0), [0.3], t_eval=response.time, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(response.velocity[:, 0], exact.y[0], atol=2e-6)


def test_a_part_of_friction_that_jumps_brings_a_mass_to_rest() -> None:
    # dv/dt = -f (1 - s) tanh(v / v_t) - f s down to rest, which the jump holds from there on.
    shape = {"transition_speed": 0.05, "other_speed": 0.0, "other_share": 0.25}
    law = ForceModel((FittedTerm("coulomb-friction", 0.04, shape),))
    response = simulate(oscillator(1.0, 0.0, law), step=1e-3, duration=14.0, velocity=0.3)

    def pull(_: float, v: NDArray[np.float64]) -> NDArray[np.float64]:
        return -0.03 * np.tanh(v / 0.05) - 0.01

    def rest(_: float, v: NDArray[np.float64]) -> float:
        return float(v[0])

    rest.terminal = True
    exact = solve_ivp(pull, (0.0, 14.0), [0.3], events=rest, rtol=1e-10, atol=1e-12,
                      dense_output=True)
    stop = exact.t_events[0][0]
    assert 7.0 < stop < 12.0
    moving, velocity = response.time < stop, response.velocity[:, 0]
    np.testing.assert_allclose(velocity[moving], exact.sol(response.time[moving])[0], atol=1e-5)
    assert np.abs(velocity[response.time > stop + 2e-3]).max() == 0.0


def test_works_are_those_of_the_motion() -> None:
    # Independent of the ledger: quadrature of force times velocity over the samples.
    law = rubbing(FittedTerm("viscous-damping", 0.3), friction=0.1)
    drive = sine_load(1.0, 0.2)
    response = simulate(oscillator(1.0, 1.0, law), drive, step=1e-3, duration=30.0)
    v = response.velocity[:, 0]
    push = np.trapezoid(drive.history(response.time) * v, response.time)
    assert abs(response.energy.input - push) <= 1e-6 * push
    lost = np.trapezoid(0.3 * v**2, response.time)
    assert abs(response.energy.viscous - lost) <= 1e-6 * lost
    rubbed = 0.1 * np.trapezoid(np.abs(v), response.time)
    assert abs(response.energy.friction - rubbed) <= 1e-5 * rubbed


def test_steady_sliding_loses_four_f0_a_per_cycle() -> None:
    law = rubbing(friction=0.05)
    response = simulate(oscillator(1.0, 1.0, law), sine_load(1.0, 0.05), step=0.002, duration=400.0)
    last = simulate(oscillator(1.0, 1.0, law), sine_load(1.0, 0.05), step=0.002, duration=380.0)
    amplitude = np.ptp(response.displacement[response.time > 380.0]) / 2.0
    lost = response.energy.friction - last.energy.friction
    assert lost == pytest.approx(4.0 * 0.05 * amplitude, rel=1e-3)


@pytest.mark.parametrize("order", [0.5, 1.5])
def test_out_of_a_steady_state_the_motion_goes_on_without_transient(order: float) -> None:
    structure = oscillator(1.0, 1.0, fractional(0.4, order))
    omega = 0.8
    compliance = 1.0 / (1.0 - omega**2 + 0.4 * (1j * omega) ** order)
    past = PeriodicPast(np.array([[0.0], [-1j * compliance]]), omega / CYCLE)
    response = simulate(
        structure, sine_load(1.0, omega / CYCLE), step=CYCLE / omega / 1000, past=past,
        duration=5 * CYCLE / omega, richardson=True,
    )  # fmt: skip
    assert response.operator == "weyl"
    exact = past.displacement(response.time)
    assert np.abs(response.displacement - exact).max() <= 1e-8 * abs(compliance)
    force = (0.4 * (1j * omega) ** order * past.coefficients[1, 0]
             * np.exp(1j * omega * response.time)).real  # fmt: skip
    inner = slice(5, -5)
    assert np.abs(response.device_force[inner, 0] - force[inner]).max() <= 1e-6


def test_scale_of_the_units_does_not_matter() -> None:
    law = rubbing(FittedTerm("fractional-derivative", 0.3, {"order": 1.5}))
    plain = simulate(oscillator(1.0, 1.0, law), sine_load(1.0, 0.2), step=0.01, duration=30.0)
    heavy = ForceModel(tuple(FittedTerm(t.id, 1e3 * t.coefficient, t.shape) for t in law.terms))
    scaled = simulate(oscillator(1e3, 1e3, heavy), sine_load(1e3, 0.2), step=0.01, duration=30.0)
    np.testing.assert_allclose(scaled.displacement, plain.displacement, rtol=0, atol=1e-11)


def test_a_load_mirrored_mirrors_the_motion() -> None:
    law = rubbing(FittedTerm("fractional-derivative", 0.3, {"order": 1.5}))
    one, other = (
        simulate(oscillator(1.0, 1.0, law), sine_load(a, 0.2), step=0.01, duration=30.0)
        for a in (1.0, -1.0)
    )
    np.testing.assert_array_equal(one.displacement, -other.displacement)


def test_a_sampled_load_equals_its_function() -> None:
    t = np.linspace(0.0, 10.0, 1001)
    t.flags.writeable = False
    structure = oscillator(1.0, 1.0, fractional(0.3, 1.5))
    drive = sine_load(1.0, 0.2, acts="base")
    a = simulate(structure, drive, step=0.01, duration=10.0)
    b = simulate(
        structure, sampled_load(t, drive.history(t), acts="base"), step=0.01, duration=10.0
    )
    np.testing.assert_allclose(a.displacement, b.displacement, atol=1e-13)


def test_kept_steps_are_steps_of_the_whole() -> None:
    structure = oscillator(1.0, 1.0, rubbing(FittedTerm("quadratic-damping", 0.2)))
    whole = simulate(structure, sine_load(1.0, 0.2), step=0.01, duration=1400.0)
    part = simulate(structure, sine_load(1.0, 0.2), step=0.01, duration=1400.0, keep_every=7)
    np.testing.assert_array_equal(whole.displacement[::7], part.displacement)
    np.testing.assert_allclose(whole.device_force[::7], part.device_force, atol=1e-12)


def test_segmented_model_uses_the_band_of_the_speed() -> None:
    slow, fast = (ForceModel((FittedTerm("viscous-damping", c),)) for c in (0.05, 1.0))
    law = SegmentedModel((Band(None, 0.5, slow), Band(0.5, None, fast)), "speed")
    quiet = simulate(oscillator(1.0, 1.0, law), sine_load(0.01, 0.1), step=0.01, duration=50.0)
    alone = simulate(oscillator(1.0, 1.0, slow), sine_load(0.01, 0.1), step=0.01, duration=50.0)
    assert quiet.switches == 0
    np.testing.assert_array_equal(quiet.displacement, alone.displacement)
    loud = simulate(oscillator(1.0, 1.0, law), sine_load(10.0, 0.16), step=0.01, duration=200.0)
    damped = simulate(oscillator(1.0, 1.0, fast), sine_load(10.0, 0.16), step=0.01, duration=200.0)
    assert loud.switches == 1
    np.testing.assert_allclose(loud.displacement[-2000:], damped.displacement[-2000:], atol=1e-3)
    assert abs(loud.energy.residual) <= 1e-10


def test_segmented_model_by_frequency() -> None:
    low, high = (ForceModel((FittedTerm("viscous-damping", c),)) for c in (0.1, 2.0))
    law = SegmentedModel((Band(None, 0.3, low), Band(0.3, None, high)), "frequency")
    for frequency, band in ((0.1, low), (1.0, high)):
        drive = sine_load(1.0, frequency)
        mixed = simulate(oscillator(1.0, 1.0, law), drive, step=0.01, duration=200.0)
        pure = simulate(oscillator(1.0, 1.0, band), drive, step=0.01, duration=200.0)
        np.testing.assert_allclose(
            mixed.displacement[-500:], pure.displacement[-500:], atol=1e-3
        )


def test_an_end_stop_bounces_a_free_mass_back() -> None:
    # Free flight, a half sine on the spring of the stop, free flight back.
    stop = ForceModel((FittedTerm("end-stop", 100.0, {"gap": 1.0, "exponent": 1.0, "side": 1.0}),))
    structure = Structure([[1.0]], [[0.0]], [[0.0]], (Mount(stop),))
    response = simulate(structure, step=1e-4, duration=3.0, velocity=1.0)
    contact = np.pi / 10.0
    assert response.displacement.max() == pytest.approx(1.1, abs=1e-6)
    assert response.velocity[-1, 0] == pytest.approx(-1.0, abs=1e-7)
    exact = 1.0 - (3.0 - 1.0 - contact)
    assert response.displacement[-1, 0] == pytest.approx(exact, abs=1e-6)
    assert abs(response.energy.residual) < 1e-10


@pytest.mark.parametrize(
    ("term", "name"),
    [("cubic-stiffness", "closure"), ("cubic-stiffness", "span"), ("end-stop", "loss"),
     ("end-stop", "damping_time"), ("end-stop", "dry_loss")],
)  # fmt: skip
def test_a_law_that_no_step_is_written_for_is_refused(term: str, name: str) -> None:
    gap = {"gap": 1.0} if term == "end-stop" else {}
    bent = ForceModel((FittedTerm(term, 1.0, {**gap, name: 0.02}),))
    with pytest.raises(InputError, match=f"{name} of {term} .* must be 0"):
        simulate(oscillator(1.0, 1.0, bent), step=0.1, duration=1.0)


def test_effects_of_the_measuring_chain_move_nothing() -> None:
    plain = ForceModel((FittedTerm("viscous-damping", 0.3),))
    late = ForceModel((*plain.terms, FittedTerm("time-delay", 0.01)))
    a, b = (
        simulate(oscillator(1.0, 1.0, m), sine_load(1.0, 0.2), step=0.01, duration=5.0)
        for m in (plain, late)
    )
    np.testing.assert_array_equal(a.displacement, b.displacement)
    assert (a.left_out, b.left_out) == ((), ("time-delay",))
    unknown = ForceModel((FittedTerm("series-compliance", 1e-6),))
    with pytest.raises(InputError, match=r"term 'series-compliance' must be one that can be"):
        simulate(oscillator(1.0, 1.0, unknown), step=0.1, duration=1.0)


def test_turbulent_device_settles() -> None:
    law = ioim_turbulent(Device.preset("device-10"), friction=550.0)
    response = simulate(oscillator(250.0, 2e4, law), step=1e-3, duration=20.0, displacement=0.2)
    assert response.velocity[-1, 0] == 0.0
    assert abs(response.displacement[-1, 0]) <= 550.0 / 2e4
    assert response.error is not None
    assert response.error.relative < 1e-3
    assert set(response.to_dict()["energy"]) >= {"input", "residual"}


def test_errors_say_what_is_wrong() -> None:
    structure = oscillator(1.0, 1.0)
    with pytest.raises(InputError, match=r"step must be .* > 0"):
        simulate(structure, step=0.0, duration=1.0)
    with pytest.raises(InputError, match="keep_every must be >= 1"):
        simulate(structure, step=0.1, duration=1.0, keep_every=0)
    with pytest.raises(InputError, match=r"displacement must be a number or \(1,\)"):
        simulate(structure, step=0.1, duration=1.0, displacement=[1.0, 2.0])
    with pytest.raises(InputError, match="degree of freedom of the load"):
        simulate(structure, sine_load(1.0, 1.0, at=1), step=0.1, duration=1.0)
    with pytest.raises(InputError, match="upper end of a device"):
        Structure([[1.0]], [[0.0]], [[1.0]], (Mount(rubbing(), 1),))
    with pytest.raises(InputError, match="stiffness must be symmetric"):
        chain([1.0, 1.0], [1.0, 1.0]).__class__(np.eye(2), np.eye(2), [[1.0, 0.5], [0.0, 1.0]])
    assert simulate(structure, no_load(), step=0.1, duration=1.0).displacement.max() == 0.0
