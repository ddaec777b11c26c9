"""The wall layer's memory beside a flow that diffuses across the channel, solved ring by ring."""

import numpy as np
import pytest
from scipy.linalg import solve_banded

from models.motion import harmonic_motion, sampled_motion
from models.terms import find_term

RADIUS, VISCOSITY = 4e-3, 2e-5  # m, m^2/s: 0.8 s to diffuse
DIFFUSION = {"diffusion_time": RADIUS**2 / VISCOSITY}
RINGS = 200


def through_a_pipe(frequency, cycles, steps):
    """Return the pressure gradient over density (steps,) of a mean flow cos(w t), m/s^2.

    Rings of fluid slide past each other; the gradient is what keeps their mean as it shall be.
    """
    edges = np.linspace(0.0, RADIUS, RINGS + 1)
    area = np.pi * np.diff(edges**2)
    middle = 0.5 * (edges[1:] + edges[:-1])
    step = 1.0 / (frequency * steps)
    between = 2.0 * np.pi * VISCOSITY * edges[1:-1] / np.diff(middle)
    wall = 2.0 * np.pi * VISCOSITY * RADIUS / (RADIUS - middle[-1])
    out = np.append(between, wall)
    inner = np.append(0.0, between)
    band = np.zeros((3, RINGS))
    band[0, 1:], band[2, :-1] = -between * step / area[:-1], -between * step / area[1:]
    band[1] = 1.0 + (out + inner) * step / area
    pushed = solve_banded((1, 1), band, np.ones(RINGS))  # by a unit of impulse
    share = area / area.sum()
    speed, found = np.zeros(RINGS), []
    for n in range(1, cycles * steps + 1):
        alone = solve_banded((1, 1), band, speed)
        wanted = np.cos(2.0 * np.pi * n / steps)
        impulse = (wanted - share @ alone) / (share @ pushed)
        speed = alone + impulse * pushed
        found.append(impulse / step)
    return np.array(found[-steps:])


@pytest.mark.parametrize("frequency", [0.1, 1.0, 10.0])
def test_plug_steady_loss_and_memory_make_the_flow_in_a_pipe(frequency):
    steps = 2000
    measured = np.fft.rfft(through_a_pipe(frequency, 6 if frequency < 5.0 else 20, steps))[1]
    motion = harmonic_motion([0.0, -1j / (2.0 * np.pi * frequency)], frequency, samples=steps)
    term = find_term("unsteady-friction")
    memory = term.column(motion, DIFFUSION)
    steady = 8.0 / DIFFUSION["diffusion_time"]
    whole = motion.acceleration + steady * motion.velocity + memory
    turned = np.exp(2j * np.pi / steps)  # the rings' first sample is one step after the start
    assert abs(np.fft.rfft(whole)[1] * turned - measured) < 0.02 * abs(measured)


def test_a_record_settles_into_the_same_memory():
    cycle = harmonic_motion([0.0, -0.01j], 2.0, samples=400)
    time = np.arange(4000) / 800.0
    record = sampled_motion(time, 0.01 * np.sin(2.0 * np.pi * 2.0 * time))
    term = find_term("unsteady-friction")
    late = term.column(record, DIFFUSION)[-800:-400]
    assert late == pytest.approx(term.column(cycle, DIFFUSION), abs=0.02 * np.ptp(late))
