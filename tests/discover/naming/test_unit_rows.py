"""Rows of terms: short cuts give what the whole record gives."""

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.naming import contest as contest_module
from discover.naming.contest import run_contest
from discover.naming.fit import fit_model, free_parameters
from discover.naming.forces import model_force
from discover.naming.refine import refine
from discover.naming.rows import record_rows
from discover.naming.unit_rows import UnitRows
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

BASELINE = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 700.0)))
EFFECTS = ("stiffness", "coulomb-friction", "backlash", "series-compliance")


@pytest.fixture(scope="module")
def rows():
    """Return the rows of tests of a device that the baseline describes."""
    return [record_rows(o) for o in observe_all(campaign(device, seed=5).records, 1)]


@pytest.mark.parametrize("speeds", [(1e-3, 1.0001e-3), (1e-3, 5e-3), (2e-4, 0.3), (0.0, 1e-3)])
def test_friction_over_another_range_is_projected_where_it_differs(rows, speeds):
    units = UnitRows()
    for r in rows:
        for speed in speeds:
            friction = FittedTerm("coulomb-friction", 1.0, {"transition_speed": speed})
            whole = r.project(model_force(r.observation, ForceModel((friction,))))
            np.testing.assert_allclose(units.of(r, friction), whole, rtol=1e-9, atol=1e-9)


def test_rows_of_a_model_are_those_of_its_terms_and_of_what_a_record_holds():
    held = (FittedTerm("viscous-damping", 700.0),)
    seen = observe_all(campaign(device, seed=5).records, 1)
    rows = [record_rows(o, held=held if i % 2 else ()) for i, o in enumerate(seen)]
    model = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("coulomb-friction", 40.0)))
    parts = []
    for r in rows:
        whole = ForceModel((*model.terms, *r.held))
        parts.append(r.project(model_force(r.observation, whole)))
    expected = np.concatenate(parts)
    found = UnitRows().of_model(rows, model)
    np.testing.assert_allclose(found, expected, atol=2e-3 * float(np.abs(expected).max()))


def test_joints_that_few_records_speak_against_are_not_among_the_best(monkeypatch):
    """The best joint of the grid is the same whether all are tried on all records or not."""

    def law(t, x, v, a):
        return device(t, x, v, a) + 60.0 * np.tanh((v - 0.02 * a) / 2e-2)

    rows = [record_rows(o) for o in observe_all(campaign(law, seed=6).records, 1)]
    fit = fit_model(rows, BASELINE, free_parameters(BASELINE))
    few = run_contest(rows, fit, EFFECTS)
    monkeypatch.setattr(contest_module, "_TELLING", len(rows))
    every = run_contest(rows, fit, EFFECTS)
    for name in EFFECTS:
        best, screened = every.best(name), few.best(name)
        assert (best is None) == (screened is None)
        if best is not None and screened is not None:
            assert screened.chi2 <= 1.05 * best.chi2


def test_nothing_is_refined_where_model_and_records_agree(rows):
    fit = fit_model(rows, BASELINE, free_parameters(BASELINE))
    contest = run_contest(rows, fit, EFFECTS)
    assert contest.probabilities["agrees"] > 0.9
    same, fits = refine(rows, fit, contest, EFFECTS)
    assert fits == {} and same is contest
