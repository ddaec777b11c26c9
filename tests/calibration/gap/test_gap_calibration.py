"""How the blind study counts: what can be found, its noise, its table and what it keeps."""

import numpy as np
import pytest

from tests.calibration.gap.case import (
    SETS,
    Case,
    campaign,
    clean_cases,
    measure,
    single_cases,
)
from tests.calibration.gap.study import AGREES, BASELINE, Outcome, outcomes, read_outcomes
from tests.calibration.gap.table import interval, table
from tests.calibration.gap.truth import nats_left, noise_power, whitened

SEED = 61


def test_added_inertance_is_absorbed_and_a_spring_is_not():
    inertia, spring = single_cases("first", [SEED], [0.05], ["inertia", "stiffness"])
    assert nats_left(inertia, BASELINE) < 0.01
    assert nats_left(inertia) > 1e3
    assert nats_left(spring, BASELINE) > 1e3


@pytest.mark.parametrize("kind", SETS)
def test_the_campaigns_own_noise_has_unit_variance_when_whitened(kind):
    power, size = 0.0, 0
    for seed in range(SEED, SEED + 4):
        case = Case(kind, (), 0.0, seed)
        for noisy, exact in zip(campaign(case).records, measure(case), strict=True):
            own = whitened(noisy.force - exact.true_force, 1.0 / np.sqrt(noise_power(case, exact)))
            # A spectrum has as many real components of unit variance as the record has samples.
            power, size = power + float(own @ own), size + exact.time.size
    assert power / size == pytest.approx(1.0, abs=0.03)


def test_kept_outcomes_are_read_back_and_not_searched_again(tmp_path):
    keep = tmp_path / "kept.jsonl"
    wanted = clean_cases("first", [6100])
    first = outcomes(wanted, keep=keep, commit="abc")
    keep.write_text(keep.read_text() + '{"case": {"ki')
    assert read_outcomes(keep) == first
    assert outcomes(wanted, keep=keep, commit="other") == first


def test_table_counts_by_hand():
    case = single_cases("first", [1], [0.1], ["stiffness"])[0]
    right = Outcome(
        case, False, ("stiffness",), ("stiffness",), 0.95, ("a", "b"), 1.1, 1.0, "abc"
    )
    wrong = Outcome(case, False, ("stiffness",), (AGREES,), 0.6, ("stiffness",), 3.0, 1.0, "abc")
    text = table([right, right, wrong], list_wrong=True)
    assert "| named first, 10 % | 2 of 3 (66.7 %) |" in text
    assert "| among the stated, all sizes | 3 of 3 (100.0 %) |" in text
    assert "| 0.95 to 0.99 | 0.95 | 2 of 2 (100.0 %) |" in text
    assert text.count("expected stiffness") == 1


def test_interval_has_its_textbook_value():
    # Clopper and Pearson for 9 of 10, as tabulated.
    assert interval(9, 10) == pytest.approx((0.5550, 0.9975), abs=5e-5)
