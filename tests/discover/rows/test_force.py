"""A model's force in a record: over a cycle, in one test of several, as changes pass it on."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Record
from discover.rows import RecordForces, force_rows, record_rows
from discover.rows.columns import force_columns
from discover.rows.force import at_moments, drifts, in_test, misfit_power, steady, unit
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import device, record

LAW = (FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0))
DRIFT = FittedTerm("thermal-drift", -100.0, {"warming_time": 2.0})
GAIN = FittedTerm("sensor-gain", 0.05, {"load": 30.0, "load_power": 2.0})
STOP = FittedTerm("coulomb-friction", 40.0, {"transition_speed": 2e-3})


@pytest.fixture(scope="module")
def rows():
    return record_rows(observe(record(1.0, 0.01, device, np.random.default_rng(0))))


def test_a_cycle_goes_on_before_and_after_itself():
    grid = np.arange(64) / 64
    cycle = np.cos(2.0 * np.pi * grid) + grid * (1.0 - grid)
    place = np.array([-1.25, -0.015625, 0.0, 0.5, 0.984375, 1.0, 7.75])
    found = at_moments(cycle, place / 5.0, 5.0)
    phase = np.mod(place, 1.0)
    np.testing.assert_allclose(
        found, np.cos(2.0 * np.pi * phase) + phase * (1.0 - phase), atol=1e-12
    )
    # Between the last point and the first the force goes straight from one to the other.
    assert at_moments(cycle, np.array([127 / 128]), 1.0)[0] == pytest.approx(
        0.5 * (cycle[-1] + cycle[0]), rel=1e-12
    )


def offsets(*values):
    return [FittedTerm("force-offset", v, {"only": float(k)}) for k, v in enumerate(values, 1)]


def test_each_test_has_its_own_or_the_mean_of_the_others():
    model = ForceModel((*LAW, *offsets(-20.0, 5.0, 9.0)), "lab")
    assert in_test(model, 2).terms == (*LAW, offsets(0.0, 5.0)[1])
    unknown = in_test(model, 7)
    assert unknown.name == "lab"
    assert unknown.terms[:2] == LAW
    (own,) = unknown.terms[2:]
    assert (own.id, own.coefficient, own.shape["only"]) == ("force-offset", -2.0, 7.0)
    assert in_test(model, 0).terms == LAW
    plain = ForceModel(LAW)
    assert in_test(plain, 2) is plain


def test_terms_of_other_shape_have_means_of_their_own():
    each = ((10.0, 1.5, 1), (20.0, 1.5, 2), (7.0, 4.0, 1))
    terms = [
        FittedTerm("sensor-drift", c, {"settling_time": s, "only": float(k)}) for c, s, k in each
    ]
    found = in_test(ForceModel(tuple(terms)), 9).terms
    assert {t.shape["settling_time"]: t.coefficient for t in found} == {1.5: 15.0, 4.0: 7.0}


def test_what_drifts_is_what_has_no_steady_cycle():
    assert [drifts(t) for t in (*LAW, DRIFT, STOP)] == [False, False, True, False]
    assert steady(ForceModel((*LAW, DRIFT), "lab")) == ForceModel(LAW, "lab")
    with pytest.raises(ValueError, match="sensor-gain adds no force"):
        unit(GAIN, None)


@pytest.mark.parametrize("kept", [LAW, (*LAW, STOP), (*LAW, DRIFT)], ids=["law", "stop", "drift"])
def test_where_nothing_changes_the_force_terms_pass_on_as_they_are(rows, kept):
    forces = RecordForces(rows)
    found = forces.passed_on(ForceModel(kept), [*LAW, STOP, DRIFT])
    wanted = force_columns(rows, [*LAW, STOP, DRIFT])
    np.testing.assert_allclose(found, wanted, rtol=1e-6, atol=1e-6 * np.abs(wanted).max())
    added = forces.of_model(ForceModel((*kept, FittedTerm("stiffness", 3e3))))
    more = force_columns(rows, [FittedTerm("stiffness", 3e3)])[0]
    scale = np.abs(added).max()
    np.testing.assert_allclose(added - forces.of_model(ForceModel(kept)), more, atol=1e-9 * scale)


@pytest.mark.parametrize("kept", [(*LAW, GAIN), (*LAW, GAIN, DRIFT)], ids=["steady", "drifting"])
def test_what_a_change_passes_on_is_the_slope_of_the_whole(rows, kept):
    # Central differences of the force's rows in each coefficient.
    model, terms = ForceModel(kept), [*LAW, STOP, DRIFT]
    found = RecordForces(rows).passed_on(model, terms)
    for own, t in zip(found, terms, strict=True):
        ends = [
            force_rows(rows, ForceModel((*kept, FittedTerm(t.id, s * t.coefficient, t.shape))))
            for s in (1e-3, -1e-3)
        ]
        slope = (ends[0] - ends[1]) / 2e-3
        np.testing.assert_allclose(own, slope, atol=5e-3 * np.abs(slope).max())


def test_changes_are_what_a_unit_of_each_does(rows):
    model = ForceModel((*LAW, DRIFT))
    terms = [GAIN, FittedTerm("time-delay", 1e-3)]
    found = RecordForces(rows).changes(model, terms)
    before = force_rows(rows, model)
    for own, t in zip(found, terms, strict=True):
        after = force_rows(rows, ForceModel((*model.terms, t)))
        np.testing.assert_allclose(own * t.coefficient, after - before, rtol=1e-9, atol=1e-9)
        assert np.linalg.norm(own) > 0.0


def gain(k):
    return FittedTerm("sensor-gain", 0.01 * (k % 5), {"load": 30.0, "load_power": 2.0})


def test_forces_do_not_depend_on_what_was_asked_before(rows):
    # Units, sums and changed forces are kept: many models later they are still each model's own.
    forces = RecordForces(rows)
    lag = FittedTerm("time-delay", 2e-3)
    models = [
        ForceModel((FittedTerm("inertia", 10.0 * k), LAW[1], gain(k), lag)) for k in range(1, 24)
    ]
    first = [forces.of_model(m) for m in models]
    for model, own in zip(models, first, strict=True):
        np.testing.assert_array_equal(forces.of_model(model), own)
        np.testing.assert_allclose(force_rows(rows, model), own, rtol=1e-12, atol=1e-12)


def test_the_misfit_of_a_long_test_is_the_mean_square_of_what_is_left():
    time = np.arange(16_000) / 4000.0
    omega = 2.0 * np.pi * 2.5
    x, v = 0.01 * np.sin(omega * time), 0.01 * omega * np.cos(omega * time)
    law, drift = 800.0 * v - 120.0 * omega**2 * x, 100.0 * np.expm1(-time / 2.0) * -v
    noise = 0.5 * np.random.default_rng(0).standard_normal(time.size)
    seen = observe(Record("long.csv", time, law - drift + noise, x, frequency=2.5))
    for terms, left in ((LAW, noise - drift), ((*LAW, DRIFT), noise)):
        found = misfit_power(seen, ForceModel(terms))
        assert found == pytest.approx(np.mean(left**2), rel=0.01)


def test_only_a_test_with_sums_has_a_misfit(rows):
    with pytest.raises(ValueError, match="no sums"):
        misfit_power(rows.observation, ForceModel(LAW))
