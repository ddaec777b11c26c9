"""A record of a wrong unit is named with a guess; wide plans and steep forces are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from discover.data_check import check_campaign
from discover.data_check.sizes import size_findings
from discover.motion_fit import observe_all
from discover.record_checks import check_records
from discover.records import Campaign, Record
from tests.discover.data_check.plan import WIDE, campaign


def found(plan: Campaign) -> list[tuple[str | None, str]]:
    findings = size_findings(plan, check_records(plan, observe_all(plan.records, 1)).records)
    assert {f.level for f in findings} <= {"warning"}
    return [(f.record, f.text) for f in findings]


def scaled(plan: Campaign, index: int, *, length: float = 1.0, force: float = 1.0) -> Campaign:
    records = list(plan.records)
    one = records[index]
    assert one.displacement is not None
    records[index] = replace(one, displacement=length * one.displacement, force=force * one.force)
    return replace(plan, records=tuple(records))


@pytest.mark.parametrize(
    ("length", "values", "guess"),
    [
        (1e3, "is 1e+04 mm, 2e+03 times that of the others (median 5 mm)", "mm read as m?"),
        (1e-3, "is 0.01 mm, 1/500 of that of the others (median 5 mm)", "m read as mm?"),
        (150.0, "is 1.5e+03 mm, 300 times that of the others (median 5 mm)", "unit right?"),
    ],
)
def test_a_displacement_of_a_wrong_unit_is_one_warning_with_a_guess(length, values, guess):
    ((record, text),) = found(scaled(campaign(WIDE), 1, length=length))
    assert record == "1-10.csv"
    assert values in text
    assert text.endswith(guess)


@pytest.mark.parametrize(("force", "guess"), [(1e3, "N read as kN?"), (1e-3, "kN read as N?")])
def test_a_force_of_a_wrong_unit_is_one_warning_with_a_guess(force, guess):
    ((record, text),) = found(scaled(campaign(WIDE), 2, force=force))
    assert record == "2-10.csv"
    assert "its force is" in text
    assert text.endswith(guess)


def test_a_record_in_which_nothing_moves_is_to_be_left_out():
    plan = campaign(WIDE)
    rng = np.random.default_rng(1)
    one = plan.records[1]
    still = replace(
        one,
        displacement=1e-6 * rng.standard_normal(one.samples),
        force=1e-3 * plan.records[0].force.std() * rng.standard_normal(one.samples),
        frequency=None,
        amplitude=None,
    )
    ((record, text),) = found(
        replace(plan, records=(plan.records[0], still, *plan.records[2:]))
    )
    assert record == "1-10.csv"
    assert text.startswith("the device does not move in it, ")
    assert text.endswith("leave it out")


@pytest.mark.parametrize("factor", [15.0, 1.0 / 15.0])
def test_amplitudes_and_forces_may_span_what_tests_span(factor):
    assert found(scaled(campaign(WIDE), 0, length=factor, force=factor)) == []


def test_the_force_of_a_mass_that_grows_with_the_frequency_s_square_is_no_wrong_unit():
    plan = [(f, 0.01) for f in (0.1, 0.12, 0.15, 0.2, 15.0)]
    records = []
    for record, (f, amplitude) in zip(campaign(plan).records, plan, strict=True):
        omega = 2.0 * np.pi * f
        records.append(
            replace(record, force=-370.0 * amplitude * omega**2 * np.sin(omega * record.time))
        )
    inertial = Campaign("inertia", tuple(records))
    sizes = [float(np.std(r.force)) for r in records]
    assert sizes[-1] > 5e3 * np.median(sizes[:-1])
    assert found(inertial) == []


def test_records_that_are_no_sine_tests_are_judged_by_their_size():
    generator = np.random.default_rng(0)
    time = np.arange(4000) / 200.0
    records = []
    for index in range(3):
        phases = generator.uniform(0.0, 6.0, 40)
        tones = 2.0 * np.pi * generator.uniform(0.3, 5.0, 40)
        x = 1e-3 * np.sum(np.sin(np.outer(time, tones) + phases), axis=1)
        records.append(Record(f"{index}.csv", time, 1e5 * x, displacement=x))
    plan = Campaign("random", tuple(records))
    assert found(plan) == []
    ((record, text),) = found(scaled(plan, 1, length=1e3))
    assert record == "1.csv"
    assert "mm read as m?" in text


def test_of_two_records_either_may_be_wrong():
    plan = scaled(campaign(((1.0, 0.01), (2.0, 0.01))), 0, length=1e3)
    assert [record for record, _ in found(plan)] == ["1-10.csv", "2-10.csv"]


def test_one_record_alone_has_no_others():
    assert found(scaled(campaign(WIDE[:1]), 0, length=1e3)) == []


def test_the_check_says_it_before_its_notes_and_still_passes():
    checked = check_campaign(scaled(campaign(WIDE), 1, length=1e3))
    assert checked.passed
    levels = [f.level for f in checked.findings]
    assert levels == sorted(levels, key=["error", "warning", "note"].index)
    assert any("displacement amplitude" in f.text for f in checked.findings)
