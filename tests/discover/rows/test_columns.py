"""Columns as changes of the force pass them on."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.rows import RecordForces, force_rows, record_rows
from discover.rows.columns import Behind, force_columns
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import device, record

GAIN = {"load": 1.0, "load_power": 2.0}


@pytest.fixture(scope="module")
def rows():
    return record_rows(observe(record(1.0, 0.01, device, np.random.default_rng(0))))


def behind(rows, *terms):
    model = ForceModel((
        FittedTerm("inertia", 120.0),
        FittedTerm("viscous-damping", 800.0),
        FittedTerm("sensor-gain", 1e-3, GAIN),
    ))  # fmt: skip
    return Behind({rows.file: model}, {rows.file: RecordForces(rows)})(rows, terms)


def test_a_column_passes_a_gain_as_a_small_force_does(rows):
    # y = F (1 + g F^2 / N^2): a small force f is read as f (1 + 3 g F^2 / N^2).
    (found,) = behind(rows, FittedTerm("viscous-damping", 1.0))
    (plain,) = force_columns(rows, [FittedTerm("viscous-damping", 1.0)])
    assert np.linalg.norm(found) > 1.2 * np.linalg.norm(plain)


def test_a_change_is_the_slope_of_the_whole_as_it_grows(rows):
    # Central differences in the gain, beside a column of a force and in any order.
    gain, damper = FittedTerm("sensor-gain", 2e-3, GAIN), FittedTerm("viscous-damping", 5.0)
    law = (FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0))
    ends = [
        force_rows(rows, ForceModel((*law, FittedTerm("sensor-gain", 1e-3 + d, GAIN))))
        for d in (1e-6, -1e-6)
    ]
    slope = 2e-3 * (ends[0] - ends[1]) / 2e-6
    (alone,) = behind(rows, gain)
    np.testing.assert_allclose(alone, slope, atol=5e-3 * np.abs(slope).max())
    for terms, place in (((damper, gain), 1), ((gain, damper), 0)):
        found = behind(rows, *terms)
        np.testing.assert_array_equal(found[place], alone)
        np.testing.assert_array_equal(found[1 - place], behind(rows, damper)[0])


def test_a_change_too_great_to_have_a_square_is_no_column(rows):
    # y = F (1 + g (F / L)^2) at L = 1e-100 N: of F^3 / L^2 there is a number, of its square none.
    tiny = FittedTerm("sensor-gain", 1e-3, {**GAIN, "load": 1e-100})
    (found,) = RecordForces(rows).changes(ForceModel((FittedTerm("inertia", 120.0),)), [tiny])
    assert not np.any(found)
