"""A study recovers stated models from their exact records, and says what it can't tell."""

from dataclasses import replace

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.rows import accuracy, pooled_percent
from discover.study import StudyOptions, run_study
from discover.words import error_lines
from tests.discover.exact import DEVICE_10, DEVICE_12, campaign, fractional, integer, segmented

M1 = (370.38 * 19.25, 0.48, 400.0)
M2 = (370.38 * 1.57, 1.89, 400.0)


def terms(band):
    return {t.fitted.id: t for t in band.terms}


def test_segmented_fractional_model_gives_both_orders_and_the_dean_boundary():
    study = run_study(campaign(segmented(DEVICE_12, M1, M2)))
    assert [b.structure for b in study.bands] == ["FOIM", "FOIM"]
    low, high = (terms(b)["fractional-derivative"] for b in study.bands)
    assert low.fitted.shape["order"] == pytest.approx(0.48, abs=0.02)
    assert high.fitted.shape["order"] == pytest.approx(1.89, abs=0.01)
    (boundary,) = study.boundaries
    assert boundary.bracket[0] < 100.0 < boundary.bracket[1]
    assert study.dean_check.verdict == "consistent"
    assert study.dean_check.amplitude_exponent_interval[0] < -1.0
    assert study.dean_check.amplitude_exponent_interval[1] < 0.0


def test_laminar_records_give_the_integer_family_without_a_boundary():
    c1, c2 = DEVICE_12.laminar_coefficients
    force = integer(370.38, c2, c1, 0.0, 400.0)
    study = run_study(campaign(force, held_out=(5, 17)))
    (band,) = study.bands
    assert band.family == "integer"
    assert band.structure == "IOIM-laminar"
    assert not study.boundaries
    assert study.dean_check.verdict == "no-boundary"
    assert terms(band)["inertia"].fitted.coefficient == pytest.approx(370.38, rel=0.01)
    inside = terms(band)["inertia"].interval
    assert inside[0] < 370.38 < inside[1]
    friction = [t.interval for t in band.terms if t.fitted.id == "coulomb-friction"]
    least, most = (sum(i[end] for i in friction) for end in (0, 1))
    assert 396.0 < least < 400.0 < most < 404.0  # sliding, whatever falls away beside it
    assert study.held_out_relative_error_percent == pytest.approx(2.0, abs=0.1)


def test_turbulent_records_give_the_turbulent_structure_without_a_boundary():
    c1, c2, c3 = DEVICE_10.turbulent_coefficients
    study = run_study(campaign(integer(73.82, c3, c2, c1, 550.0), DEVICE_10))
    (band,) = study.bands
    assert band.family == "integer"
    assert dict(band.equivalents)["IOIM-turbulent"] > 0.5
    assert not study.boundaries
    assert terms(band)["inertia"].fitted.coefficient == pytest.approx(73.82, rel=0.01)


def test_prediction_of_held_out_records_is_close_to_the_noise_free_force():
    c1, c2 = DEVICE_12.laminar_coefficients
    noisy = run_study(campaign(integer(370.38, c2, c1, 0.0, 400.0), seed=3))
    clean = campaign(integer(370.38, c2, c1, 0.0, 400.0), noise=0.0, frequencies=(0.7, 3.0, 8.0))
    predicted = [accuracy(observe(r), noisy.model.bands[0].model) for r in clean.records]
    assert pooled_percent(predicted) < 0.5


def test_a_single_frequency_is_said_to_leave_the_order_open():
    study = run_study(campaign(fractional(*M2), frequencies=(3.0,), amplitudes=(0.005, 0.01)))
    assert not study.identifiable
    structures = {s for s, _ in study.bands[0].equivalents}
    assert {"FOIM", "IOIM-linear"} <= structures
    assert any("single frequency" in f.text for f in study.findings)


def test_one_record_gives_one_band_and_says_why():
    study = run_study(campaign(fractional(*M2), frequencies=(3.0,), amplitudes=(0.01,)))
    assert len(study.bands) == 1
    assert any("one record can't show a boundary" in f.text for f in study.findings)


@pytest.mark.parametrize("frequencies", [(0.2, 0.5, 1.0, 2.0, 4.0, 8.0), (0.5, 2.0, 8.0)])
def test_a_delay_of_the_force_channel_is_found_and_corrected(frequencies):
    c1, c2 = DEVICE_12.laminar_coefficients
    law = integer(370.38, c2, c1, 0.0, 400.0)

    def late(amplitude, omega, theta):
        return law(amplitude, omega, theta - omega * 1e-3)

    study = run_study(campaign(late, frequencies=frequencies, amplitudes=(0.005, 0.015)))
    (delay,) = (n for n in study.nuisance if n.id == "time-delay")  # and not one of each test's own
    assert delay.value == pytest.approx(1e-3, rel=0.05)
    inertia = terms(study.bands[0])["inertia"].fitted.coefficient
    assert inertia == pytest.approx(370.38, rel=0.01)


def test_terms_that_are_asked_for_are_all_kept():
    options = StudyOptions(terms=("inertia", "viscous-damping", "coulomb-friction", "stiffness"))
    study = run_study(campaign(integer(370.38, 4000.0, 0.0, 0.0, 400.0)), options)
    assert set(terms(study.bands[0])) == set(options.terms)


def test_the_number_of_bands_can_be_fixed():
    few = campaign(fractional(*M2), frequencies=(0.5, 1.0, 3.0, 9.0), amplitudes=(0.005, 0.01))
    study = run_study(few, StudyOptions(bands=2))
    assert len(study.bands) == 2


def test_documents_hold_the_contract_keys():
    study = run_study(campaign(fractional(*M2), frequencies=(1.0, 3.0, 9.0)))
    document = study.to_dict()
    assert document["schema"] == "inerter.study/1"
    for key in ("coordinate", "relative_error_percent", "identifiable", "findings", "bands",
                "nuisance", "boundaries", "dean_check", "next_test", "version", "seed"):
        assert key in document
    for key in ("lower", "upper", "lower_hz", "upper_hz", "records", "family", "structure",
                "terms", "error_percent", "relative_error_percent", "noise_percent",
                "probability", "equivalents"):
        assert key in document["bands"][0]
    model = study.model_dict()
    assert model["schema"] == "inerter.model/1"
    assert model["bands"][0]["terms"][0]["id"] == "fractional-derivative"


def test_units_do_not_change_the_answer():
    base = campaign(fractional(*M2), frequencies=(0.5, 1.0, 3.0, 9.0))
    scaled = replace(
        base, records=tuple(replace(r, force=1000.0 * r.force) for r in base.records)
    )
    one, two = run_study(base), run_study(scaled)
    first, second = (terms(s.bands[0])["fractional-derivative"] for s in (one, two))
    assert second.fitted.coefficient == pytest.approx(1000.0 * first.fitted.coefficient, rel=1e-4)
    assert second.fitted.shape["order"] == pytest.approx(first.fitted.shape["order"], abs=1e-5)
    assert one.bands[0].probability == pytest.approx(two.bands[0].probability, abs=1e-3)
    assert np.isfinite(two.relative_error_percent)


def test_a_record_of_the_wrong_sign_is_an_error_that_the_study_says_first():
    c1, c2 = DEVICE_12.laminar_coefficients
    whole = campaign(integer(370.38, c2, c1, 0.0, 400.0), amplitudes=(0.01,))
    turned = replace(whole.records[3], force=-whole.records[3].force)
    records = (*whole.records[:3], turned, *whole.records[4:])
    options = StudyOptions(
        terms=("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction"), bands=1
    )
    study = run_study(replace(whole, records=records), options)
    assert study.findings[0].level == "error"
    assert study.findings[0].record == turned.file
    assert error_lines(study.to_dict())[0].startswith(f"Error in the data: {turned.file}: ")
    assert error_lines(run_study(whole, options).to_dict()) == []


def test_what_was_asked_for_and_could_not_be_done_is_said():
    c1, c2 = DEVICE_12.laminar_coefficients
    whole = campaign(integer(370.38, c2, c1, 0.0, 400.0))
    few = replace(whole, records=whole.records[:5], device=None)
    study = run_study(few, StudyOptions(coordinate="dean", bands=4))
    warned = " ".join(f.text for f in study.findings if f.level == "warning")
    assert "need the device's geometry" in warned
    assert "4 bands were asked for" in warned


def test_a_gradual_boundary_is_told_with_its_place_and_width():
    below, above = fractional(*M1), fractional(*M2)
    scale = 0.4  # of the logistic curve in the logarithm of frequency

    def force(amplitude, omega, theta):
        upper = 1.0 / (1.0 + (omega / (2.0 * np.pi * 1.2)) ** (-1.0 / scale))
        mixed = upper * above(amplitude, omega, theta)
        return mixed + (1.0 - upper) * below(amplitude, omega, theta)

    study = run_study(campaign(force, frequencies=tuple(np.geomspace(0.1, 15.0, 16))))
    assert [b.structure for b in study.bands] == ["FOIM", "FOIM"]
    (boundary,) = study.boundaries
    assert study.coordinate == "frequency"
    assert boundary.coordinate == pytest.approx(1.2, rel=0.1)
    assert boundary.width == pytest.approx(2.0 * np.log(9.0) * scale, rel=0.2)
