"""A seeded tenth of the calibration study, against its bars less the binomial error."""

import numpy as np
import pytest

from tests.calibration import proposals, rates, rig, study
from tests.calibration.generator import FEWEST, MOST, random_case
from tests.calibration.noise import KINDS, power_law, random_noise
from tests.calibration.truth import expected_gap, least_gap


def test_the_true_structure_has_no_gap_to_the_noise_free_force():
    for seed in (0, 1, 2, 3, 5):
        case = random_case(seed)
        assert expected_gap(case, case.structure) < 1e-6


def test_one_band_falls_short_of_two_laws():
    case = random_case(4)
    assert least_gap(case) > 0.0
    assert expected_gap(case, "FOIM") >= least_gap(case)


@pytest.mark.parametrize("kind", KINDS)
def test_noise_has_unit_variance_from_its_first_sample_and_whitens(kind):
    rng = np.random.default_rng(3)
    noise = random_noise(rng, kind, 600)
    drawn = np.array([noise.draw(600, rng) for _ in range(400)])
    assert np.mean(drawn[:, :5] ** 2) == pytest.approx(1.0, abs=0.2)
    assert np.mean(drawn**2) == pytest.approx(1.0, abs=0.15)
    white = noise.whiten(drawn.T)
    assert np.mean(white**2) == pytest.approx(1.0, abs=0.02)
    for lag in (1, 2, 7):
        assert abs(np.mean(white[lag:] * white[:-lag])) < 0.02


def test_power_law_noise_falls_as_stated():
    poles = power_law(1.0, 256)
    omega = 2.0 * np.pi * np.array([0.05, 0.2])
    transfer = np.abs(np.exp(-1j * np.outer(omega, np.arange(poles.size))) @ poles) ** -2.0
    assert transfer[0] / transfer[1] == pytest.approx(4.0, rel=0.15)


def test_plans_hold_as_many_records_as_stated():
    for seed in range(0, 40, 4):
        case = random_case(seed)
        assert len(case.tests) <= MOST
        assert len(case.tests) >= FEWEST or case.plan == "single"


@pytest.mark.sweep
def test_a_tenth_of_the_calibration_study_holds_its_bars():
    found = study.outcomes(range(1000, 1020))
    for question, (right, asked) in rates.rates(found).items():
        if asked:
            assert rates.limits(right, asked)[1] >= rates.BARS[question], question
    stated = [(o.probability, o.first) for o in found]
    value, asked = rates.shortfall(stated)
    assert value <= rates.MOST_SHORTFALL + 1.96 * np.sqrt(0.8 * 0.2 / asked)
    assert np.mean([o.equivalents for o in found if o.separable]) <= 1.4


@pytest.mark.sweep
def test_a_tenth_of_the_rig_study_runs_and_is_not_surer_than_right():
    found = rig.outcomes(range(300, 304))
    assert found
    sure = [o.right for o in found if o.probability >= rates.SURE]
    if sure:
        assert rates.limits(sum(sure), len(sure))[1] >= rates.SURE - rates.MOST_SHORTFALL


@pytest.mark.sweep
def test_the_proposed_next_test_tells_more_than_most_others():
    found = proposals.standings(range(60000, 60013), 3)
    assert found
    right = sum(s >= proposals.QUARTER for s in found)
    assert rates.limits(right, len(found))[1] >= 0.75
