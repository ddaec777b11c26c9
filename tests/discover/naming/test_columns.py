"""Columns of candidates that are kept from contest to contest."""

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.naming import columns as module
from discover.naming.candidates import Part, Variant
from discover.naming.columns import CandidateColumns, candidate_columns
from discover.naming.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import campaign, device

HEAVY = ForceModel((FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0)))
LIGHT = ForceModel((FittedTerm("inertia", 40.0), FittedTerm("viscous-damping", 800.0)))
CUBE, LAW = Part("cubic-stiffness"), Part("power-law-damping", {"exponent": 1.6})
SPRING = Part("series-compliance", {"loss": 0.1, "inside": 1.0}, 1e-6)
CHOSEN = [
    Variant("cubic-stiffness", (CUBE,), 0),
    Variant("series-compliance", (SPRING,), 1),
    Variant("power-law-damping", (LAW, CUBE), 1),
]


@pytest.fixture(scope="module")
def rows():
    return [record_rows(o) for o in observe_all(campaign(device, seed=5).records, 1)]


@pytest.mark.parametrize("most", [0.0, 256e6])
def test_kept_columns_are_those_that_are_evaluated(rows, most, monkeypatch):
    """A change of the input depends on the model beside it, an added force does not."""
    monkeypatch.setattr(module, "_MOST_KEPT", most)
    kept = CandidateColumns(rows)
    for model in (HEAVY, LIGHT, HEAVY):
        expected = candidate_columns(rows, model, CHOSEN)
        size = 1e-12 * np.abs(expected).max(axis=1, keepdims=True)
        assert (np.abs(kept.of(model, CHOSEN) - expected) <= size).all()
    light, heavy = (candidate_columns(rows, m, CHOSEN)[1] for m in (LIGHT, HEAVY))
    assert np.abs(light - heavy).max() > 0.1 * np.abs(heavy).max()


def test_what_adds_a_force_is_evaluated_once(rows, monkeypatch):
    asked = []
    plain = module._columns
    monkeypatch.setattr(module, "_columns", lambda r, m, p: asked.append(list(p)) or plain(r, m, p))
    kept = CandidateColumns(rows)
    kept.of(HEAVY, CHOSEN)
    kept.of(LIGHT, CHOSEN)
    assert asked == [[CUBE, SPRING, LAW], [SPRING]]
