"""Friction that reverses over a displacement, after Dahl, behind a soft spring; by SciPy."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover import run_study
from discover.posterior.grow import grown
from discover.records import Campaign
from tests.discover.gap_data import record
from tests.discover.posterior.small import assessor_of, model_of, rows_of

MASS, VISCOUS = 2.0, 12.0
FRICTION, PRESLIDING = 0.8, 6e-5
"""N, and m over which it reverses."""
STIFFNESS, LOSS = 1200.0, 2.0
"""N/m of the spring, and N s/m beside it."""
PLAN = ((0.2, 0.03), (0.6, 0.015), (1.0, 0.015), (1.7, 0.03), (0.4, 0.008))
CYCLES, POINTS = 5, 4096


@cache
def cycle(frequency, amplitude):
    """Return the spring's force over one cycle, once it repeats."""
    omega = 2.0 * np.pi * frequency

    def carried(t, place, pace):
        spring = STIFFNESS * (amplitude * np.sin(omega * t) - place)
        return spring + LOSS * (amplitude * omega * np.cos(omega * t) - pace)

    def slope(t, y):
        place, pace, bent = y
        push = carried(t, place, pace) - VISCOUS * pace - FRICTION * bent
        return pace, push / MASS, (pace - abs(pace) * bent) / PRESLIDING

    times = (CYCLES + np.arange(POINTS) / POINTS) / frequency
    found = solve_ivp(
        slope, (0.0, times[-1]), (0.0, amplitude * omega, 0.0), method="LSODA", t_eval=times,
        rtol=1e-7, atol=1e-10,
    )
    return carried(times, found.y[0], found.y[1])


def law(t, x, v, a):
    """Return its force in one of the tests."""
    amplitude = float(np.abs(x).max())
    ratio = float(np.abs(v).max()) / amplitude / (2.0 * np.pi)
    frequency, amplitude = min(PLAN, key=lambda p: abs(p[0] - ratio) + abs(p[1] - amplitude))
    force = cycle(frequency, amplitude)
    phase = np.mod(t * frequency, 1.0)
    return np.interp(phase, np.arange(POINTS + 1) / POINTS, np.append(force, force[0]))


def test_the_spring_is_found_with_the_curve_that_friction_has_behind_it():
    assessor = assessor_of(rows_of(law, PLAN, cycles=3))
    start = model_of(inertia=1.0, viscous_damping=10.0, coulomb_friction=1.0)
    now = assessor.assess(start, assessor.space.start)
    step = grown(assessor, now, ("series-compliance", "relaxation", "time-delay"))
    assert step.best.id == "series-compliance"
    found = {p.fitted.id: p.fitted for p in step.best.assessed.model.terms}
    assert found["inertia"].coefficient == pytest.approx(MASS, rel=0.03)
    assert found["viscous-damping"].coefficient == pytest.approx(VISCOUS, rel=0.05)
    assert found["coulomb-friction"].coefficient == pytest.approx(FRICTION, rel=0.05)
    assert found["coulomb-friction"].shape["presliding"] == pytest.approx(PRESLIDING, rel=0.5)
    assert found["series-compliance"].coefficient == pytest.approx(1.0 / STIFFNESS, rel=0.03)


@pytest.mark.sweep
def test_a_study_names_structure_and_spring():
    rng = np.random.default_rng(1)
    records = tuple(record(f, a, law, rng, noise=0.01) for f, a in PLAN)
    (band,) = run_study(Campaign("behind a spring", records)).bands
    assert band.structure == "IOIM-linear"
    assert band.probability > 0.8
    spring = next(e for e in band.extras if e.term.fitted.id == "series-compliance")
    assert spring.probability > 0.9
    inertance = next(t for t in band.terms if t.fitted.id == "inertia")
    low, high = inertance.interval
    assert low <= MASS * 1.01 and high >= MASS * 0.99 and high - low < 0.1 * MASS
    assert band.relative_error_percent < 1.5 * band.noise_percent
