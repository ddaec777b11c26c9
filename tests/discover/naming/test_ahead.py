"""Two effects at once, where no straight line leads to either."""

from dataclasses import replace

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.naming.ahead import pairs_ahead
from discover.naming.contest import leaves_much, run_contest
from discover.naming.fit import fit_model, free_parameters
from discover.naming.refine import refine
from discover.naming.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

EFFECTS = ("viscous-damping", "power-law-damping", "end-stop", "coulomb-friction")
BASELINE = ForceModel((FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 700.0)))


def contest_of(law):
    rows = [record_rows(o) for o in observe_all(campaign(law, seed=2).records, 1)]
    fit = fit_model(rows, BASELINE, free_parameters(BASELINE))
    contest, fits = refine(rows, fit, run_contest(rows, fit, EFFECTS), EFFECTS)
    return rows, contest, fits


@pytest.fixture(scope="module")
def two():
    """Return the contest where a stop and friction are missing."""

    def law(t, x, v, a):
        beyond = np.maximum(np.abs(x) - 0.0085, 0.0)
        return device(t, x, v, a) + 4e4 * beyond * np.sign(x) + 40.0 * np.tanh(v / 1e-3)

    return contest_of(law)


def test_what_has_an_impossible_sign_leaves_the_lead_to_the_next(monkeypatch):
    """Refused when it was tried, it had left everything to "unknown"."""

    def law(t, x, v, a):
        return device(t, x, v, a) + 40.0 * np.tanh(v / 1e-3)

    _, contest, fits = contest_of(law)
    assert contest.ranked[0][0] == "coulomb-friction" in fits
    assert "power-law-damping" not in fits
    monkeypatch.setattr(
        "discover.naming.refine.pulls", lambda terms: terms[-1].id == "coulomb-friction"
    )
    _, contest, fits = contest_of(law)
    assert contest.best("coulomb-friction") is None
    assert "power-law-damping" in fits


def test_a_pair_is_fitted_together_and_leaves_less_than_either(two):
    rows, contest, fits = two
    pairs = pairs_ahead(rows, contest, fits, EFFECTS)
    best = min(pairs, key=lambda e: e.chi2)
    assert set(best.effects) == {"end-stop", "coulomb-friction"}
    assert best.chi2 < 1.3 * contest.rows
    assert best.chi2 < 0.1 * min(f.chi2 for f in fits.values())
    assert len(best.variants) == len(best.coefficients) == 2


def test_a_pair_of_straight_lines_that_explains_it_leaves_little(two):
    """The second is sought by fits only where neither an effect nor a pair comes close."""
    rows, contest, _ = two
    alone = [e for e in contest.entries if len(e.effects) < 2]
    lead = next(e.effects[0] for e in alone if e.effects)
    assert leaves_much(rows, replace(contest, entries=tuple(alone)), lead)
    assert not leaves_much(rows[:3], contest, lead)


def test_what_one_effect_explains_needs_no_second():
    def law(t, x, v, a):
        return device(t, x, v, a) + 40.0 * np.tanh(v / 1e-3)

    rows, contest, fits = contest_of(law)
    assert not leaves_much(rows, contest, "coulomb-friction")
    assert pairs_ahead(rows, contest, fits, EFFECTS) == ()
