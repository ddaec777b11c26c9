"""What displacement noise makes of the force, against many noisy copies of records."""

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.records import Record
from discover.rows import force_rows, record_rows
from models.constitutive import FittedTerm, ForceModel

MASS, DAMPING, STIFFNESS = 12.0, 80.0, 9000.0
NOISE = 6e-6
PLAN = ((0.5, 0.010), (2.0, 0.005), (5.0, 0.003), (8.0, 0.002), (12.0, 0.001))
DRIVE = {1: 1.0, 2: 0.02, 3: 0.03}
TRUE = ForceModel(
    tuple(
        FittedTerm(name, value, {})
        for name, value in (
            ("inertia", MASS), ("viscous-damping", DAMPING), ("stiffness", STIFFNESS)
        )
    )
)


def record(frequency, amplitude, rng, *, noise=NOISE, force_noise=4e-3):
    """Return a test of a mass, a damper and a spring, driven with harmonics."""
    time = np.arange(round(8.3 * 120)) / (120.0 * frequency)
    omega = 2.0 * np.pi * frequency
    x, v, a = (
        sum(
            amplitude * share * (k * omega) ** n
            * np.sin(k * omega * time + 0.7 * k + 0.5 * np.pi * n)
            for k, share in DRIVE.items()
        )
        for n in range(3)
    )
    force = MASS * a + DAMPING * v + STIFFNESS * x
    force = force + force_noise * np.std(force) * rng.standard_normal(time.size)
    return Record(f"{frequency}.csv", time, force, x + noise * rng.standard_normal(time.size))


def campaigns(count, **more):
    rng = np.random.default_rng(3)
    return [observe_all([record(f, a, rng, **more) for f, a in PLAN], 1) for _ in range(count)]


def test_the_true_law_leaves_noise_of_the_size_that_rows_have():
    """Of the harmonics that are driven, to a factor of 1.3, as noise is known elsewhere.

    By the force's noise alone the true law would leave 60 to 230 times as much above 2 Hz.
    """
    left = []
    for seen in campaigns(30):
        for o in seen:
            rows = record_rows(o)
            left.append((rows.target - force_rows(rows, TRUE))[1:7] ** 2)
    by_test = np.mean(np.array(left).reshape(30, len(PLAN), 6), axis=(0, 2))
    assert np.all(np.abs(np.log(by_test)) < 2.0 * np.log(1.3))


def test_without_displacement_noise_nothing_is_added():
    for o in campaigns(1, noise=0.0)[0]:
        (window,) = o.windows
        assert np.sqrt(window.through.sum()) < 1e-3 * o.force_noise


def test_the_error_is_what_copies_of_a_record_scatter_by():
    """Over copies the motion's harmonics, and what they make, scatter as is said."""
    copies = [seen[4] for seen in campaigns(60)]
    omega = 2.0 * np.pi * 12.0 * np.arange(4)
    stiffness = np.abs(STIFFNESS - MASS * omega**2 + 1j * DAMPING * omega)
    known = np.array([o.windows[0].through[:4] for o in copies]).mean(axis=0)
    expected = (stiffness * NOISE) ** 2 / copies[0].samples
    assert known[1:] == pytest.approx(expected[1:], rel=0.25)


def test_a_test_without_displacement_has_none():
    time = np.arange(800) / 100.0
    lone = Record("f.csv", time, np.cos(2 * np.pi * time), frequency=1.0, amplitude=0.01)
    (seen,) = observe_all([lone], 1)
    assert seen.windows[0].through is None


@pytest.mark.parametrize("frequency", [11.0, 12.12, 13.4, 14.88])
def test_two_tests_at_nearly_one_frequency_say_no_more_of_higher_ones_than_one(frequency):
    """A little more force in one of them is none of the frequency's."""
    rng = np.random.default_rng(5)
    lower = [record(f, a, rng) for f, a in PLAN[:4]]
    first, second = record(frequency, 0.001, rng), record(1.01 * frequency, 0.001, rng)
    stronger = Record("stronger.csv", first.time, 1.2 * first.force, first.displacement)

    def third_harmonic(*tests):
        return np.sqrt(observe_all([*lower, *tests], 1)[-1].windows[0].through[3])

    assert third_harmonic(stronger, second) == pytest.approx(third_harmonic(second), rel=0.3)
