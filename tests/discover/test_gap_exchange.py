"""A name that was given while more was missing is given anew beside what was found since."""

from types import SimpleNamespace

import numpy as np
import pytest

from discover.gap import close_gap
from discover.gap.doubt import Doubt
from discover.gap.rounds import Open, _as_good, exchanged
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
    less = ForceModel((model.terms[0], model.terms[2]))
    bare = stage(rows, fit_model(rows, less, free_parameters(less)))
    rounds = [
        SimpleNamespace(effect=first.id, before=bare, stage=now),
        SimpleNamespace(effect="force-offset"),
    ]
    doubt = np.zeros(len(rows))
    left = Open(
        [i for i in TERMS if i not in there], rounds, more, True, False,
        Doubt(doubt), CandidateColumns(rows),
    )
    return rows, rows, now, left, doubt, {}


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


@pytest.mark.parametrize(("exponent", "good"), [(1.0, True), (1.3, False)])
def test_another_name_has_to_leave_as_little(exponent, good):
    def law(t, x, v, a):
        return 120.0 * a + 20.0 + 400.0 * np.sign(v) * np.abs(v) ** exponent

    rows, _, now, left, *_ = ended(law, FittedTerm("power-law-damping", 400.0, {"exponent": 1.2}))
    inertia, _, offset = now.fit.model.terms
    model = ForceModel((inertia, offset, FittedTerm("viscous-damping", 400.0)))
    other = stage(rows, fit_model(rows, model, free_parameters(model)))
    assert _as_good(rows, now, other, left.rounds[0]) is good


def test_a_search_ends_with_viscous_damping_where_a_small_offset_had_hidden_it():
    """Beside the offset friction's curve left more than noise, and a power of 0.25 was kept."""
    def law(t, x, v, a):
        seals = 2.0 / np.pi * (0.6 * np.arctan(v / 3e-4) + 0.4 * np.arctan(v / 24e-4))
        return 120.0 * a + 150.0 * v + 6000.0 * v * np.abs(v) + 200.0 * seals + 1.5

    asked = ("viscous-damping", "power-law-damping", "force-offset", "stribeck-friction",
             "fractional-derivative", "asymmetric-damping")
    lacking = "fit:inertia,quadratic-damping,coulomb-friction"
    found = close_gap(campaign(law), lacking, effects=asked)
    left = {t["id"] for t in found.to_dict()["mended"]}
    assert {"viscous-damping", "force-offset"} <= left
    assert "power-law-damping" not in left


def test_after_the_last_round_all_names_stay():
    law = FittedTerm("power-law-damping", 800.0, {"exponent": 0.9})
    assert exchanged(*ended(pushed, law, more=False)) is None
