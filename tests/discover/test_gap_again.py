"""A mended model that is given to another search."""

import json

import numpy as np
import pytest

from discover.gap import close_gap
from models.checks import InputError
from models.constitutive import SegmentedModel
from tests.discover.gap_data import campaign, device

MODEL = "fit:inertia,viscous-damping"
EFFECTS = ["quadratic-damping", "asymmetric-damping", "stiffness"]


def uneven(t, x, v, a):
    """Return quadratic damping that differs by direction, by less than its formula may be wrong."""
    return device(t, x, v, a) + 4e3 * v * np.abs(v) * (1.0 + 0.03 * np.sign(v))


@pytest.fixture(scope="module")
def mended():
    tests = campaign(uneven)
    return tests, close_gap(tests, MODEL, effects=EFFECTS)


def reread(model, **changes):
    return SegmentedModel.from_dict({**json.loads(json.dumps(model.to_dict())), **changes})


def test_the_model_says_what_was_added(mended):
    _, found = mended
    assert [r.effect for r in found.rounds] == ["quadratic-damping"]
    assert found.verdict == "closed"
    added = found.model.to_dict()["added"]
    assert set(added) == {"quadratic-damping"}
    assert [t.id for t in found.model.bands[0].model.terms][-len(added) :] == added
    assert reread(found.model) == found.model


@pytest.mark.parametrize("fixed", [False, True])
def test_what_was_left_for_its_shape_is_left_again(mended, fixed):
    tests, found = mended
    again = close_gap(tests, reread(found.model), fixed=fixed, effects=EFFECTS)
    assert again.rounds == ()
    assert again.verdict == "agrees"
    assert again.model.added == found.model.added
    assert any("formulas of the added effects" in f.text for f in again.findings)
    plain = close_gap(tests, reread(found.model, added=[]), fixed=fixed, effects=EFFECTS)
    assert (plain.verdict, len(plain.rounds)) != ("agrees", 0)


def test_ids_that_are_not_the_last_terms_are_refused(mended):
    with pytest.raises(InputError, match="added must be the ids of the last terms"):
        reread(mended[1].model, added=["stiffness"])
    with pytest.raises(InputError, match="added must be a list of ids"):
        reread(mended[1].model, added="end-stop")
