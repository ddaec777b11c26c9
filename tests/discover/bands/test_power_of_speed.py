"""A damper without inertance whose loss goes with a power of speed, behind oil that yields."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover.bands.ways import found
from discover.records import Campaign, Record
from discover.study import StudyOptions
from discover.study.prepare import prepare

pytestmark = pytest.mark.sweep
SIZE, POWER, SPRING = 4.0e4, 0.4, 2.5e7  # N (s/m)^0.4, N/m
NOISE = 0.01


def sine_test(frequency, amplitude, rng):
    """The spring's force F follows from K (v - w), the damper's speed w from F by its own law."""
    omega = 2.0 * np.pi * frequency

    def rate(t, force):
        speed = np.sign(force) * (np.abs(force) / SIZE) ** (1.0 / POWER)
        return SPRING * (amplitude * omega * np.cos(omega * t) - speed)

    time = np.linspace(0.0, 8.0 / frequency, 1600, endpoint=False)
    force = solve_ivp(
        rate, (0.0, time[-1]), [0.0], t_eval=time, rtol=1e-8, atol=1e-3, method="LSODA"
    ).y[0]
    later = time >= 4.0 / frequency
    time, force = time[later] - time[later][0], force[later]
    force = force + NOISE * np.std(force) * rng.standard_normal(force.size)
    x = amplitude * np.sin(omega * time) + 1e-7 * rng.standard_normal(time.size)
    return Record(f"{frequency:g}hz-{1e3 * amplitude:g}mm.csv", time, force, x)


@pytest.fixture(scope="module")
def answer():
    rng = np.random.default_rng(11)
    records = [sine_test(f, a, rng) for f in (0.2, 0.7, 2.0) for a in (0.005, 0.02, 0.06)]
    return found(prepare(Campaign("power of speed", tuple(records)), StudyOptions()).device)


def test_the_structure_is_a_power_of_speed_alone(answer):
    (structure,) = answer.banded.variants
    assert [t.id for p in answer.variants[structure].parts for t in p.terms] == [
        "power-law-damping"
    ]


def test_power_size_and_the_oils_spring_are_those_that_were_made(answer):
    known = {p.fitted.id: p.fitted for p in answer.assessed.predicting.model.terms}
    assert known["power-law-damping"].shape["exponent"] == pytest.approx(POWER, abs=0.005)
    assert known["power-law-damping"].coefficient == pytest.approx(SIZE, rel=0.01)
    assert known["series-compliance"].coefficient == pytest.approx(1.0 / SPRING, rel=0.02)


def test_nothing_but_noise_is_left(answer):
    assert answer.quiet
