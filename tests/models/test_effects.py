"""Effects against what is known exactly: filters, energy, limits, memory."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models.constitutive import FittedTerm, ForceModel
from models.motion import Motion, harmonic_motion, sine_motion
from models.terms import TERMS

MOTION = sine_motion(0.01, 3.0, samples=2048)
OMEGA = 2.0 * np.pi * 3.0
LINEAR = (FittedTerm("inertia", 200.0), FittedTerm("viscous-damping", 900.0))
CONTRACT = {
    "inertia", "viscous-damping", "quadratic-damping", "power-law-damping", "coulomb-friction",
    "fractional-derivative", "stiffness", "cubic-stiffness", "force-offset", "asymmetric-damping",
    "stribeck-friction", "time-delay", "series-compliance", "end-stop", "backlash", "cavitation",
    "hysteresis", "position-dependent-friction", "thermal-drift", "sensor-gain", "sensor-drift",
    "sensor-clipping",
}


def force(*terms, motion=MOTION):
    return ForceModel(tuple(terms)).force(motion)


def line(values, harmonic=1):
    return np.fft.rfft(values)[harmonic] / values.size


def test_the_catalogue_holds_the_contracts():
    assert set(TERMS) >= CONTRACT
    for term in TERMS.values():
        assert (term.column is None) != (term.transform is None)
        assert set(term.mistaken_for) <= set(TERMS) - {term.id}


@pytest.mark.parametrize("compliance", [1e-6, 3e-6, 1e-5])
def test_compliance_before_a_linear_device_is_its_transfer_function(compliance):
    shape = {"loss": 0.02}
    found = force(*LINEAR, FittedTerm("series-compliance", compliance, shape))
    device = -200.0 * OMEGA**2 + 1j * OMEGA * 900.0
    mount = 1.0 / compliance + 1j * OMEGA * 2.0 * 0.02 * np.sqrt(200.0 / compliance)
    expected = line(force(*LINEAR)) / (1.0 + device / mount)
    assert abs(line(found) - expected) < 0.04 * abs(expected)


def test_a_stiff_joint_without_play_changes_next_to_nothing():
    whole = force(*LINEAR, FittedTerm("series-compliance", 1e-10, {"loss": 0.2}))
    np.testing.assert_allclose(whole, force(*LINEAR), atol=0.03 * np.abs(whole).max())


def test_play_passes_no_more_than_the_device_and_loses_energy_at_the_flanks():
    shape = {"gap": 1e-3, "contact": 300.0, "loss": 0.3}
    played = force(*LINEAR, FittedTerm("backlash", 1.0, shape))
    assert np.mean(played * MOTION.velocity) > 0.0
    assert np.mean(np.abs(played) < 0.02 * np.abs(played).max()) > 0.05


def test_torn_oil_carries_no_more_than_its_limit():
    limit = 300.0
    shape = {"limit": limit, "contact": 300.0, "refill": 1.0, "side": -1.0}
    cut = force(*LINEAR, FittedTerm("cavitation", 1.0, shape))
    assert cut.min() > -1.1 * limit
    assert force(*LINEAR).min() < -2.0 * limit


def test_a_clipped_channel_is_flat_at_the_limit_and_untouched_below():
    whole = force(*LINEAR)
    limit = 0.5 * np.abs(whole).max()
    seen = force(*LINEAR, FittedTerm("sensor-clipping", 1.0, {"limit": limit}))
    np.testing.assert_allclose(seen, np.clip(whole, -limit, limit))


@pytest.mark.parametrize("form", [0.0, 1.0, 2.0])
def test_hysteresis_dissipates_and_saturates(form):
    small, large = sine_motion(1e-5, 1.0), sine_motion(0.02, 1.0)
    term = FittedTerm("hysteresis", 50.0, {"yield_displacement": 1e-3, "form": form})
    assert np.abs(force(term, motion=large)).max() == pytest.approx(50.0, rel=0.02)
    stiff = force(term, motion=small)
    assert np.abs(np.ptp(stiff)) < 0.05 * 50.0
    work = np.mean(force(term, motion=large) * large.velocity)
    assert work == pytest.approx(50.0 * 4.0 * 0.02 * 1.0, rel=0.15)


def test_a_jenkins_slider_is_a_spring_until_it_slips():
    motion = sine_motion(5e-4, 1.0)
    found = force(FittedTerm("hysteresis", 50.0, {"yield_displacement": 1e-3}), motion=motion)
    slope = np.polyfit(motion.displacement, found, 1)[0]
    assert slope == pytest.approx(50.0 / 1e-3, rel=1e-6)


def test_stribeck_falls_to_nothing_at_speed_in_every_form():
    slow, fast = sine_motion(1e-5, 1.0), sine_motion(0.1, 5.0)
    for form in (0.0, 1.0, 2.0):
        term = FittedTerm("stribeck-friction", 10.0, {"stribeck_velocity": 0.01, "form": form})
        assert np.abs(force(term, motion=slow)).max() == pytest.approx(10.0, rel=0.01)
        assert np.median(np.abs(force(term, motion=fast))) < 0.01


def test_bristles_follow_the_sign_of_speed_when_they_are_short():
    shape = {"presliding": 1e-6}
    found = force(FittedTerm("coulomb-friction", 1.0, shape))
    assert np.mean(found == np.sign(MOTION.velocity)) > 0.5
    np.testing.assert_allclose(np.median(found * np.sign(MOTION.velocity)), 1.0, atol=1e-6)


def test_an_end_stop_acts_only_beyond_its_gap_and_only_outwards():
    term = FittedTerm("end-stop", 1e5, {"gap": 0.008})
    found = force(term)
    inside = np.abs(MOTION.displacement) < 0.008
    assert not found[inside].any()
    assert np.all(found * MOTION.displacement >= 0.0)
    assert found.max() == pytest.approx(1e5 * 0.002, rel=1e-4)


def test_a_stop_that_dissipates_pushes_harder_on_approach_and_never_pulls():
    """By its laws at one depth: k d (1 + b v), k (d + T v), k d (1 + (b v)^2), k d (1 +- e)."""
    x, v = MOTION.displacement, MOTION.velocity
    depth, approach = np.maximum(np.abs(x) - 0.008, 0.0), v * np.sign(x)
    inside = depth > 0.0
    spring = 1e5 * depth * np.sign(x)

    def stop(**shape):
        return force(FittedTerm("end-stop", 1e5, {"gap": 0.008, **shape}))

    bumper = spring * np.maximum(1.0 + 40.0 * approach, 0.0)
    np.testing.assert_allclose(stop(loss=40.0), bumper, atol=1e-9)
    damped = 1e5 * np.maximum(depth + 0.02 * approach, 0.0) * np.sign(x) * inside
    np.testing.assert_allclose(stop(damping_time=0.02), damped, atol=1e-9)
    cushion = spring * np.where(approach > 0.0, 1.0 + (40.0 * approach) ** 2, 1.0)
    np.testing.assert_allclose(stop(loss=40.0, form=1.0), cushion, atol=1e-9)
    dry = spring * (1.0 + 0.3 * np.sign(approach))
    np.testing.assert_allclose(stop(dry_loss=0.3), dry, atol=1e-9)
    assert (stop(loss=40.0) * x).min() == 0.0


def test_effects_leave_their_input_unchanged_and_scale_in_time():
    motion = harmonic_motion([0.0, -0.01j, 0.001], 2.0, samples=512)
    slower = harmonic_motion([0.0, -0.01j, 0.001], 1.0, samples=512)
    for array in (motion.displacement, motion.velocity, motion.acceleration, motion.time):
        array.flags.writeable = False
    term = FittedTerm("hysteresis", 3.0, {"yield_displacement": 2e-3})
    np.testing.assert_array_equal(force(term, motion=motion), force(term, motion=slower))


def test_drifts_start_at_nothing_and_settle():
    found = force(FittedTerm("sensor-drift", 7.0, {"settling_time": 0.01}))
    assert found[0] == 0.0
    assert found[-1] == pytest.approx(7.0, rel=1e-6)
    roots = {"settling_time": 1e4, "stretching_exponent": 0.5}  # of what lasts far longer
    early = force(FittedTerm("sensor-drift", 7.0, roots))
    assert early[400] / early[100] == pytest.approx(2.0, rel=1e-2)
    gain = FittedTerm("sensor-gain", 0.1)
    np.testing.assert_allclose(force(*LINEAR, gain), 1.1 * force(*LINEAR))


def test_a_late_channel_is_later_at_a_lower_sampling_rate():
    """Where it is some samples late; 1 ms at 1 kHz are 4 ms in a motion of 250 Hz."""
    rate = 1.0 / MOTION.step
    late = force(*LINEAR, FittedTerm("time-delay", 1e-3, {"sampling": 4.0 * rate}))
    np.testing.assert_allclose(late, force(*LINEAR, FittedTerm("time-delay", 4e-3)))


def test_marks_of_a_tool_are_a_cosine_along_the_stroke():
    x, v = MOTION.displacement, MOTION.velocity
    shape = {"power": 0.0, "form": 3.0, "width": 0.004, "place": 0.001}
    found = force(FittedTerm("position-dependent-friction", 7.0, shape))
    np.testing.assert_allclose(found, 7.0 * np.sin(2.0 * np.pi * x / 0.004) * np.sign(v), atol=1e-9)


def test_a_gain_settles_after_the_record_s_start():
    found = force(*LINEAR, FittedTerm("sensor-gain", 0.1, {"settling_time": 0.2}))
    elapsed = MOTION.time - MOTION.time[0]
    expected = (1.1 - 0.1 * np.exp(-elapsed / 0.2)) * force(*LINEAR)
    np.testing.assert_allclose(found, expected)


def test_a_gain_behind_a_filter_is_less_and_late_where_forces_are_fast():
    motion = sine_motion(0.01, 2.0, samples=512)
    damped = FittedTerm("viscous-damping", 300.0)
    gain = FittedTerm("sensor-gain", 0.2, {"filter_time": 0.05})
    found = force(damped, gain, motion=motion)
    part = 0.2 / (1.0 + 2j * np.pi * 2.0 * 0.05)
    phase = 2.0 * np.pi * 2.0 * motion.time
    top = 300.0 * 0.01 * 2.0 * np.pi * 2.0
    expected = top * np.real((1.0 + part) * np.exp(1j * phase))
    np.testing.assert_allclose(found, expected, atol=1e-9 * top)


def test_a_filter_settles_on_a_ramp_as_its_differential_equation_says():
    time = np.linspace(0.0, 1.0, 401)
    rest = np.zeros_like(time)
    ramp = Motion(time, 0.3 * time, 0.3 + rest, rest, lambda orders: rest, "none")
    gain = FittedTerm("sensor-gain", 1.0, {"filter_time": 0.07})
    spring = FittedTerm("stiffness", 10.0)
    passed = force(spring, gain, motion=ramp) - force(spring, motion=ramp)
    expected = 3.0 * (time - 0.07 * (1.0 - np.exp(-time / 0.07)))
    np.testing.assert_allclose(passed, expected, atol=1e-10)


def test_friction_reverses_along_another_curve():
    found = force(FittedTerm("coulomb-friction", 7.0, {"transition_speed": 0.02, "form": 1.0}))
    v = MOTION.velocity
    np.testing.assert_allclose(found, 7.0 * np.sin(np.arctan(v / 0.02)))


@pytest.mark.parametrize("form", [0.0, 1.0])
def test_a_sharp_knee_is_a_line_up_to_a_limit_and_a_plain_one_is_the_plain_curve(form):
    shape = {"transition_speed": 0.02, "form": form}
    plain, same, sharp = (
        force(FittedTerm("coulomb-friction", 7.0, {**shape, "sharpness": m}))
        for m in (0.0, 1.0, 20.0)
    )
    np.testing.assert_allclose(same, plain, atol=1e-12)
    line = 7.0 * np.clip(MOTION.velocity / 0.02, -1.0, 1.0)
    np.testing.assert_allclose(sharp, line, atol=0.05 * 7.0)


@pytest.mark.parametrize(("form", "curve"), [(0.0, np.tanh), (1.0, lambda u: np.sin(np.arctan(u)))])
def test_a_share_of_friction_may_reverse_over_another_speed(form, curve):
    shape = {"transition_speed": 0.02, "form": form, "other_speed": 0.15, "other_share": 0.3}
    found = force(FittedTerm("coulomb-friction", 7.0, shape))
    v = MOTION.velocity
    np.testing.assert_allclose(found, 4.9 * curve(v / 0.02) + 2.1 * curve(v / 0.15), atol=1e-12)
    jumping = force(FittedTerm("coulomb-friction", 7.0, {**shape, "other_speed": 0.0}))
    np.testing.assert_allclose(jumping, 4.9 * curve(v / 0.02) + 2.1 * np.sign(v), atol=1e-12)


def test_a_zero_that_wanders_is_a_sum_of_powers_of_time():
    powers = [FittedTerm("sensor-drift", c, {"power": p}) for c, p in ((2.0, 1.0), (-30.0, 3.0))]
    elapsed = MOTION.time - MOTION.time[0]
    np.testing.assert_allclose(force(*powers), 2.0 * elapsed - 30.0 * elapsed**3)


def test_friction_at_a_place_is_there_and_nowhere_else():
    """A bump is whole at its place, a step half; three widths away there is nothing, or all."""
    x, v = MOTION.displacement, MOTION.velocity
    shape = {"power": 0.0, "place": 0.004, "width": 0.001}
    near, far = np.abs(x - 0.004) < 1e-5, np.abs(x - 0.004) > 0.003
    bump = force(FittedTerm("position-dependent-friction", 7.0, shape))
    np.testing.assert_allclose(bump[near], 7.0 * np.sign(v[near]), rtol=1e-3)
    assert np.abs(bump[far]).max() < 0.001 * 7.0
    step = force(FittedTerm("position-dependent-friction", 7.0, {**shape, "form": 2.0}))
    np.testing.assert_allclose(step[near], 3.5 * np.sign(v[near]), rtol=0.02)
    beyond = far & (x > 0.004)
    np.testing.assert_allclose(step[beyond], 7.0 * np.sign(v[beyond]), rtol=0.01)
    assert np.abs(step[far & ~beyond]).max() < 0.02


def test_bristles_that_slip_slowly_hold_what_friction_at_that_speed_is():
    """LuGre's limits: deflected far, the state is the falling friction; it starts as a spring."""
    length, fall = 2e-6, 0.05
    shape = {"stribeck_velocity": fall, "presliding": length}
    found = force(FittedTerm("stribeck-friction", 10.0, shape))
    v = MOTION.velocity
    slipping = np.abs(v) > 0.3 * np.abs(v).max()
    expected = 10.0 * np.exp(-((v / fall) ** 2)) * np.sign(v)
    assert np.abs(found - expected)[slipping].max() < 0.1
    slow = sine_motion(1e-6, 0.01, samples=4096)  # deflects by less than it takes to slip
    soft = force(FittedTerm("stribeck-friction", 10.0, {**shape, "presliding": 1e-4}), motion=slow)
    np.testing.assert_allclose(np.ptp(soft), 10.0 * np.ptp(slow.displacement) / 1e-4, rtol=0.03)


def test_a_gain_of_one_direction_leaves_the_other():
    plain = force(*LINEAR)
    found = force(*LINEAR, FittedTerm("sensor-gain", -0.1, {"one_way": 1.0, "side": 1.0}))
    np.testing.assert_allclose(found, np.where(plain > 0.0, 0.9 * plain, plain))


@pytest.mark.parametrize(
    ("share", "load", "left"),
    [(0.7, 1e-4, 1.0), (0.7, 1e4, 0.3), (-0.5, 1e-4, 1.0), (-0.5, 1e4, 1.5)],
)
def test_load_takes_a_spring_s_gas_or_opens_its_joints(share, load, left):
    """Far below the force of half the change the spring is as unloaded, far above all changed."""
    compliance = 1e-5
    top = float(np.abs(force(*LINEAR)).max())
    shape = {"loss": 0.02, "half_load": top / load, "load_share": share}
    found = force(*LINEAR, FittedTerm("series-compliance", compliance, shape))
    device = -200.0 * OMEGA**2 + 1j * OMEGA * 900.0
    spring = 1.0 / (left * compliance)
    mount = spring + 1j * OMEGA * 2.0 * 0.02 * np.sqrt(200.0 * spring)
    expected = line(force(*LINEAR)) / (1.0 + device / mount)
    assert abs(line(found) - expected) < 0.01 * abs(expected)


def test_gas_on_one_side_softens_that_side_only():
    shape = {"loss": 0.02, "half_load": 300.0, "load_share": 0.7, "side": 1.0}
    found = force(*LINEAR, FittedTerm("series-compliance", 1e-5, shape))
    mirrored = force(*LINEAR, FittedTerm("series-compliance", 1e-5, {**shape, "side": -1.0}))
    half = found.size // 2
    np.testing.assert_allclose(np.roll(mirrored, half), -found, atol=0.02 * np.abs(found).max())
    assert np.abs(line(found, 2)) > 0.005 * np.abs(line(found))


def test_a_valve_that_closes_late_holds_the_limit_longer_and_slams():
    limit, lag = 300.0, 5e-3
    shape = {"limit": limit, "contact": 600.0, "loss": 0.4, "refill": 1.0, "side": -1.0}
    at_once = force(*LINEAR, FittedTerm("cavitation", 1.0, shape))
    late = force(*LINEAR, FittedTerm("cavitation", 1.0, {**shape, "lag": lag}))
    held = [np.count_nonzero(f < -0.999 * limit) * MOTION.step for f in (at_once, late)]
    assert held[1] - held[0] == pytest.approx(lag, rel=0.15)
    jumps = [np.diff(f).max() for f in (at_once, late)]
    assert jumps[1] > 2.0 * jumps[0]


def test_a_valve_s_resistance_deepens_the_limit_by_what_it_makes_up():
    """From where suction meets the limit: m u' + c u = -limit + r (v - u), until flow turns."""
    limit, resistance = 300.0, 1500.0
    shape = {"limit": limit, "contact": 2000.0, "loss": 0.4, "refill": 1.0, "side": -1.0}
    found = force(*LINEAR, FittedTerm("cavitation", 1.0, {**shape, "valve": resistance}))
    t, whole = MOTION.time, force(*LINEAR)
    opens = int(np.flatnonzero((whole[:-1] > -limit) & (whole[1:] <= -limit))[0])
    open_to = opens + t.size // 6

    def flow(time, u):
        speed = np.interp(time, t, MOTION.velocity)
        return (-limit + resistance * (speed - u) - 900.0 * u) / 200.0

    span = t[opens:open_to]
    fluid = solve_ivp(flow, span[[0, -1]], [MOTION.velocity[opens]], t_eval=span, rtol=1e-8).y[0]
    expected = -limit + resistance * (MOTION.velocity[opens:open_to] - fluid)
    assert expected.min() < -1.1 * limit
    np.testing.assert_allclose(found[opens + 4 : open_to], expected[4:], atol=0.01 * limit)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("contact", [60.0, 2000.0])
def test_a_valve_only_relieves_however_narrow_it_is(contact, side):
    """Between a limit that holds and oil that never tears, whose damping it lacks (3 %)."""
    shape = {"limit": 300.0, "contact": contact, "loss": 0.4, "refill": 1.0, "side": side}
    least = [
        -np.max(side * force(*LINEAR, FittedTerm("cavitation", 1.0, {**shape, "valve": valve})))
        for valve in (0.0, 1e3, 1e4, 1e5, 1e7)
    ]
    whole = force(*LINEAR, FittedTerm("cavitation", 1.0, {**shape, "limit": 1e6}))
    assert np.all(np.diff(least) < 0.0)
    assert least[-1] > -1.05 * np.max(side * whole)


def test_a_valve_s_lag_moves_the_force_evenly():
    """Between two samples too: what is fitted has to follow it."""
    shape = {"limit": 300.0, "contact": 600.0, "loss": 0.4, "refill": 1.0, "side": -1.0}
    means = [
        force(*LINEAR, FittedTerm("cavitation", 1.0, {**shape, "lag": lag})).mean()
        for lag in 5e-3 + MOTION.step * np.linspace(0.0, 1.0, 6)
    ]
    steps = np.diff(means)
    assert np.all(steps * np.sign(steps.sum()) > 0.0)
    assert steps.max() - steps.min() < np.abs(steps.mean())


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_joint_before_a_force_beyond_all_numbers_is_no_error():
    found = force(FittedTerm("viscous-damping", 1e308), FittedTerm("series-compliance", 1e-6))
    assert not np.all(np.isfinite(found))
