import numpy as np
import pytest

from models.rig import TestPoint, sine_point
from models.rig.drive import make_drive


def rng(seed=0):
    return np.random.default_rng(seed)


def test_undistorted_sine_is_exact_with_its_derivatives():
    drive = make_drive(sine_point(3.0, 0.01), rng(), distortion=0.0)
    amplitude = np.max(np.abs(drive.position))
    assert amplitude == pytest.approx(0.01, rel=0.02)
    omega = 6 * np.pi
    angle = omega * (drive.time + drive.phase)
    for values, exact in (
        (drive.position, np.sin(angle)),
        (drive.velocity, omega * np.cos(angle)),
        (drive.acceleration, -(omega**2) * np.sin(angle)),
    ):
        found = drive.sample(values) / amplitude
        np.testing.assert_allclose(found, exact, atol=1e-6 * np.max(np.abs(exact)))


def test_distortion_has_its_size_and_the_fundamental_stays():
    drive = make_drive(sine_point(3.0, 0.01), rng(), distortion=0.02)
    lines = np.abs(np.fft.rfft(drive.position)) * 2 / drive.position.size
    assert lines[1] == pytest.approx(0.01, rel=0.02)
    assert 0.003 < lines[2] / lines[1] < 0.021
    assert np.all(lines[6:] < 1e-12)


def test_record_begins_at_zero_after_its_lead():
    drive = make_drive(TestPoint(2.0, 0.01, cycles=4, sampling=500.0), rng())
    assert drive.time[drive.lead] == 0.0
    assert drive.time.size - drive.lead == 1000
    assert drive.lead == 50


def test_fractional_cycles_are_possible():
    drive = make_drive(TestPoint(2.0, 0.01, cycles=4.3, sampling=500.0), rng())
    assert drive.time.size - drive.lead == 1075


@pytest.mark.parametrize("kind", ["sweep", "random"])
def test_transients_go_from_rest_to_rest_within_the_amplitude(kind):
    point = TestPoint(0.5, 0.01, cycles=10, sampling=500.0, kind=kind, upper=5.0)
    drive = make_drive(point, rng())
    x, v = drive.sample(drive.position), drive.sample(drive.velocity)
    before = drive.time <= 0.0
    assert np.max(np.abs(x[before])) == 0.0
    assert np.max(np.abs(v[before])) < 1e-4 * np.max(np.abs(v))
    assert np.max(np.abs(x)) == pytest.approx(0.01, rel=1e-3)
    assert abs(x[-1]) < 1e-5


def test_transient_velocity_is_the_derivative():
    point = TestPoint(0.5, 0.01, cycles=10, sampling=500.0, kind="sweep", upper=5.0)
    drive = make_drive(point, rng())
    central = (np.roll(drive.position, -1) - np.roll(drive.position, 1)) / (2 * drive.step)
    scale = np.max(np.abs(drive.velocity))
    assert np.max(np.abs(central - drive.velocity)) < 1e-3 * scale


def test_sweep_passes_through_its_band():
    point = TestPoint(0.5, 0.01, cycles=10, sampling=500.0, kind="sweep", upper=8.0)
    drive = make_drive(point, rng())
    x = drive.sample(drive.position)[drive.lead :]
    crossings = np.flatnonzero(np.diff(np.sign(x)) != 0) / 500.0
    rates = 0.5 / np.diff(crossings)
    assert rates[0] < 0.8
    assert rates[-2] > 6.5


def test_one_generator_decides_everything():
    one, two = (make_drive(sine_point(3.0, 0.01), rng(4)) for _ in range(2))
    np.testing.assert_array_equal(one.position, two.position)
    assert one.phase == two.phase
    assert make_drive(sine_point(3.0, 0.01), rng(5)).phase != one.phase
