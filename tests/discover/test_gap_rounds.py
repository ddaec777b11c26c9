"""Where the rounds of a gap search start and end."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from discover.gap import close_gap, rounds
from discover.gap.accuracy import Misfit
from discover.gap.judging import predicts, shows
from discover.gap.mending import mended
from discover.gap.stages import Stage
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

WRONG = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 700.0)))


def test_what_refitting_gains_is_not_credited_to_the_effect():
    found = close_gap(campaign(lambda t, x, v, a: device(t, x, v, a) + 20.0), WRONG)
    (only,) = found.rounds
    assert only.effect == "force-offset"
    assert found.gap_percent > 1.3 * only.gap[0]
    assert any("Refitting" in f.text for f in found.findings)


def test_a_wrong_coefficient_alone_is_no_missing_effect():
    found = close_gap(campaign(device), WRONG)
    assert found.verdict == "agrees"
    assert found.rounds == ()
    assert found.gap_percent > 10.0
    assert found.final_gap_percent == pytest.approx(1.0, rel=0.1)


def test_a_shape_that_is_a_little_off_brings_no_second_name():
    def law(t, x, v, a):
        hardening = 4e7 * x**3 * (1.0 + 0.08 * (x / 0.012) ** 2)
        return device(t, x, v, a) + hardening

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    assert [r.effect for r in found.rounds] == ["cubic-stiffness"]


def test_a_force_that_is_no_entry_is_not_named_for_sure():
    def law(t, x, v, a):
        return device(t, x, v, a) + 1.5e6 * x**2 * np.abs(v) * np.cos(3e4 * x**2)

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    assert not found.rounds or found.rounds[0].probability < 0.9


def test_friction_that_differs_from_test_to_test_is_no_warming():
    """Its size follows the stroke, so some drift would explain it: but nothing changes in time."""

    def law(t, x, v, a):
        return device(t, x, v, a) + 30.0 * (np.abs(x).max() / 0.004) ** 1.5 * np.sign(v)

    found = close_gap(
        campaign(law), "fit:inertia,viscous-damping", effects=("thermal-drift", "sensor-drift")
    )
    assert found.verdict == "unexplained"
    assert found.rounds == ()


@pytest.mark.parametrize("phase", [0.0, 0.7])
def test_friction_of_a_thread_s_period_is_friction_along_the_stroke(phase):
    def law(t, x, v, a):
        marks = 12.0 * np.sin(2.0 * np.pi * x / 0.007 + phase)
        return device(t, x, v, a) + (30.0 + marks) * np.sign(v)

    found = close_gap(campaign(law), "fit:inertia,viscous-damping,coulomb-friction")
    (only,) = found.rounds
    assert only.effect == "position-dependent-friction"
    assert only.parameters["width"] == pytest.approx(0.007, rel=0.01)
    assert found.final_held_out_gap_percent < 1.2 * found.noise_percent


def test_warming_that_shows_inside_the_tests_is_named():
    """The oil warms by what it dissipates and thins exponentially: no cooling, stepped in time."""

    def law(t, x, v, a):
        warm, force = 0.0, np.empty_like(t)
        for i, (speed, pull) in enumerate(zip(v, 120.0 * a, strict=True)):
            damping = 800.0 * np.exp(-warm)
            force[i] = pull + damping * speed
            warm += 0.05 * damping * speed**2 * (t[1] - t[0])
        return force

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    assert found.rounds[0].effect == "thermal-drift"
    assert found.rounds[0].probability > 0.9
    assert found.final_held_out_gap_percent < 1.3 * found.noise_percent


def test_a_force_at_half_the_test_s_frequency_is_not_taken_for_drift_nor_for_noise():
    def law(t, x, v, a):
        rate = t[1] - t[0]
        frequency = 1.0 / (250.0 * rate) ** 0.5
        return device(t, x, v, a) + 6.0 * np.cos(np.pi * frequency * t)

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    assert found.verdict == "unexplained"
    assert found.last[0][0] == "unknown"


def test_friction_is_added_though_a_second_missing_effect_widens_the_pooled_gap():
    """Quadratic damping makes the loud tests' gap, friction the quiet ones', which are fitted."""

    def law(t, x, v, a):
        return device(t, x, v, a) + 2e4 * v * np.abs(v) + 60.0 * np.tanh(v / 1e-3)

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    named = {r.effect for r in found.rounds}
    assert {"coulomb-friction"} < named
    assert named & {"quadratic-damping", "power-law-damping"}
    assert found.final_gap_percent < 1.3 * found.noise_percent


def test_of_two_that_are_missing_the_second_is_tried_where_the_first_alone_is_nothing(monkeypatch):
    """What makes up for the other in its own fit may explain little until that is there."""
    def adds_nothing(rows, fit, contest, name, begun):
        return fit if name == "viscous-damping" else mended(rows, fit, contest, name, begun)

    monkeypatch.setattr(rounds, "mended", adds_nothing)
    both = campaign(lambda t, x, v, a: device(t, x, v, a) + 8.0)
    found = close_gap(both, "fit:inertia", effects=["viscous-damping", "force-offset"])
    assert [r.effect for r in found.rounds] == ["force-offset"]


def test_a_large_offset_has_no_shape_that_could_hide_a_small_friction():
    def law(t, x, v, a):
        return device(t, x, v, a) + 300.0 + 9.0 * np.tanh(v / 1e-3)

    found = close_gap(campaign(law, noise=0.002), "fit:inertia,viscous-damping")
    assert [r.effect for r in found.rounds] == ["force-offset", "coulomb-friction"]


def test_viscous_damping_is_tried_though_friction_stands_for_it():
    """Friction that reverses over a wide range of speed spans what viscous damping would add."""

    def law(t, x, v, a):
        return 120.0 * a + 900.0 * v + 3000.0 * v * np.abs(v) + 10.0 * np.tanh(v / 0.003)

    found = close_gap(campaign(law, seed=1), "fit:inertia,coulomb-friction,quadratic-damping")
    assert [r.effect for r in found.rounds] == ["viscous-damping"]
    assert found.final_gap_percent < 1.1 * found.noise_percent


def with_a_line(place, share):
    """Return a clean campaign in which some records' force has a line at its third harmonic."""
    clean = campaign(device, seed=3)
    records = []
    for i, r in enumerate(clean.records):
        line = share * np.sqrt(2.0) * float(np.std(r.force))
        line = line * np.sin(6.0 * np.pi * r.frequency * r.time + 1.0)
        records.append(replace(r, force=r.force + line) if i in place else r)
    return replace(clean, records=tuple(records))


def test_a_line_in_one_record_within_its_noise_is_no_effect():
    """There the noise may be more than beside the lines; in every record it is something."""
    one = close_gap(with_a_line([2], 0.006), "fit:inertia,viscous-damping")
    assert one.verdict == "agrees"
    assert one.rounds == ()
    every = close_gap(with_a_line(range(8), 0.006), "fit:inertia,viscous-damping")
    assert every.verdict != "agrees"


def test_a_line_far_above_the_noise_of_one_record_counts():
    found = close_gap(with_a_line([2], 0.05), "fit:inertia,viscous-damping")
    assert found.verdict != "agrees"


@pytest.mark.parametrize(("gained", "gap", "shown"), [
    ([20.0] * 5, 1.001, True),  # the noise of a drifting force may move the gap a little
    ([20.0] * 5, 1.02, False),
    ([200.0, 5.0, 5.0, 5.0, 5.0], 0.999, False),
    ([40.0] * 3, 0.999, False),
])
def test_an_effect_shows_where_several_records_gain_and_the_gap_does_not_grow(gained, gap, shown):
    size = 50
    rows = [
        SimpleNamespace(target=np.zeros(size), observation=SimpleNamespace(held_out=False))
        for _ in gained
    ]

    def at(beyond, error):
        residual = np.concatenate([np.full(size, np.sqrt(1.0 + b / size)) for b in beyond])
        found = tuple(Misfit(error**2, 1e4, 1.0, 1000) for _ in gained)
        return Stage(SimpleNamespace(residual=residual), found, ())

    before, after = at(gained, 1.0), at(np.zeros(len(gained)), gap)
    assert shows(rows, rows, before, after) is shown


@pytest.mark.parametrize(("errors", "held_out", "better"), [
    ([1.01, 1.01, 1.01, 1.01], False, True),  # what noise may move
    ([1.0, 1.0, 1.0, 1.2], False, False),
    ([0.7, 0.7, 0.7, 1.2], False, True),  # one loud record loses what quiet ones gain
    ([0.1, 0.1, 0.1, 9.0], False, True),  # one alone shows an earlier effect: no other predicts it
    ([1.0, 1.0, 1.0, 1.2], True, True),  # those held out judge, and choose nothing
])
def test_a_further_effect_has_to_predict_records_that_are_left_out(errors, held_out, better):
    forces = [10.0, 10.0, 10.0, 300.0]
    rows = [SimpleNamespace(observation=SimpleNamespace(held_out=held_out)) for _ in forces]

    def at(relative):
        found = [
            Misfit((0.01 * e * f) ** 2, f**2, 1.0, 1000)
            for e, f in zip(relative, forces, strict=True)
        ]
        return Stage(None, (), tuple(found))

    assert predicts(rows, at([1.0] * 4), at(errors)) is better
