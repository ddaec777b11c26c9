"""Answers are judged as by hand."""

import dataclasses
import json
import time

import numpy as np
import pytest

from tests.calibration.structures.case import Case, Truth, build
from tests.calibration.structures.run import answered, read, within
from tests.calibration.structures.scoring import Outcome, named_extras, score
from tests.calibration.structures.sets import cases
from tests.calibration.structures.table import interval, table

SEED = 900


def band(core, records, **more):
    terms = {
        "FOIM": [{"id": "fractional-derivative", "order": 1.5, "order_interval": [0.2, 2.0]}],
        "IOIM-linear": [{"id": "inertia", "interval": [0.0, 1e6]}, {"id": "viscous-damping"}],
        "IOIM-turbulent": [
            {"id": "inertia", "interval": [0.0, 1.0]},
            {"id": "power-law-damping", "exponent": 1.7, "exponent_interval": [1.5, 1.9]},
        ],
    }
    return {
        "structure": core, "records": list(records), "probability": 0.95,
        "terms": [*terms.get(core, []), {"id": "coulomb-friction"}],
        "equivalents": [{"structure": core, "probability": 0.95}],
        "relative_error_percent": 2.0, "noise_percent": 2.0,
    } | more


def document(bands, **more):
    return {
        "coordinate": "dean", "relative_error_percent": 2.0, "bands": bands, "boundaries": [],
        "nuisance": [],
    } | more


@pytest.fixture(scope="module")
def parted():
    return next(
        c for c in cases("structures", [SEED]) if c.kind == "SFOIM" and c.twist == "short"
    )


@pytest.fixture(scope="module")
def single():
    return next(
        c for c in cases("structures", [SEED])
        if c.kind == "IOIM-linear" and c.twist in ("plain", "short")
    )


def answer(case, **more):
    truth = case.truth
    bands = [band(c, f) for c, f in zip(truth.cores, truth.members, strict=True)]
    ends = [
        {"bracket": [0.99 * b, 1.01 * b], "coordinate": b} for b in truth.boundaries
    ]
    coordinate = truth.coordinate or "dean"
    return document(bands, boundaries=ends, coordinate=coordinate, **more)


def test_the_truth_is_right(parted, single):
    for case in (parted, single):
        found = score(case, answer(case))
        assert found.core_right
        assert found.core_listed
        assert found.bands_right
        assert all(found.brackets)
        assert found.stated == 0.95
        assert found.false_extras == ()
        assert found.error_ratio == pytest.approx(2.0 / case.truth.noise_percent)
    assert score(parted, answer(parted)).orders == (True, True)
    assert score(parted, answer(parted)).sharp_right
    assert score(single, answer(single)).inertances == (True,)


def test_one_wrong_band_is_wrong(parted):
    found = answer(parted)
    found["bands"][1]["core"] = "IOIM-linear"
    judged = score(parted, found)
    assert not judged.core_right
    assert judged.core_listed
    assert judged.bands_right
    assert judged.orders == ()


def test_the_key_core_goes_before_structure(single):
    found = answer(single)
    found["bands"][0] |= {"core": "IOIM-linear", "structure": "other"}
    assert score(single, found).core_right


def test_a_missed_boundary_is_no_right_core(parted):
    files = [f for own in parted.truth.members for f in own]
    judged = score(parted, document([band("FOIM", files)]))
    assert not judged.core_right
    assert not judged.core_listed
    assert not judged.bands_right
    assert judged.brackets == (False,)
    assert not judged.coordinate_right


def test_an_invented_boundary_leaves_the_core_but_not_the_bands(single):
    files = list(single.truth.members[0])
    halves = [band("IOIM-linear", files[:15]), band("IOIM-linear", files[15:])]
    judged = score(single, document(halves, boundaries=[{"bracket": [1.0, 2.0]}]))
    assert judged.core_right
    assert not judged.bands_right
    assert judged.bands == 2
    assert judged.inertances == ()


def test_a_bracket_elsewhere_is_wrong_and_one_by_its_records_right(parted):
    found = answer(parted)
    found["boundaries"][0]["bracket"] = [1e-9, 2e-9]
    assert score(parted, found).brackets == (True,)
    moved = found["bands"][0]["records"].pop()
    found["bands"][1]["records"].append(moved)
    assert score(parted, found).brackets == (False,)


def test_a_speed_is_a_dean_number(parted):
    truth = dataclasses.replace(parted.truth, coordinate="dean", speeds=(0.05,))
    assert truth.boundaries != truth.speeds
    judged = _judged(parted, truth, "speed", [0.049, 0.051])
    assert judged.brackets == (True,)
    assert judged.coordinate_right
    assert _judged(parted, truth, "frequency", [0.049, 0.051]).coordinate_right is False


def _judged(case, truth, coordinate, ends):
    from tests.calibration.structures import scoring

    found = answer(case) | {"coordinate": coordinate}
    found["boundaries"] = [{"bracket": ends}]
    moved = found["bands"][0]["records"].pop()
    found["bands"][1]["records"].append(moved)

    class Asked:
        def __getattr__(self, name):
            return truth if name == "truth" else getattr(case, name)

    return scoring.score(Asked(), found)


def test_extras_are_read_from_their_key_and_else_from_terms():
    files = ["a.csv"]
    extra = {"id": "stiffness", "probability": 0.9}
    doubtful = {"id": "time-delay", "probability": 0.2}
    new = document([band("FOIM", files, extras=[extra, doubtful])])
    assert named_extras(new) == {"stiffness"}
    old = document([band("FOIM", files)], nuisance=[{"id": "skew"}])
    old["bands"][0]["terms"].append({"id": "series-compliance"})
    assert named_extras(old) == {"series-compliance", "time-delay"}


def test_an_extra_is_asked_for_in_its_set_only(single):
    case = Case("one-extra", "IOIM-linear", "dahl", "plain", "stiffness", SEED, 3)
    found = answer(case)
    assert score(case, found).extra_right is False
    found["bands"][0]["extras"] = [{"id": "stiffness", "probability": 0.8}]
    judged = score(case, found)
    assert judged.extra_right
    assert judged.false_extras == ()
    assert score(single, answer(single)).extra_right is None


@pytest.mark.parametrize(("value", "right"), [(5.0, True), (3.0, False), (3.6, True), (9.9, False)])
def test_a_remainder_is_right_within_a_factor(value, right):
    case = Case("outside", "IOIM-linear", "dahl", "short", "wake", SEED, 0)
    found = answer(case)
    assert score(case, found).remainder_right is False
    found["bands"][0]["remainder_percent"] = {"value": value, "interval": [0.9 * value, value]}
    judged = score(case, found)
    assert case.truth.remainder[0] == 0.05
    assert judged.remainder_right is right
    assert judged.remainder == pytest.approx(value / 5.0)
    assert judged.remainder_covers is (value == 5.0)


def test_a_failure_is_wrong(single):
    judged = score(single, None, failure="ValueError: no")
    assert not judged.core_right
    assert judged.bands == 0
    assert judged.failure


def outcome(**more):
    base = dict(
        key="k", set="structures", kind="FOIM", friction="jump", twist="plain", effect="", seed=1,
        nats=20.0, bands=1, core_right=True, core_listed=True, stated=0.97, bands_right=True,
        error_ratio=1.0, commit="abc",
    )
    return Outcome(**base | more)


def test_table_counts_by_hand():
    some = [outcome()] * 8 + [
        outcome(core_right=False, bands=2, bands_right=False, stated=0.92, error_ratio=4.0,
                false_extras=("stiffness",), orders=(True, False)),
        outcome(kind="SFOIM", bands=2, brackets=(True,), coordinate_right=True, sharp_right=True,
                stated=0.6, orders=(True, True)),
    ]
    text = table(some)
    low, high = interval(9, 10)
    assert f"| core first | 9 of 10 (90.0 %) | {low:.3f} to {high:.3f} | ≥ 97 % | no |" in text
    assert "| no boundary where none | 8 of 9 (88.9 %)" in text
    assert "| bracket holds, all of a device | 1 of 1 (100.0 %)" in text
    assert "| order: 95 % interval holds it | 3 of 4 (75.0 %)" in text
    assert "| wrong, of those stated above 0.9 | 1 of 9 (11.1 %)" in text
    middle = "| error over true noise, median (not moving records) | 1.00 of 10 |"
    assert f"{middle} | ≤ 1.1 | yes |" in text
    assert "| 0.95 to 0.99 | 0.970 | 8 of 8 (100.0 %)" in text
    assert "Named and not there: stiffness 1." in text


def test_forty_answers_make_a_bin_count():
    right = [outcome(set="thin", stated=0.85)] * 34
    wrong = [outcome(set="thin", stated=0.85, core_right=False)] * 6
    text = table([*right, *wrong])
    assert "| 0.8 to 0.9 | 0.850 | 34 of 40 (85.0 %)" in text
    assert text.split("34 of 40 (85.0 %)")[-1].splitlines()[0].endswith("| yes |")
    assert "| few |" in table(right)


def test_interval_is_clopper_pearsons():
    assert interval(0, 10) == pytest.approx((0.0, 1.0 - 0.025**0.1))


def test_outcomes_are_read_back_and_the_last_of_a_case_stands(tmp_path, single):
    keep = tmp_path / "kept.jsonl"
    first = score(single, None, failure="ValueError")
    last = score(single, answer(single), seconds=2.0)
    lines = [json.dumps(dataclasses.asdict(o)) for o in (first, last)]
    keep.write_text("\n".join(lines) + '\n{"key": "cut')
    assert read(keep) == [last]


def test_a_study_that_takes_too_long_has_failed(monkeypatch, single):
    def works(campaign):
        until = time.process_time() + 5.0
        while time.process_time() < until:
            pass

    monkeypatch.setattr("discover.run_study", works)
    judged = answered(single, limit=1)
    assert judged.failure.startswith("TimeoutError")
    assert 0.5 < judged.worked < 4.0


def test_the_limit_ends_with_the_study():
    with within(1):
        pass
    until = time.process_time() + 1.3
    while time.process_time() < until:
        pass


def test_a_truth_names_every_record(parted):
    truth: Truth = build(parted)[1]
    assert sum(len(m) for m in truth.members) == len(parted.campaign.records)
    assert np.isfinite(truth.nats)
