"""The rough design against brute force, re-solved problems and the closed form of Eq. 16."""

import math
from dataclasses import replace

import numpy as np
import pytest

from models.checks import InputError
from models.design import (
    FLUIDS,
    DesignBounds,
    Duty,
    elasticities,
    minimise_critical_frequency,
    parasitic_damping,
    peak_pressure,
)
from models.design.constraints import Problem
from models.design.prices import active_bounds
from models.design.search import search
from models.device import Device, Fluid
from models.flow import critical_frequency

TWELVE = Device.preset("device-12")


@pytest.fixture(scope="module")
def result():
    return minimise_critical_frequency(TWELVE)


def bounds_met(device, bounds, duty, slack=1e-6):
    """Check a device against bounds from its own formulas, none of the search's."""
    outer = device.helix_radius + device.channel_radius + bounds.wall
    height = device.turns * device.helix_pitch + 2.0 * device.channel_radius
    inside = device.cylinder_radius + device.channel_radius + bounds.wall
    met = [
        outer <= bounds.package_radius * (1 + slack),
        height <= bounds.package_length * (1 + slack),
        device.turns >= bounds.turns * (1 - slack),
        device.rod_radius >= bounds.rod_radius * (1 - slack),
        device.channel_radius >= bounds.channel_radius * (1 - slack),
        device.helix_pitch >= (2 * device.channel_radius + bounds.wall) * (1 - slack),
        inside <= device.helix_radius * (1 + slack) or not bounds.cylinder_inside_helix,
        abs(device.inertance / bounds.inertance - 1.0) <= slack,
    ]
    if bounds.damping is not None:
        met.append(parasitic_damping(device, duty) <= bounds.damping * (1 + slack))
    if bounds.pressure is not None:
        met.append(peak_pressure(device, duty) <= bounds.pressure * (1 + slack))
    return all(met)


def test_baseline_lies_within_the_bounds_drawn_around_it():
    assert bounds_met(TWELVE, DesignBounds.around(TWELVE), Duty(), slack=1e-12)


def test_critical_frequency_of_device_12_is_at_least_halved_within_its_package(result):
    device = result.best.device
    assert device.fluid == TWELVE.fluid
    assert device.inertance == pytest.approx(TWELVE.inertance, rel=1e-9)
    assert parasitic_damping(device, Duty()) <= 2.0 * parasitic_damping(TWELVE, Duty()) * 1.000001
    assert bounds_met(device, result.bounds, result.duty)
    before = float(critical_frequency(TWELVE, 0.005))
    assert float(critical_frequency(device, 0.005)) <= 0.5 * before
    assert result.improvement == pytest.approx(before / critical_frequency(device, 0.005))


def test_no_random_design_within_the_bounds_is_better(result):
    rng = np.random.default_rng(7)
    bounds, duty = result.bounds, result.duty
    best = result.best.critical_frequency("paper")
    fitting = 0
    for _ in range(20_000):
        r4 = rng.uniform(0.02, bounds.package_radius)
        r3 = rng.uniform(0.003, 0.5 * r4)
        r2 = rng.uniform(0.02, r4)
        pitch = rng.uniform(2 * r3 + bounds.wall, bounds.package_length)
        r1 = bounds.rod_radius * rng.uniform(1.0, 1.2)
        if r1 >= r2:
            continue
        trial = Device(r1, r2, r3, r4, pitch, 1.0, TWELVE.fluid, transition_length=0.1)
        # Inertance is linear in the total length: solve for the turns.
        per_length = trial.computed_inertance / trial.total_length
        turns = (bounds.inertance / per_length - 0.2) / trial.channel_length
        if turns < bounds.turns:
            continue
        trial = replace(trial, turns=turns)
        if bounds_met(trial, bounds, duty):
            fitting += 1
            assert float(critical_frequency(trial, duty.amplitude)) >= best * (1 - 1e-6)
    assert fitting > 100


def test_evolution_and_scattered_local_searches_agree(result):
    assert result.global_gap < 1e-3
    assert result.agreeing == result.starts > 10


def test_both_conventions_differ_by_a_constant_so_one_design_serves_both(result):
    for point in (result.baseline, result.best, *result.front):
        ratio = point.critical_frequency("standard") / point.critical_frequency("paper")
        assert ratio == pytest.approx(2.0 * math.sqrt(2.0), rel=1e-12)


@pytest.mark.parametrize("key", ["package_radius", "package_length", "turns", "inertance"])
def test_prices_are_what_moving_the_bound_really_buys(key):
    bounds = DesignBounds.around(TWELVE)
    problem = Problem(Duty(), bounds, TWELVE.fluid)
    optimum = search(problem)
    price = {b.name: b for b in active_bounds(problem, optimum.point)}[key.replace("_", " ")]
    step = 1e-3
    sides = []
    for sign in (1.0, -1.0):
        moved = replace(bounds, **{key: getattr(bounds, key) * math.exp(sign * step)})
        changed = search(replace(problem, bounds=moved), near=optimum.point, starts=0)
        sides.append(changed.value)
    slope = (sides[0] - sides[1]) / (2.0 * step)
    tightening = -slope if price.kind == "at most" else slope
    assert price.price == pytest.approx(tightening, rel=2e-3, abs=1e-4)


def test_damping_bound_costs_frequency_once_it_binds():
    duty = Duty()
    loose = DesignBounds.around(TWELVE, damping_ratio=2.0)
    tight = DesignBounds.around(TWELVE, damping_ratio=0.4)
    a = minimise_critical_frequency(TWELVE, bounds=loose, front=False)
    b = minimise_critical_frequency(TWELVE, bounds=tight, front=False)
    assert b.best.critical_frequency("paper") > a.best.critical_frequency("paper") * 1.05
    assert parasitic_damping(b.best.device, duty) == pytest.approx(tight.damping, rel=1e-6)
    assert "parasitic damping" in {bound.name for bound in b.active}


def test_pressure_bound_is_kept_and_costs_frequency_once_it_binds():
    # At high speed the entrance losses of a wide piston cost pressure.
    duty = Duty(amplitude=0.05, frequency=2.0)
    free = DesignBounds.around(TWELVE, duty=duty, damping_ratio=None)
    without = minimise_critical_frequency(TWELVE, bounds=free, duty=duty, front=False).best
    limit = 0.8 * peak_pressure(without.device, duty)
    bounds = replace(free, pressure=limit)
    kept = minimise_critical_frequency(TWELVE, bounds=bounds, duty=duty, front=False)
    assert peak_pressure(kept.best.device, duty) == pytest.approx(limit, rel=1e-6)
    lowest = without.critical_frequency("paper")
    assert kept.best.critical_frequency("paper") > lowest * (1 + 1e-4)
    assert "pressure" in {bound.name for bound in kept.active}


def test_at_least_is_never_worse_than_equal():
    bounds = DesignBounds.around(TWELVE, inertance_rule="at-least")
    wider = minimise_critical_frequency(TWELVE, bounds=bounds, front=False)
    equal = minimise_critical_frequency(TWELVE, front=False)
    lowest = wider.best.critical_frequency("paper")
    assert wider.best.device.inertance >= TWELVE.inertance * (1 - 1e-7)
    assert lowest <= equal.best.critical_frequency("paper") * (1 + 1e-7)


def test_thinnest_fluid_wins_where_any_may_be_chosen():
    found = minimise_critical_frequency(TWELVE, fluids=FLUIDS, front=False)
    thinnest = min(FLUIDS, key=lambda name: FLUIDS[name].kinematic_viscosity)
    assert found.best.fluid_name == thinnest
    assert found.best.device.fluid == FLUIDS[thinnest]


def test_front_holds_no_beaten_design_and_the_best_one(result):
    rows = [
        (p.critical_frequency("paper"), -p.device.inertance, p.damping) for p in result.front
    ]
    assert len(rows) >= 6
    for row in rows:
        beaten = [r for r in rows if r != row and all(a <= b for a, b in zip(r, row, strict=True))]
        assert not beaten
    best = result.best
    assert any(
        p.critical_frequency("paper") == pytest.approx(best.critical_frequency("paper"), rel=1e-6)
        and p.device.inertance == pytest.approx(best.device.inertance, rel=1e-6)
        for p in result.front
    )


def test_nothing_fits_is_said_with_the_bounds_that_conflict():
    bounds = replace(DesignBounds.around(TWELVE), damping=30.0)
    found = minimise_critical_frequency(TWELVE, bounds=bounds)
    assert not found.feasible and found.best is None and found.front == ()
    named = {c.name: c for c in found.conflicts}
    needed = named["parasitic damping"].needed
    assert needed > 30.0
    # The value named is where designs begin: just above it one exists, just below none.
    above = minimise_critical_frequency(
        TWELVE, bounds=replace(bounds, damping=needed * 1.01), front=False
    )
    below = minimise_critical_frequency(
        TWELVE, bounds=replace(bounds, damping=needed * 0.98), front=False
    )
    assert above.feasible and not below.feasible


@pytest.mark.parametrize("dimension", ["rod_radius", "cylinder_radius", "channel_radius",
                                       "helix_radius"])
def test_elasticities_are_the_slopes_of_the_critical_frequency(dimension):
    step = 1e-5
    value = getattr(TWELVE, dimension)
    up, down = (
        math.log(float(critical_frequency(replace(TWELVE, **{dimension: value * f}), 0.005)))
        for f in (math.exp(step), math.exp(-step))
    )
    assert elasticities(TWELVE)[dimension] == pytest.approx((up - down) / (2 * step), abs=1e-8)


def test_scaling_every_length_scales_the_answer():
    # f_low ~ nu/(A0 L): twice the lengths, mass times eight, viscosity and density kept.
    bounds = DesignBounds.around(TWELVE, damping_ratio=None)
    lengths = {
        k: 2.0 * getattr(bounds, k)
        for k in ("package_radius", "package_length", "rod_radius", "channel_radius", "wall",
                  "transition_length")
    }
    big = replace(bounds, **lengths, inertance=8.0 * bounds.inertance)
    small = minimise_critical_frequency(TWELVE, bounds=bounds, front=False)
    large = minimise_critical_frequency(TWELVE, bounds=big, front=False)
    ratio = large.best.critical_frequency("paper") / small.best.critical_frequency("paper")
    assert ratio == pytest.approx(0.5, rel=1e-5)


def test_document_holds_the_contract(result):
    document = result.to_dict()
    for key in ("geometry", "fluid", "critical_frequency_hz", "inertance", "baseline", "front",
                "active_bounds"):
        assert key in document
    assert set(document["critical_frequency_hz"]) == {"paper", "standard"}
    for key in ("geometry", "fluid", "critical_frequency_hz", "inertance"):
        assert key in document["baseline"]


def test_bad_input_is_named():
    with pytest.raises(InputError, match="at least one fluid"):
        minimise_critical_frequency(TWELVE, fluids={})
    with pytest.raises(InputError, match="damping must be"):
        replace(DesignBounds.around(TWELVE), damping=-1.0)
    with pytest.raises(InputError, match="inertance_rule must be one of equal, at-least"):
        replace(DesignBounds.around(TWELVE), inertance_rule="about")
    with pytest.raises(InputError, match="at least the stroke"):
        minimise_critical_frequency(TWELVE, duty=Duty(amplitude=0.2))


def test_a_thinner_fluid_lowers_the_critical_frequency_in_proportion():
    thin = Fluid(density=TWELVE.fluid.density, viscosity=0.5 * TWELVE.fluid.viscosity)
    bounds = DesignBounds.around(TWELVE, damping_ratio=None)
    both = [
        minimise_critical_frequency(TWELVE, bounds=bounds, fluids={"f": f}, front=False).best
        for f in (TWELVE.fluid, thin)
    ]
    ratio = both[1].critical_frequency("paper") / both[0].critical_frequency("paper")
    assert ratio == pytest.approx(0.5, rel=1e-6)
