"""Motions, their fractional derivatives, noise and plans against closed forms."""

import math

import mpmath
import numpy as np
import pytest

from models.device import Device
from tests.calibration.structures.devices import Law, dean_number, draw_geometry, inertance_of
from tests.calibration.structures.motion import padded, sine
from tests.calibration.structures.noise import KINDS, Noise
from tests.calibration.structures.plans import HARMONIC, SHORT, TWISTS, draw_line, draw_plan

RATE = 2.0 * np.pi * 1.3


@pytest.mark.parametrize("order", [0.0, 0.4, 1.0, 1.37, 1.9, 2.0])
def test_a_sine_is_turned_and_scaled(order):
    time = np.arange(300) / 137.0
    motion = sine(1.3, 0.01, time, phase=0.7)
    expected = 0.01 * RATE**order * np.sin(RATE * time + 0.7 + 0.5 * np.pi * order)
    np.testing.assert_allclose(motion.samples(order), expected, atol=1e-12 * RATE**order)
    places = np.arange(motion.size) * motion.period / motion.size
    on_grid = 0.01 * RATE**order * np.sin(RATE * places + 0.7 + 0.5 * np.pi * order)
    np.testing.assert_allclose(motion.grid(order), on_grid, atol=1e-11 * RATE**order)


@pytest.mark.parametrize("order", [0.3, 0.8, 1.25, 1.75])
def test_from_rest_it_is_caputos(order):
    # x = sin^8(pi t/T): D^order x = int x^(n)(s) (t - s)^(n - 1 - order) ds/Gamma(n - order).
    length, over, rate = 2.0, 4, 200.0
    time = np.arange(round(length * rate) * over) / (rate * over)
    places = np.arange(0, time.size, over)
    course = np.sin(np.pi * time / length) ** 8
    motion = padded(course, rate, oversampling=over, pad=30.0, places=places)
    found = motion.samples(order)
    whole = math.ceil(order)

    def slope(s):
        return mpmath.diff(lambda u: mpmath.sin(mpmath.pi * u / length) ** 8, s, whole)

    scale = float(np.max(np.abs(found)))
    for t in (0.4, 0.9, 1.5, 1.95):
        # u = (t - s)^p takes the kernel's end out of the integrand.
        p = whole - order
        exact = mpmath.quad(
            lambda u, t=t, p=p: slope(t - u ** (1.0 / p)), [0.0, 0.3 * t**p, t**p]
        ) / (p * mpmath.gamma(p))
        # A course whose mean isn't zero leaves a tail of the period before.
        assert found[round(t * rate)] == pytest.approx(float(exact), abs=2e-3 * scale)


def test_a_fractional_element_lies_between_damper_and_mass():
    time = np.arange(300) / 137.0
    motion = sine(1.3, 0.01, time)
    force = Law("FOIM", fractional=50.0, order=1.6).force(motion)
    expected = 50.0 * RATE**1.6 * 0.01
    turn = 0.5 * np.pi * 1.6
    np.testing.assert_allclose(
        force, expected * (np.sin(RATE * time) * np.cos(turn) + np.cos(RATE * time) * np.sin(turn)),
        atol=1e-9 * expected,
    )


def test_terms_add_up():
    time = np.arange(200) / 137.0
    motion = sine(1.3, 0.01, time)
    law = Law("IOIM-turbulent", 100.0, 20.0, 300.0, 400.0, 1.74)
    v = 0.01 * RATE * np.cos(RATE * time)
    a = -0.01 * RATE**2 * np.sin(RATE * time)
    expected = 100.0 * a + 20.0 * v + 300.0 * v * np.abs(v)
    expected += 400.0 * np.sign(v) * np.abs(v) ** 1.74
    np.testing.assert_allclose(law.force(motion), expected, atol=1e-9)
    np.testing.assert_allclose(law.damping(motion), expected - 100.0 * a, atol=1e-9)


def test_dean_and_inertance_are_the_papers():
    device = Device.preset("device-12")
    assert dean_number(device, 2.0 * np.pi * 0.664 * 0.005) == pytest.approx(100.0, rel=1e-3)
    assert inertance_of(device) == pytest.approx(370.38, rel=1e-3)


def test_devices_can_be_built_and_differ():
    found = [inertance_of(draw_geometry(np.random.default_rng(s))) for s in range(20)]
    assert min(found) > 15.0
    assert max(found) < 900.0
    assert max(found) / min(found) > 5.0


@pytest.mark.parametrize("kind", KINDS)
def test_noise_has_its_spectrum(kind):
    noise, rng = Noise(kind, 4.0, 1.0), np.random.default_rng(5)
    sampling, size = 400.0, 4000
    frequency = np.fft.rfftfreq(size, 1.0 / sampling)
    power = np.mean(
        [np.abs(np.fft.rfft(noise.draw(size, sampling, rng), norm="ortho")) ** 2
         for _ in range(200)], axis=0,
    )
    expected = noise.power(frequency, sampling)
    smooth = np.ones(9) / 9.0
    ratio = np.convolve(power / expected, smooth, "same")[20:-20]
    assert np.all(np.abs(ratio - 1.0) < 0.25)
    assert np.max(expected[1:]) > 2.0 * np.median(expected)


@pytest.mark.parametrize("twist", TWISTS)
@pytest.mark.parametrize("seed", range(4))
def test_plans_stay_within_the_rig(twist, seed):
    runs = draw_plan(twist, (25, 40), np.random.default_rng(seed))
    assert 25 <= len(runs) <= 40
    assert len({r.file for r in runs}) == len(runs)
    for run in runs:
        motion = run.motion
        # Harmonics of 2 % make speed 1.1 and acceleration 1.26 times the sine's at most.
        assert motion.top_speed < 1.15 * 0.8
        assert np.max(np.abs(motion.a)) < 1.6 * 25.0
        assert motion.time.size < 20_000
        assert run.sampling >= 20.0 * run.frequency
        if twist != "moving":
            assert 0.1 <= run.frequency <= 12.0
            assert 0.002 <= run.amplitude <= 0.025


def test_twists_are_what_they_say():
    rng = np.random.default_rng(2)
    drive = draw_plan("harmonics", (25, 25), rng)[7].motion.lines
    np.testing.assert_allclose(np.abs(drive[2:4]) / np.abs(drive[1]), HARMONIC)
    for run in draw_plan("short", (25, 25), rng):
        cycles = run.motion.time.size / run.sampling * run.frequency
        assert cycles == pytest.approx(SHORT, abs=0.05)
    moving = draw_plan("moving", (30, 30), rng)
    kinds = {r.file.split("-")[1] for r in moving}
    assert kinds == {"sweep", "random", "noise"}
    assert all(r.amplitude is None for r in moving)


def test_moving_records_rest_first_or_have_always_run():
    for run in draw_plan("moving", (30, 30), np.random.default_rng(4)):
        x, top = run.motion.x, np.max(np.abs(run.motion.x))
        if "noise" in run.file:
            assert run.motion.repeats
        else:
            assert not run.motion.repeats
            assert np.all(np.abs(x[:3]) < 1e-3 * top)


def test_thin_plans_have_one_amplitude():
    points = draw_line(6, np.random.default_rng(1))
    assert len(points) == 6
    assert len({a for _, a in points}) == 1
