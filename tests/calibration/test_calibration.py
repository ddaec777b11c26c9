"""A seeded tenth of the calibration study, against its bars less the binomial error."""

import numpy as np
import pytest

from tests.calibration.generator import random_case
from tests.calibration.proposals import standing
from tests.calibration.study import BARS, outcomes, rates, share, upper_limit
from tests.calibration.truth import expected_gap


def test_the_true_structure_has_no_gap_to_the_noise_free_force():
    for seed in (0, 1, 2, 3, 5):
        case = random_case(seed)
        assert expected_gap(case, case.structure) < 1e-6


def test_the_generator_makes_the_noise_that_it_states():
    case = random_case(1)
    test, record = case.tests[-1], case.campaign.records[-1]
    noise = record.force - test.clean
    step = noise[1:] - test.correlation * noise[:-1]
    assert np.std(step) == pytest.approx(
        test.sigma * np.sqrt(1.0 - test.correlation**2), rel=0.15
    )


@pytest.mark.slow
def test_a_tenth_of_the_calibration_study_holds_its_bars():
    found = outcomes(range(1000, 1025))
    for question, (right, asked) in rates(found).items():
        if asked:
            doubt = upper_limit(right, asked) - right / asked
            assert share(question, right, asked, found) + doubt >= BARS[question], question
    assert np.mean([o.equivalents for o in found if o.separable]) <= 1.3


@pytest.mark.slow
def test_the_proposed_next_test_tells_more_than_most_others():
    found = [s for s in (standing(seed) for seed in range(30000, 30024)) if s is not None]
    assert found
    assert np.mean([s >= 0.75 for s in found]) >= 0.75
