import numpy as np
import pytest

from discover.data_check import TELLING
from discover.data_check.separation import expected_pairs, inseparable_pairs
from tests.discover.data_check.plan import (
    SINGLE,
    WIDE,
    checked,
    louder,
    planned,
    record,
    white,
)


def expected_gap(truth, model, plan):
    gaps = [g for p in expected_pairs(plan) for g in p.gaps]
    return next(g.nats for g in gaps if (g.truth, g.model) == (truth, model))


def open_pairs(plan):
    return {p.structures: p for p in inseparable_pairs(expected_pairs(plan), plan)}


@pytest.fixture(scope="module")
def wide():
    return planned(WIDE)


@pytest.fixture(scope="module")
def single():
    return planned(SINGLE)


def test_at_one_frequency_a_fractional_order_is_mass_and_damper(single):
    assert expected_gap("FOIM", "IOIM-linear", single) < 1e-6
    pairs = open_pairs(single)
    assert "single frequency (2 Hz)" in pairs["FOIM", "IOIM-linear"].why
    assert pairs["FOIM", "IOIM-linear"].gap < 1e-6


def test_over_a_wide_plan_the_structures_are_apart(wide):
    assert open_pairs(wide) == {}
    assert expected_gap("FOIM", "IOIM-linear", wide) > 100.0


def test_a_larger_model_always_reproduces_a_smaller_one(wide):
    assert expected_gap("IOIM-linear", "IOIM-laminar", wide) < 1e-9
    assert expected_gap("IOIM-laminar", "IOIM-linear", wide) > TELLING


@pytest.mark.parametrize("truth", ["FOIM", "IOIM-turbulent"])
def test_the_gap_falls_with_the_square_of_the_noise(wide, truth):
    quiet = expected_gap(truth, "IOIM-laminar", wide)
    loud = expected_gap(truth, "IOIM-laminar", louder(wide, 3.0))
    assert loud == pytest.approx(quiet / 9.0, rel=1e-6)


def test_the_gap_equals_least_squares_on_the_samples_themselves(wide):
    """The same question asked in the time domain: exact columns, white noise in every record."""
    sigma = np.array([1.0, 3.0, 2.0, 5.0, 1.0, 4.0])
    columns, truth, measured = [], [], []
    for (frequency, amplitude), own in zip(WIDE, sigma, strict=True):
        omega = 2.0 * np.pi * frequency
        phase = omega * np.arange(800) / (100.0 * frequency)
        test = record(frequency, amplitude, noise=0.0)
        velocity = amplitude * omega * np.cos(phase)
        acceleration = -amplitude * omega**2 * np.sin(phase)
        columns.append(np.stack([acceleration, velocity, np.sign(velocity)]) / own)
        truth.append(amplitude * omega**1.5 * np.sin(phase + 0.75 * np.pi) / own)
        measured.append(test.force / own)
    design, force = np.concatenate(columns, axis=1).T, np.concatenate(truth)
    size = float(np.linalg.norm(np.concatenate(measured)))
    force *= size / np.linalg.norm(force)
    scale = np.linalg.norm(design, axis=0)
    misfit = force - design / scale @ np.linalg.lstsq(design / scale, force, rcond=None)[0]
    gap = expected_gap("FOIM", "IOIM-linear", white(wide, sigma, size))
    assert gap == pytest.approx(0.5 * misfit @ misfit, rel=0.02)


def test_much_noise_leaves_turbulent_and_laminar_friction_open():
    pairs = open_pairs(planned(WIDE[1:3], noise=0.3))
    assert "odds of only" in pairs["IOIM-laminar", "IOIM-turbulent"].why


def test_a_plan_of_one_amplitude_can_not_decide_the_dean_check():
    found = checked(((0.5, 0.01), (1.0, 0.01), (2.0, 0.01)))
    assert any("all tests run at 10 mm" in f.text for f in found.findings)
    assert found.passed
    assert not any("all tests run" in f.text for f in checked(WIDE).findings)


def test_a_plan_of_one_frequency_can_not_give_an_order():
    assert any("all tests run at 2 Hz" in f.text for f in checked(SINGLE).findings)


def test_harmonics_of_the_drive_are_no_plan():
    """Two percent of a second harmonic would formally tell an order at a single frequency."""
    bent = planned(SINGLE, second=0.02)
    assert expected_gap("FOIM", "IOIM-linear", bent) < 1e-6
    assert ("FOIM", "IOIM-linear") in open_pairs(bent)


def test_what_is_inseparable_is_what_the_pairs_say():
    document = checked(SINGLE).to_dict()
    assert len(document["pairs"]) == 6
    stated = [(p["structures"], p["gap_nats"]) for p in document["pairs"] if not p["separable"]]
    assert stated == [(p["structures"], p["gap"]) for p in document["inseparable"]]
    for pair in document["pairs"]:
        lesser = min(g["gap_nats"] for g in pair["expected"] if g["word"] != "nested")
        assert pair["gap_nats"] == lesser
        assert pair["separable"] == (lesser >= TELLING)


def test_only_cases_of_a_structure_are_nested_in_it():
    pairs = {p.structures: p for p in checked(SINGLE).pairs}
    assert {names for names, p in pairs.items() if p.nested} == {
        ("IOIM-linear", "IOIM-laminar"),
        ("IOIM-linear", "IOIM-turbulent"),
    }
    for names, pair in pairs.items():
        if pair.nested:
            assert [g.word for g in pair.gaps] == ["nested", "separable"], names
