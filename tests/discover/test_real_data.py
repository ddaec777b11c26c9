"""Measurements that nobody here made: published coefficients, nothing invented."""

from pathlib import Path

import pytest

from discover.readers import read_campaign
from discover.study import StudyOptions, run_study

FOLDER = Path(__file__).parents[3] / "shared" / "real-data"
needs_data = pytest.mark.skipif(not FOLDER.is_dir(), reason="measured data not beside the checkout")


def coefficients(study):
    found = {t.fitted.id: t.fitted.coefficient for b in study.bands for t in b.terms}
    return found | {n.id: n.value for n in study.nuisance}


@needs_data
def test_emps_gives_its_published_values_for_its_published_terms():
    terms = ("inertia", "viscous-damping", "coulomb-friction", "force-offset")
    found = coefficients(run_study(read_campaign(FOLDER / "emps"), StudyOptions(terms=terms)))
    assert found["inertia"] == pytest.approx(95.1, rel=0.01)
    assert found["viscous-damping"] == pytest.approx(203.0, rel=0.03)
    assert found["coulomb-friction"] == pytest.approx(20.4, rel=0.03)
    assert found["force-offset"] == pytest.approx(-3.19, rel=0.05)


@needs_data
def test_emps_searched_freely_differs_by_direction_and_has_no_fractional_term():
    study = run_study(read_campaign(FOLDER / "emps"))
    (band,) = study.bands
    found = coefficients(study)
    assert band.family == "integer"
    assert "fractional-derivative" not in found
    assert {"asymmetric-damping", "force-offset"} & set(found)
    assert found["inertia"] == pytest.approx(95.1, rel=0.01)
    assert found["viscous-damping"] == pytest.approx(203.0, rel=0.03)
    assert found["coulomb-friction"] == pytest.approx(20.4, rel=0.03)
    assert study.relative_error_percent < 3.3


@needs_data
def test_silverbox_is_a_duffing_oscillator():
    study = run_study(read_campaign(FOLDER / "silverbox"))
    assert set(coefficients(study)) == {
        "inertia", "viscous-damping", "stiffness", "cubic-stiffness", "force-offset"
    }
    assert study.relative_error_percent < 1.2
    assert study.held_out_relative_error_percent < 1.6
