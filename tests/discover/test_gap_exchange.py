"""A name that was given while more was missing is given anew beside what was found since."""

from types import SimpleNamespace

import numpy as np
import pytest

from discover.gap.doubt import Doubt
from discover.gap.rounds import Open, exchanged
from discover.gap.stages import stage
from discover.motion_fit import observe_all
from discover.naming.columns import CandidateColumns
from discover.naming.fit import fit_model, free_parameters
from discover.naming.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS
from tests.discover.gap_data import campaign


def ended(law, first, *, more=True):
    """Return what a search is left with that named `first`, then a force's offset."""
    rows = [record_rows(o) for o in observe_all(campaign(law).records, 1)]
    model = ForceModel((FittedTerm("inertia", 120.0), first, FittedTerm("force-offset", 20.0)))
    now = stage(rows, fit_model(rows, model, free_parameters(model)))
    there = {t.id for t in model.terms}
    rounds = [SimpleNamespace(effect=n) for n in (first.id, "force-offset")]
    doubt = np.zeros(len(rows))
    left = Open(
        [i for i in TERMS if i not in there], rounds, more, True, False,
        Doubt(doubt), CandidateColumns(rows),
    )
    return rows, rows, now, left, doubt


def pushed(t, x, v, a):
    return 120.0 * a + 800.0 * v + 20.0


def test_a_power_law_becomes_viscous_damping_where_it_has_become_one():
    law = FittedTerm("power-law-damping", 800.0, {"exponent": 0.9})
    found = exchanged(*ended(pushed, law))
    assert found.effect == "viscous-damping"
    assert found.dropped == ("power-law-damping",)
    assert found.before.fit.model.terms[1].id == "power-law-damping"
    ids = [t.id for t in found.after.fit.model.terms]
    assert ids == ["inertia", "force-offset", "viscous-damping"]
    assert found.after.fit.model.terms[2].coefficient == pytest.approx(800.0, rel=0.01)
    assert found.contest.probabilities["viscous-damping"] > 0.5


def test_a_name_that_holds_is_kept():
    assert exchanged(*ended(pushed, FittedTerm("viscous-damping", 800.0))) is None


def test_no_other_name_takes_a_place_that_it_fills_worse():
    """Stribeck friction stands; beside the offset nothing else explains what it does."""
    def falling(t, x, v, a):
        return 120.0 * a + 20.0 + 60.0 * np.tanh(v / 1e-3) * np.exp(-((v / 0.02) ** 2))

    shape = {"stribeck_velocity": 0.02, "transition_speed": 1e-3, "form": 2.0}
    assert exchanged(*ended(falling, FittedTerm("stribeck-friction", 60.0, shape))) is None


def test_after_the_last_round_all_names_stay():
    law = FittedTerm("power-law-damping", 800.0, {"exponent": 0.9})
    assert exchanged(*ended(pushed, law, more=False)) is None
