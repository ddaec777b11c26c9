"""The gap on motion, on records that scipy's solver made."""

from __future__ import annotations

import functools
import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover.cli import main
from discover.motion_gap import motion_before_and_after, motion_gap
from discover.records import Campaign, CarriedSystem, Record
from discover.report.motion import motion_lines
from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel

MASS, STIFFNESS = 250.0, 2e4
INERTANCE, VISCOUS, QUADRATIC = 70.0, 300.0, 800.0


@functools.cache
def shaken(*, noise=0.0, acts="base_acceleration", negative=0.0, held_out=False, seed=3):
    """A mass on a spring with an integer-order device, under a random base acceleration."""
    rng = np.random.default_rng(seed)
    rate, duration = 500.0, 30.0
    t = np.arange(int(rate * duration)) / rate
    waves = rng.uniform(0.3, 3.0, 12), rng.uniform(0.0, 2 * np.pi, 12)
    fade = np.minimum(t / 3.0, 1.0) ** 2 * np.minimum((duration - t) / 6.0, 1.0) ** 2
    drive = fade * np.sin(2 * np.pi * np.outer(t, waves[0]) + waves[1]).sum(axis=1)
    drive = drive * (1.0 if acts == "base_acceleration" else MASS)

    def device(v, a):
        return INERTANCE * a + VISCOUS * v + QUADRATIC * v * abs(v)

    def rate_of(time, y):
        push = np.interp(time, t, drive) * (-MASS if acts == "base_acceleration" else 1.0)
        push -= STIFFNESS * y[0] + VISCOUS * y[1] + QUADRATIC * y[1] * abs(y[1])
        return [y[1], push / (MASS + INERTANCE)]

    answer = solve_ivp(rate_of, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-12,
                       max_step=1.0 / rate)  # fmt: skip
    x, v = answer.y
    a = np.array([rate_of(time, y)[1] for time, y in zip(t, answer.y.T, strict=True)])
    force = device(v, a) + noise * rng.standard_normal(t.size)
    x = x + 1e-6 * rng.standard_normal(t.size)
    return Record("shake.csv", t, force, x, inputs={acts: drive}, held_out=held_out)


def model(*, viscous=VISCOUS, quadratic=QUADRATIC, inertance=INERTANCE):
    return ForceModel(
        (
            FittedTerm("inertia", inertance),
            FittedTerm("viscous-damping", viscous),
            FittedTerm("quadratic-damping", quadratic),
        ),
        "device",
    )


@pytest.mark.parametrize("acts", ["base_acceleration", "applied_force"])
def test_the_true_device_moves_as_measured(acts):
    system = CarriedSystem(MASS, STIFFNESS, acts)
    answer = motion_gap(model(), Campaign("t", (shaken(acts=acts),), system=system))
    record = answer.records[0]
    assert record.motion_gap_percent < 0.3
    assert record.amplitude_ratio == pytest.approx(1.0, abs=0.01)
    assert abs(record.drift_percent) < 0.3
    assert record.error is not None and record.error.relative < 1e-3
    assert answer.findings == ()
    assert answer.gap_percent() == pytest.approx(record.motion_gap_percent)
    assert answer.gap_percent(held_out=True) is None


def test_a_small_error_of_force_near_resonance_is_a_large_one_of_motion():
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    campaign = Campaign("t", (shaken(), shaken(held_out=True, seed=4)), system=system)
    wrong = motion_gap(model(inertance=0.9 * INERTANCE), campaign)
    true = motion_gap(model(), campaign)
    assert wrong.gap_percent() > 10.0 * true.gap_percent()
    assert wrong.gap_percent(held_out=True) > 10.0 * true.gap_percent(held_out=True)
    document = wrong.to_dict()
    assert document["records"][1]["held_out"] is True
    assert document["system"]["input"] == "base_acceleration"
    assert document["records"][0]["force_gap_percent"] > 0.0


def test_a_model_without_damping_does_not_come_to_rest():
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    campaign = Campaign("t", (shaken(),), system=system)
    answer = motion_gap(model(viscous=0.0, quadratic=0.0), campaign)
    assert answer.records[0].amplitude_ratio > 2.0
    assert any("grows" in f.text for f in answer.findings)
    dead = motion_gap(model(viscous=1e5), campaign)
    assert any("dies out" in f.text for f in dead.findings)


def test_a_constant_force_shows_as_drift():
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    biased = ForceModel((*model().terms, FittedTerm("force-offset", 200.0)), "biased")
    answer = motion_gap(biased, Campaign("t", (shaken(),), system=system))
    assert answer.records[0].drift_percent < -20.0
    assert any("drifts" in f.text for f in answer.findings)


def steady(order, *, start=1.7):
    """A steady state of a fractional device in closed form, recorded from some moment on."""
    frequency, rate = 1.1, 400.0
    omega = 2.0 * np.pi * frequency
    t = np.arange(int(12.3 / frequency * rate)) / rate
    dynamic = STIFFNESS - MASS * omega**2 + 500.0 * (1j * omega) ** order
    phasor = -MASS * 2.0 / dynamic
    turn = np.exp(1j * omega * (t + start))
    force = (500.0 * (1j * omega) ** order * phasor * turn).real
    drive = (2.0 * turn).real
    return Record("sine.csv", t, force, (phasor * turn).real, inputs={"base_acceleration": drive})


@pytest.mark.parametrize("order", [0.6, 1.6])
def test_a_sine_test_is_simulated_from_its_steady_state(order):
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    law = ForceModel((FittedTerm("fractional-derivative", 500.0, {"order": order}),), "true")
    answer = motion_gap(law, Campaign("t", (steady(order),), system=system))
    # A transient from rest would be tens of percent.
    assert answer.records[0].motion_gap_percent < 0.2


def test_what_is_missing_is_named():
    record = shaken()
    with pytest.raises(InputError, match="carried system must be given"):
        motion_gap(model(), Campaign("t", (record,)))
    other = CarriedSystem(MASS, STIFFNESS, "applied_force")
    with pytest.raises(InputError, match="column 'applied_force' must be in a record"):
        motion_gap(model(), Campaign("t", (record,), system=other))
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    bare = Record("bare.csv", record.time, record.force, record.displacement)
    answer = motion_gap(model(), Campaign("t", (record, bare), system=system))
    assert len(answer.records) == 1
    assert any("1 records have no base_acceleration" in f.text for f in answer.findings)


def written(folder, *, system=True):
    """A campaign on disk of two shaken records, with the carried system."""
    folder.mkdir()
    lines = ['title = "shaken"']
    for seed in (3, 4):
        record = shaken(seed=seed, noise=2.0)
        table = np.column_stack(
            [record.time, record.displacement, record.force, record.inputs["base_acceleration"]]
        )
        header = "time [s],displacement [m],force [N],base_acceleration [m/s^2]"
        np.savetxt(folder / f"{seed}.csv", table, delimiter=",", header=header, comments="")
        lines += ["[[records]]", f'file = "{seed}.csv"', f"held_out = {str(seed == 4).lower()}"]
    if system:
        lines += ["[system]", 'mass = "250 kg"', 'stiffness = "20 kN/m"']
        lines += ['input = "base_acceleration"']
    (folder / "campaign.toml").write_text("\n".join(lines))
    return folder


@pytest.mark.usefixtures("undrawn")
def test_the_gap_on_motion_closes_with_the_effect_that_was_missing(tmp_path, capsys):
    folder = written(tmp_path / "campaign")
    arguments = ["--model", "fit:inertia,viscous-damping", "--on", "motion"]
    assert main(["gap", str(folder), *arguments, "-o", str(tmp_path / "out"), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["rounds"][0]["effect"] == "quadratic-damping"
    before, after = document["motion"]["before"], document["motion"]["after"]
    assert before["gap_percent"] > 3.0
    assert after["gap_percent"] < 0.3 * before["gap_percent"]
    assert after["held_out_gap_percent"] < 0.3 * before["held_out_gap_percent"]


def test_a_campaign_without_a_system_is_refused_at_once(tmp_path, capsys):
    folder = written(tmp_path / "campaign", system=False)
    arguments = ["--model", "fit:inertia", "--on", "motion", "-o", str(tmp_path / "out")]
    assert main(["gap", str(folder), *arguments]) == 2
    assert "carried system must be given as [system]" in capsys.readouterr().err


def test_an_effect_without_a_rule_in_time_is_said():
    system = CarriedSystem(MASS, STIFFNESS, "base_acceleration")
    campaign = Campaign("t", (shaken(),), system=system)
    late = ForceModel((*model().terms, FittedTerm("series-compliance", 1e-7)))
    answer = motion_before_and_after(campaign, model(), late)
    assert answer["after"] is None
    assert "series-compliance" in answer["reason"]
    lines = motion_lines(answer)
    assert "can't be moved" in lines[0]
