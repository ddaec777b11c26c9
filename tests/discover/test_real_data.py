"""Measurements that nobody here made: published coefficients, nothing invented."""

from pathlib import Path

import pytest

from discover.friction_parts import whole_friction
from discover.readers import read_campaign
from discover.study import StudyOptions, run_study
from discover.words import zero_possible

FOLDER = Path(__file__).parents[3] / "shared" / "real-data"
needs_data = pytest.mark.skipif(not FOLDER.is_dir(), reason="measured data not beside the checkout")


PUBLISHED = ("inertia", "viscous-damping", "coulomb-friction", "force-offset")


def coefficients(study):
    """Return each term's coefficient; friction's parts add up."""
    found = {}
    for band in study.bands:
        for t in band.terms:
            found[t.fitted.id] = found.get(t.fitted.id, 0.0) + t.fitted.coefficient
    return found | {n.id: n.value for n in study.nuisance}


def holds(study, name, value):
    """Tell whether the interval of a term, or of all friction, in the only band holds a value."""
    (band,) = study.bands
    terms = whole_friction([t.to_dict() for t in band.terms])
    ends = [t["interval"] for t in terms if t["id"] == name]
    return any(low <= value <= high for low, high in ends)


@pytest.fixture(scope="module")
def published():
    return run_study(read_campaign(FOLDER / "emps"), StudyOptions(terms=PUBLISHED))


@needs_data
def test_published_values_of_emps_lie_in_the_intervals_of_its_published_terms(published):
    """Published are they for friction that jumps; friction that is found reverses and falls."""
    assert holds(published, "inertia", 95.1089)
    assert holds(published, "viscous-damping", 203.5034)
    assert holds(published, "coulomb-friction", 20.3935)
    assert holds(published, "force-offset", -3.1648)
    found = coefficients(published)
    assert found["inertia"] == pytest.approx(95.1, rel=0.01)
    assert found["force-offset"] == pytest.approx(-3.19, rel=0.05)


@needs_data
@pytest.mark.xfail(strict=True, reason="196.8 N s/m and 21.08 N, beside friction that falls")
def test_emps_gives_its_published_damping_and_friction_for_its_published_terms(published):
    found = coefficients(published)
    assert found["viscous-damping"] == pytest.approx(203.0, rel=0.03)
    assert found["coulomb-friction"] == pytest.approx(20.4, rel=0.03)


@needs_data
def test_the_intervals_of_emps_s_damping_and_friction_are_narrow(published):
    for term in published.bands[0].terms:
        if term.fitted.id in ("viscous-damping", "coulomb-friction"):
            assert term.interval[1] - term.interval[0] < 0.4 * term.fitted.coefficient


@pytest.fixture(scope="module")
def emps():
    return run_study(read_campaign(FOLDER / "emps"))


@pytest.mark.sweep
@needs_data
def test_emps_searched_freely_differs_by_direction_and_has_no_fractional_term(emps):
    (band,) = emps.bands
    found = coefficients(emps)
    assert (band.structure, band.family) == ("IOIM-linear", "integer")
    assert "fractional-derivative" not in found
    assert {"asymmetric-damping", "force-offset"} & set(found)
    told = {e.term.fitted.id for e in band.extras if not zero_possible(e.term.interval)}
    assert told == {e.term.fitted.id for e in band.extras}


@pytest.mark.sweep
@needs_data
def test_emps_searched_freely_gives_its_published_inertance(emps):
    assert coefficients(emps)["inertia"] == pytest.approx(95.1, rel=0.01)
    assert emps.relative_error_percent < 3.3


@pytest.mark.sweep
@needs_data
@pytest.mark.xfail(strict=True, reason="189 N s/m and 22.1 N are found, in three curves")
def test_emps_searched_freely_gives_its_published_damping_and_friction(emps):
    found = coefficients(emps)
    assert found["viscous-damping"] == pytest.approx(203.0, rel=0.03)
    assert found["coulomb-friction"] == pytest.approx(20.4, rel=0.03)


@pytest.mark.sweep
@needs_data
def test_a_real_inerter_has_its_inertance_friction_with_memory_and_no_spring():
    study = run_study(read_campaign(FOLDER / "inerter-cvt-r0"))
    (band,) = study.bands
    assert band.structure == "IOIM-linear"
    assert holds(study, "inertia", 61.3)
    assert not {"stiffness", "fractional-derivative", "quadratic-damping"} & set(
        coefficients(study)
    )
    assert band.friction.key == "presliding_displacement"
    assert study.held_out_relative_error_percent < 7.0


@pytest.mark.sweep
@needs_data
def test_silverbox_is_a_duffing_oscillator():
    study = run_study(read_campaign(FOLDER / "silverbox"))
    assert set(coefficients(study)) == {
        "inertia", "viscous-damping", "stiffness", "cubic-stiffness", "force-offset"
    }
    assert study.relative_error_percent < 1.2
    assert study.held_out_relative_error_percent < 1.6


@pytest.mark.sweep
@needs_data
def test_a_strip_that_relaxes_has_a_memory_and_no_sensor_that_drifts():
    study = run_study(read_campaign(FOLDER / "elastomer-vhb4910"))
    found = set(coefficients(study))
    assert {"fractional-derivative", "relaxation"} & found
    assert not {"sensor-drift", "sensor-gain", "sensor-clipping", "time-delay"} & found
    assert study.held_out_relative_error_percent < 42.0  # of the baseline
    left = study.bands[0].remainder.percent  # most of it where noise is a hundred times the median
    assert left == pytest.approx(study.relative_error_percent, rel=0.3)


STRANGE = (
    "foot-single-cam", "fsae-damper-hard", "fsae-damper-soft", "inerter-cvt-steady",
    "mr-utfsm-0p5A", "seal-oring-1bar", "seal-xring",
)  # fmt: skip


@pytest.mark.sweep
@needs_data
@pytest.mark.parametrize("name", STRANGE)
def test_machines_that_no_structure_holds_for_have_no_sure_fractional_one(name):
    study = run_study(read_campaign(FOLDER / name))
    assert study.bands[0].remainder.percent > study.bands[0].noise_percent
    assert not any(b.structure == "FOIM" and b.probability >= 0.8 for b in study.bands)


@pytest.mark.sweep
@needs_data
def test_what_friction_turns_over_is_not_sure_where_the_misfit_says_the_same_everywhere():
    # Its loop's lag goes as 1 / frequency: a displacement, of a law that no structure has.
    friction = run_study(read_campaign(FOLDER / "mr-utfsm-0p5A")).bands[0].friction
    assert friction.key == "presliding_displacement" or friction.probability < 0.8
