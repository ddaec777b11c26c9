"""A device behind a joint, against the closed form of linear ones and limits of the others."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion, harmonic_motion
from models.terms.joint import Joint, through_joint
from models.terms.joint_device import device_of

MASS, VISCOUS = 200.0, 900.0


def motion(frequency, amplitude=0.008, samples=1024):
    """Return one cycle with a little of the second and third harmonic."""
    lines = amplitude * np.array([0.0, -1j, 0.04, 0.01])
    return harmonic_motion(lines, frequency, samples=samples)


@pytest.mark.parametrize("frequency", [0.3, 1.5, 3.0, 6.0])
@pytest.mark.parametrize(("loss", "spring"), [(0.02, 0.0), (0.3, 0.0), (0.05, 2e4), (0.05, -4e3)])
def test_a_spring_before_a_linear_device_has_its_transfer_function(frequency, loss, spring):
    """Also one that has a spring itself, and one that a magnet pulls away from its middle."""
    given = motion(frequency)
    stiffness = MASS * (2.0 * np.pi * 3.1) ** 2  # resonance among the tests
    model = ForceModel(tuple(
        FittedTerm(name, value)
        for name, value in (("inertia", MASS), ("viscous-damping", VISCOUS), ("stiffness", spring))
    ))
    force = model.force(given)
    known = device_of(force, given, model.force)
    found = through_joint(force, given, Joint(stiffness, loss), known)
    lines = np.fft.rfft(given.displacement)
    s = 2j * np.pi * frequency * np.arange(lines.size)
    mount = stiffness + 2.0 * loss * np.sqrt(stiffness * MASS) * s
    device = MASS * s**2 + VISCOUS * s + spring
    lines[1:] *= (device * mount / (device + mount))[1:]
    lines[0] = 0.0
    exact = np.fft.irfft(lines, force.size)
    assert np.std(found - exact) < 4e-4 * np.std(exact)


@pytest.mark.parametrize("load_share", [0.0, -0.3])
def test_a_slow_test_does_not_ring_behind_an_undamped_mount(load_share):
    """Its own motion, seven hundred times as fast and lossless, is none of the steady state."""
    given = motion(0.2)
    omega = 2.0 * np.pi * 150.0
    force = MASS * given.acceleration
    mount = Joint(MASS * omega**2, 0.0, half_load=100.0, load_share=load_share)
    found = through_joint(force, given, mount, device_of(force, given))
    assert np.abs(found - force).max() < 2e-3 * np.abs(force).max()  # (0.2 / 150)^2 of it, exactly


def test_what_is_known_of_one_device_is_not_said_of_another():
    """The same array is the same device; a changed one, or one asked about its spring, is not."""
    given = motion(1.0)
    spring = ForceModel((FittedTerm("inertia", MASS), FittedTerm("stiffness", 3e4)))
    force = spring.force(given)
    assert device_of(force, given).spring == 0.0
    sprung = device_of(force, given, spring.force)
    assert [sprung.mass, sprung.spring] == pytest.approx([MASS, 3e4], rel=1e-6)
    assert device_of(force, given).spring == 0.0
    assert device_of(2.0 * force, given, spring.force).mass != device_of(force, given).mass
    for _ in range(300):  # more than are remembered
        assert device_of(MASS * given.acceleration, given).mass == pytest.approx(MASS)


@pytest.mark.parametrize("mass", [1e-3, 0.0])
def test_a_damper_of_hardly_any_mass_follows_its_spring(mass):
    """A dashpot behind a spring: the mass is too small for its own time to be stepped."""
    given = motion(0.3)
    force = mass * given.acceleration + 3000.0 * given.velocity
    found = through_joint(force, given, Joint(4e4, 0.0), device_of(force, given))
    lines = np.fft.rfft(given.displacement)
    s = 2j * np.pi * 0.3 * np.arange(lines.size)
    lines[1:] *= (3000.0 * s * 4e4 / (3000.0 * s + 4e4))[1:]
    lines[0] = 0.0
    exact = np.fft.irfft(lines, force.size)
    assert np.std(found - exact) < 0.01 * np.std(exact)


@pytest.mark.parametrize("per_second", [60.0, 1000.0])
def test_a_dashpot_behind_a_spring_follows_a_shock(per_second):
    """Coarsely sampled, too: its own time is far below what can be stepped."""
    stiffness, damping = 8e5, 2e4
    time = np.arange(0.0, 6.0, 1.0 / per_second)
    phase, fade = 7.0 * time, np.exp(-time)
    x = 0.02 * fade * np.sin(phase)
    v = 0.02 * fade * (7.0 * np.cos(phase) - np.sin(phase))
    a = 0.02 * fade * (-48.0 * np.sin(phase) - 14.0 * np.cos(phase))
    given = Motion(time, x, v, a, lambda orders: np.stack([x, v, a]), "given")
    force = damping * v
    found = through_joint(force, given, Joint(stiffness, 0.0), device_of(force, given))

    def rate(t, carried):
        speed = 0.02 * np.exp(-t) * (7.0 * np.cos(7.0 * t) - np.sin(7.0 * t))
        return stiffness * (speed - carried / damping)

    exact = solve_ivp(rate, (0.0, time[-1]), [force[0]], t_eval=time, rtol=1e-8, atol=1e-4).y[0]
    later = time > 0.5
    assert np.std((found - exact)[later]) < 0.02 * np.std(exact[later])


@pytest.mark.parametrize("reversal", [0.03, 0.2])
def test_a_joint_that_hardly_yields_changes_nothing_not_even_at_the_reversal_of_friction(reversal):
    given = motion(0.4)
    top = np.abs(given.velocity).max()
    force = MASS * given.acceleration + VISCOUS * given.velocity
    force = force + 100.0 * np.tanh(given.velocity / (reversal * top))
    stiff = Joint(1e9, 0.5)
    found = through_joint(force, given, stiff, device_of(force, given))
    assert np.abs(found - force).max() < 0.03 * 100.0


@pytest.mark.parametrize("reversal", [0.004, 0.02, 0.06])
def test_the_device_that_fits_a_force_is_the_one_that_made_it(reversal):
    given = motion(1.0)
    v = given.velocity
    pace = reversal * np.abs(v).max()
    force = MASS * given.acceleration + 3e4 * v * np.abs(v) + 80.0 * np.tanh(v / pace) + 5.0
    found = device_of(force, given)
    plain = found._replace(curve=found.curve[:0])
    resistance = plain.force(given) - found.mass * given.acceleration
    made = force - MASS * given.acceleration - 5.0
    assert found.mass == pytest.approx(MASS, rel=2e-3)
    assert np.std(resistance - made) < 0.03 * np.std(made)
    assert found.dry == pytest.approx(80.0, rel=0.05)
    assert abs(np.log(found.reversal / pace)) < 0.5 * np.log(1.6)  # the nearest that is tried


def test_a_force_that_is_not_finite_has_no_device():
    given = motion(1.0)
    found = device_of(np.full(given.time.size, np.nan), given)
    assert not np.any(found.force(given))


def driven(given, frequency, carried):
    """Return the steady force that a joint carries before a mass with a damper, stepped by SciPy.

    `carried` is its force by how much the driven end is ahead of the mass, in m and in m/s.
    """
    lines = np.fft.rfft(given.displacement) / given.time.size
    turns = 2j * np.pi * frequency * np.arange(4)

    def ahead(time, state):
        wave = 2.0 * lines[:4] * np.exp(turns * time)
        return np.sum(wave[1:].real) - state[0], np.sum((turns * wave)[1:].real) - state[1]

    def slope(time, state):
        return state[1], (carried(*ahead(time, state)) - VISCOUS * state[1]) / MASS

    start = (given.displacement[0] - given.displacement.mean(), given.velocity[0])
    times = (6.0 + np.arange(given.time.size) / given.time.size) / frequency
    found = solve_ivp(
        slope, (0.0, times[-1]), start, method="LSODA", t_eval=times, rtol=1e-8, atol=1e-10,
        max_step=1e-3,
    )
    return np.array([carried(*ahead(t, y)) for t, y in zip(times, found.y.T, strict=True)])


@pytest.mark.parametrize("soft", [2e-5, 1e-4, 5e-4])
def test_soft_flanks_are_those_that_an_integrator_of_others_meets(soft):
    given, frequency, gap, stiffness, loss = motion(1.2, samples=8192), 1.2, 8e-4, 8e5, 0.4
    damping = 2.0 * loss * np.sqrt(stiffness * MASS)

    def carried(depth, pace):
        near = np.array([depth - 0.5 * gap, -depth - 0.5 * gap]) / soft
        pushed = soft * np.logaddexp(0.0, near)
        return stiffness * (pushed[0] - pushed[1]) + damping * pace * np.sum(
            1.0 / (1.0 + np.exp(-near))
        )

    force = MASS * given.acceleration + VISCOUS * given.velocity
    joint = Joint(stiffness, loss, gap=gap, soft=soft)
    found = through_joint(force, given, joint, device_of(force, given))
    exact = driven(given, frequency, carried)
    assert np.std(exact - force) > 0.02 * np.std(force)
    assert np.std(found - exact) < 0.02 * np.std(exact - force)


@pytest.mark.parametrize("frequency", [1.2, 4.0])
@pytest.mark.parametrize("loss", [0.1, 0.6])
def test_hard_flanks_push_as_long_as_those_that_an_integrator_of_others_meets(frequency, loss):
    """Within a step they are met and left: with whole steps only 3 to 25 % were left."""
    cells, fine = 1024, 15
    given = motion(frequency, samples=cells)
    gap, stiffness = 3e-4, MASS * 500.0**2
    damping = 2.0 * loss * np.sqrt(stiffness * MASS)

    def carried(depth, pace):
        beyond = depth - np.clip(depth, -0.5 * gap, 0.5 * gap)
        force = (stiffness * beyond + damping * pace) * (beyond != 0.0)
        return max(force, 0.0) if beyond > 0.0 else min(force, 0.0)

    force = MASS * given.acceleration + VISCOUS * given.velocity
    joint = Joint(stiffness, loss, gap=gap)
    found = through_joint(force, given, joint, device_of(force, given))
    dense = driven(motion(frequency, samples=cells * fine), frequency, carried)
    exact = np.roll(dense, fine // 2).reshape(cells, fine).mean(axis=1)
    assert np.std(exact - force) > 0.02 * np.std(force)
    assert np.std(found - exact) < 0.02 * np.std(exact - force)


def test_a_device_is_told_in_a_long_run_as_in_a_cycle():
    """Mass, resistances and the range of reversal, of motion that is no sine."""
    time = 1e-3 * np.arange(60_000)
    omega = 2.0 * np.pi * np.geomspace(0.1, 20.0, 40)[:, None]
    angle = omega * time + np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (40, 1))
    x, v, a = (
        1e-3 * np.sum(wave, axis=0)
        for wave in (np.sin(angle) / omega, np.cos(angle), -omega * np.sin(angle))
    )
    given = Motion(time, x, v, a, lambda orders: np.zeros((len(orders), x.size)), "none")
    force = 60.0 * a + 300.0 * v + 2e4 * v * np.abs(v) + 40.0 * v / np.hypot(v, 1e-3)
    found = device_of(force, given)
    assert found.mass == pytest.approx(60.0, rel=0.002)
    assert found.spring == 0.0
    plain = found._replace(curve=found.curve[:0])
    assert np.std(force - plain.force(given)) < 0.03 * np.std(force - 60.0 * a)


def lost(speed, power):
    """Return the force of a damper by a power of speed, one whose valve opens, or one of two."""
    if power is None:
        return 900.0 * speed - 600.0 * np.sign(speed) * np.maximum(np.abs(speed) - 0.02, 0.0)
    return np.where(speed > 0.0, 1.0, 0.5) * 500.0 * np.sign(speed) * np.abs(speed) ** power


@pytest.mark.parametrize("power", [0.3, 0.5, 1.4, None])
@pytest.mark.parametrize("yields", [0.1, 0.6])
def test_a_damper_of_any_curve_behind_a_spring_is_that_of_an_integrator(power, yields):
    """Massless: the spring carries what the damper loses, so how fast it is bent follows."""
    given, frequency = motion(0.8, samples=2048), 0.8
    force = lost(given.velocity, power)
    stiffness = float(np.abs(force).max()) / (yields * 0.008)
    found = through_joint(force, given, Joint(stiffness, 0.0), device_of(force, given))
    lines = np.fft.rfft(given.displacement) / given.time.size
    turns = 2j * np.pi * frequency * np.arange(4)
    speeds = np.linspace(-2.0, 2.0, 400_001) ** 3 * np.abs(given.velocity).max()
    by_force = lost(speeds, power)

    def rate(time, carried):
        driven = np.sum((turns * 2.0 * lines[:4] * np.exp(turns * time)).real)
        return stiffness * (driven - np.interp(carried, by_force, speeds))

    times = (6.0 + np.arange(given.time.size) / given.time.size) / frequency
    exact = solve_ivp(
        rate, (0.0, times[-1]), [0.0], method="LSODA", t_eval=times, rtol=1e-7, atol=1e-6,
        max_step=2e-3,
    ).y[0]
    assert np.std(exact - force) > 0.06 * np.std(force)
    assert np.std(found - exact) < 0.01 * np.std(exact)


@pytest.mark.parametrize(("frequency", "amplitude"), [(0.5, 0.003), (2.3, 0.0033), (5.0, 0.008)])
def test_friction_that_deflects_is_behind_the_spring_too(frequency, amplitude):
    """Dahl's equation beside a mass and a damper, against the differential equations."""
    friction, length, stiffness, damping = 107.0, 1.9e-4, 4.5e6, 1200.0
    model = ForceModel((
        FittedTerm("inertia", MASS), FittedTerm("viscous-damping", VISCOUS),
        FittedTerm("coulomb-friction", friction, {"presliding": length}),
    ))  # fmt: skip
    given = harmonic_motion(np.array([0.0, -1j * amplitude]), frequency, samples=2048)
    omega = 2.0 * np.pi * frequency

    def carried(t, state):
        x, v = amplitude * np.sin(omega * t), amplitude * omega * np.cos(omega * t)
        return stiffness * (x - state[0]) + damping * (v - state[1])

    def rate(t, state):
        _, speed, seal = state
        resisted = VISCOUS * speed + friction * seal
        return [
            speed, (carried(t, state) - resisted) / MASS, (speed - abs(speed) * seal) / length
        ]

    period = 1.0 / frequency
    steps = 6.0 * period + np.arange(2048) / 2048.0 * period
    run = solve_ivp(
        rate, (0.0, 7.0 * period), [0.0, amplitude * omega, 1.0], "LSODA", t_eval=steps,
        rtol=1e-8, atol=1e-12,
    )  # fmt: skip
    exact = carried(run.t, run.y)
    force = model.force(given)
    loss = 0.5 * damping / np.sqrt(stiffness * MASS)
    known = device_of(force, given, model.force, deflects=True)
    found = through_joint(force, given, Joint(stiffness, loss), known)
    assert np.std(found - exact) < 0.015 * np.std(exact)
    assert np.std(found - exact) < 0.25 * np.std(force - exact)
