import math

import pytest

from models.checks import InputError
from models.device import Device
from models.rig import Limits, Plan, TestPoint, sine_plan, sine_point, transient_plan

TWELVE = Device.preset("device-12")


def test_plan_covers_the_range_within_stroke_speed_and_acceleration():
    plan = sine_plan(TWELVE)
    assert {p.amplitude for p in plan} == {0.005, 0.01, 0.02}
    assert len({p.frequency for p in plan}) == 12
    assert min(p.frequency for p in plan) == 0.1
    assert max(p.frequency for p in plan) == 15.0
    for p in plan:
        omega = 2 * math.pi * p.frequency
        assert omega * p.amplitude <= 0.5
        assert omega**2 * p.amplitude <= 5 * 9.80665


def test_fifteen_hertz_at_twenty_millimetres_is_refused():
    assert not Limits().allows(TWELVE, sine_point(15.0, 0.02))
    assert Limits(speed=9.0, acceleration=999.0, force=1e6).allows(TWELVE, sine_point(15.0, 0.02))
    assert not Limits(stroke=0.01).allows(TWELVE, sine_point(0.1, 0.02))


def test_force_limit_counts_the_devices_inertance():
    # 15 Hz, 5 mm: b a = 370 kg * 44.4 m/s^2 = 16.4 kN.
    point = sine_point(15.0, 0.005)
    assert not Limits(force=16e3).allows(TWELVE, point)
    assert Limits(force=25e3).allows(TWELVE, point)


def test_held_out_points_are_spread_and_counted():
    plan = sine_plan(TWELVE, held_out=5)
    marked = [i for i, p in enumerate(plan) if p.held_out]
    assert len(marked) == 5
    assert not plan.points[0].held_out
    assert not plan.points[-1].held_out
    assert min(b - a for a, b in zip(marked, marked[1:], strict=False)) >= 4


def test_every_point_is_sampled_finely_enough():
    for p in sine_plan(TWELVE):
        assert p.sampling >= 100.0 * p.frequency
        assert p.cycles >= 5


def test_transients_are_named_by_kind():
    sweep, random = transient_plan(band=(0.2, 5.0))
    assert (sweep.kind, random.kind) == ("sweep", "random")
    assert random.held_out
    assert sweep.duration == pytest.approx(40.0)
    assert sweep.top == 5.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"frequency": 0.0}, "frequency"),
        ({"amplitude": -1.0}, "amplitude"),
        ({"sampling": 10.0}, "sampling"),
        ({"cycles": 0.5}, "cycles"),
        ({"kind": "square"}, "kind must be one of"),
        ({"kind": "sweep"}, "upper must be given"),
        ({"upper": 5.0}, "upper must be given"),
        ({"kind": "sweep", "upper": 1.0}, "upper"),
    ],
)
def test_impossible_points_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        TestPoint(**{"frequency": 2.0, "amplitude": 0.01, **values})


def test_impossible_plans_are_refused():
    with pytest.raises(InputError, match="at least one test point"):
        Plan(())
    with pytest.raises(InputError, match="1hz-5mm.csv twice"):
        Plan((sine_point(1.0, 0.005), sine_point(1.0, 0.005)))
    with pytest.raises(InputError, match="held_out"):
        sine_plan(TWELVE, frequencies=[1.0], amplitudes=[0.005], held_out=1)
