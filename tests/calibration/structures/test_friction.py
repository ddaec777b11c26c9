"""The laws of friction against closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.calibration.structures.friction import LAWS, SHAPES, Friction, draw_friction, fall, whole
from tests.calibration.structures.memory import dahl, lugre, stops, turns
from tests.calibration.structures.motion import sine

AMPLITUDE, FREQUENCY = 0.004, 0.7
TIME = np.arange(1200) / 200.0


@pytest.fixture(scope="module")
def motion():
    return sine(FREQUENCY, AMPLITUDE, TIME, phase=0.4)


def over_a_cycle(motion, shape, values):
    """Return friction over its size on the grid and the work that it takes in a cycle."""
    share = SHAPES[shape](whole(motion), values)
    return share, float(np.sum(share * motion.grid_v)) * motion.period / motion.size


def test_turns_are_where_a_path_turns():
    np.testing.assert_array_equal(turns(np.array([0.0, 1.0, 2.0, 2.0, 1.0, 3.0])), [0, 3, 4, 5])
    np.testing.assert_array_equal(turns(np.zeros(4)), [0, 3])


@pytest.mark.parametrize("length", [2e-5, 4e-4, 1.5e-3])
def test_dahl_loops_as_in_closed_form(motion, length):
    # From side to side z = 1 - (1 + z0) exp(-s/length): ends at +-tanh(A/length).
    share, work = over_a_cycle(motion, "dahl", {"length": length})
    depth = np.tanh(AMPLITUDE / length)
    assert share.max() == pytest.approx(depth, rel=1e-6)
    assert work == pytest.approx(4.0 * (AMPLITUDE - length * depth), rel=1e-3)


@pytest.mark.parametrize("length", [2e-5, 4e-4, 1.5e-3])
def test_elastic_then_slip_takes_the_work_of_a_parallelogram(motion, length):
    share, work = over_a_cycle(motion, "slip", {"length": length})
    assert share.max() == 1.0
    assert work == pytest.approx(4.0 * (AMPLITUDE - length), rel=1e-3)


def test_an_elastic_slider_that_never_slips_takes_no_work(motion):
    _, work = over_a_cycle(motion, "slip", {"length": 1.5 * AMPLITUDE})
    assert abs(work) < 1e-5 * AMPLITUDE


def test_sliders_add_up(motion):
    values = {"count": 2.0, "length0": 1e-4, "length1": 1e-3, "weight0": 0.3, "weight1": 0.7}
    _, work = over_a_cycle(motion, "sliders", values)
    assert work == pytest.approx(4.0 * (AMPLITUDE - 0.3e-4 - 0.7e-3), rel=1e-3)


def test_friction_at_once_takes_four_strokes(motion):
    _, work = over_a_cycle(motion, "jump", {})
    assert work == pytest.approx(4.0 * AMPLITUDE, rel=1e-3)


@pytest.mark.parametrize("speed", [0.001, 0.02, -0.005])
def test_lugre_slides_at_its_steady_limit(speed):
    values = {"stribeck_speed": 0.004, "bend": 2.0, "excess": 0.4}
    step = 1e-4
    x = speed * step * np.arange(4000)
    limit = fall(np.full(x.size, speed), values)
    found = lugre(x, limit, 2e-5, 2e-4, step)
    assert found[-1] == pytest.approx(np.sign(speed) * limit[0], rel=1e-6)


def test_lugre_is_the_solution_of_its_equation(motion):
    values = {
        "stribeck_speed": 0.003, "bend": 1.5, "excess": 0.3, "length": 6e-5, "lag": 2e-4,
    }
    rate = 2.0 * np.pi * FREQUENCY

    def slope(t, z):
        v = AMPLITUDE * rate * np.cos(rate * t + 0.4)
        return (v - np.abs(v) * z / fall(v, values)) / values["length"]

    t = motion.period * (2.0 + np.arange(motion.size) / motion.size)
    solved = solve_ivp(
        slope, (0.0, t[-1]), [0.0], t_eval=t, method="LSODA", rtol=1e-9, atol=1e-11, max_step=0.002
    )
    expected = solved.y[0] + values["lag"] * slope(t, solved.y[0])
    share, _ = over_a_cycle(motion, "lugre", values)
    assert np.max(np.abs(share - expected)) < 2e-3


def test_a_path_from_rest_starts_undeflected():
    x = np.linspace(0.0, 1e-3, 50)
    assert stops(x, np.array([1e-2]))[0, 0] == 0.0
    assert dahl(x, 1e-3)[-1] == pytest.approx(1.0 - np.exp(-1.0))


@pytest.mark.parametrize("law", LAWS)
def test_every_law_resists(law):
    motions = [
        sine(f, a, TIME, phase=1.0) for f, a in ((0.2, 0.003), (1.0, 0.003), (5.0, 0.01))
    ]
    for seed in range(5):
        friction = draw_friction(law, 80.0, motions, np.random.default_rng(seed))
        for i, motion in enumerate(motions):
            force = friction.grid_force(motion, i)
            work = float(np.sum(force * motion.grid_v)) * motion.period / motion.size
            most = 4.0 * 80.0 * friction.factors[i] * motion.stroke
            # A Stribeck fall makes slow friction up to half as great again.
            assert 0.2 * most < work < 1.55 * most


def test_size_differs_by_record_only_under_that_law():
    motions = [sine(1.0, 0.004, TIME)] * 30
    for law in LAWS:
        factors = draw_friction(law, 1.0, motions, np.random.default_rng(3)).factors
        assert (np.std(factors) > 0.05) == (law == "differs")


def test_samples_and_grid_see_the_same_friction(motion):
    friction = Friction("dahl", "dahl", 50.0, {"length": 1e-4}, (1.0,))
    on_grid = np.interp(
        np.mod(TIME, motion.period), np.arange(motion.size + 1) * motion.period / motion.size,
        np.append(friction.grid_force(motion, 0), friction.grid_force(motion, 0)[0]),
    )
    np.testing.assert_allclose(friction.force(motion, 0), on_grid, atol=1e-6)
