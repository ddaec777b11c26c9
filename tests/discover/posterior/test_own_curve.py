"""What changes a force or a motion changes friction as it turns, and not as a jump."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover.bands.extras import searched_with
from discover.posterior.grow import grown
from discover.posterior.own_curve import likely_curves, with_curve
from discover.records import Campaign, Record
from discover.study import StudyOptions
from discover.study.prepare import prepare

MASS, DAMPING, FRICTION = 110.0, 700.0, 150.0
STIFF = 3e6
"""N/m at which the seal deflects: friction over 50 um."""
SPRING = 4e6  # N/m
PLAN = ((0.5, 0.01), (1.0, 0.02), (2.0, 0.012), (4.0, 0.005), (8.0, 0.002))


def deflecting(time, speed):
    """Return friction that deflects before it slides (Dahl's equation), in a second cycle."""
    step, force, found = time[1] - time[0], 0.0, np.zeros(2 * time.size)
    for i, v in enumerate(np.tile(speed, 2)):
        found[i] = force
        sliding = FRICTION * np.sign(v)
        force = sliding + (force - sliding) * np.exp(-STIFF * abs(v) * step / FRICTION)
    return found[time.size :]


def seal(omega, amplitude, late=0.0):
    """Return one cycle of a mass, a damper and a seal, read some seconds late."""
    time = np.arange(4000) / 4000.0 * 2.0 * np.pi / omega
    x, v = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
    force = DAMPING * v - MASS * omega**2 * x + deflecting(time, v)
    return time, x, np.interp(time - late, time, force, period=time.size * time[1])


def sprung(omega, amplitude):
    """Return one cycle of a mass behind a spring, its friction reversing over a speed."""
    stiffness, loss = SPRING, 800.0
    steps = np.arange(2000) / 2000.0 * 2.0 * np.pi / omega

    def rate(t, state):
        x, v = amplitude * np.sin(omega * t), amplitude * omega * np.cos(omega * t)
        carried = stiffness * (x - state[0]) + loss * (v - state[1])
        own = DAMPING * state[1] + FRICTION * np.tanh(state[1] / 2e-3)
        return [state[1], (carried - own) / MASS]

    period = 2.0 * np.pi / omega
    begun = solve_ivp(rate, (0.0, 3.0 * period), [0.0, amplitude * omega], "LSODA", rtol=1e-8)
    run = solve_ivp(
        rate, (0.0, period), begun.y[:, -1], "LSODA", t_eval=steps, rtol=1e-8, atol=1e-10
    )
    x, v = amplitude * np.sin(omega * steps), amplitude * omega * np.cos(omega * steps)
    return steps, x, stiffness * (x - run.y[0]) + loss * (v - run.y[1])


def one_band(cycle, seed=3):
    """Return the best structure of all tests together, nothing else beside it."""
    rng, records = np.random.default_rng(seed), []
    for frequency, amplitude in PLAN:
        time, x, force = cycle(2.0 * np.pi * frequency, amplitude)
        whole = np.arange(8 * time.size) * time[1]
        noise = rng.standard_normal((2, whole.size))
        force = np.tile(force, 8) + 0.01 * force.std() * noise[0]
        shown = np.tile(x, 8) + 1e-4 * amplitude * noise[1]
        records.append(Record(f"{frequency}.csv", whole, force, shown))
    device = prepare(Campaign("seal", tuple(records)), StudyOptions()).device
    return searched_with(replace(device, bands=1), (), None)


def test_friction_that_deflects_gets_the_curve_of_that():
    found = one_band(seal)
    best, *_ = likely_curves(found.device.assessor, found.assessed)
    curved = with_curve(found.device.assessor, found.assessed, best)
    (friction,) = (p.fitted for p in curved.model.terms if p.fitted.id == "coulomb-friction")
    assert friction.term.remembers(friction.shape) == "path"
    assert friction.shape["presliding"] == pytest.approx(FRICTION / STIFF, rel=0.3)
    assert friction.coefficient == pytest.approx(FRICTION, rel=0.02)


@pytest.mark.parametrize("late", [-3e-3, 2e-3])
def test_a_delay_is_seen_beside_friction_that_deflects(late):
    found = one_band(lambda omega, amplitude: seal(omega, amplitude, late))
    ids = ("time-delay", "sensor-gain", "unsteady-friction", "saturating-damping")
    step = grown(found.device.assessor, found.assessed, ids)
    assert step.best.id == "time-delay"
    assert step.best.assessed.quiet
    (delay,) = (p.fitted for p in step.best.assessed.model.terms if p.fitted.id == "time-delay")
    assert delay.coefficient == pytest.approx(late, rel=0.02)


def test_a_spring_in_series_is_seen_beside_friction_that_reverses_over_a_speed():
    """In most draws of noise: in some friction deflects, and the spring is a tenth off."""
    right = 0
    for seed in (3, 4, 5):
        found = one_band(sprung, seed)
        step = grown(found.device.assessor, found.assessed, ("series-compliance", "cavitation"))
        assert step.best.id == "series-compliance"
        terms = {p.fitted.id: p.fitted for p in step.best.assessed.model.terms}
        friction, spring = (terms[i] for i in ("coulomb-friction", "series-compliance"))
        right += (
            friction.term.remembers(friction.shape) == "motion"
            and spring.coefficient == pytest.approx(1.0 / SPRING, rel=0.02)
        )
    assert right >= 2
