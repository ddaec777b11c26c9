"""Records left out in turn: the model for the others stays one that there can be."""

import numpy as np
import pytest

from discover.gap.stages import stage
from discover.motion_fit import observe
from discover.naming.fit import fit_model, free_parameters
from discover.naming.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import record


def memory(frequency, order):
    """Return 600 D^order x of x = 10 mm sin(w t), by the textbook formula."""
    omega = 2.0 * np.pi * frequency

    def law(t, x, v, a):
        return 6.0 * omega**order * np.sin(omega * t + 0.5 * np.pi * order)

    return law


def test_an_order_stays_within_its_bounds_where_one_record_contradicts_the_others():
    rng = np.random.default_rng(2)
    tests = [(1.0, 1.99), (2.0, 1.99), (4.0, 1.6)]
    rows = [
        record_rows(observe(record(f, 0.01, memory(f, order), rng, noise=0.002)))
        for f, order in tests
    ]
    start = ForceModel((FittedTerm("fractional-derivative", 600.0, {"order": 1.8}),))
    unseen = stage(rows, fit_model(rows, start, free_parameters(start))).unseen
    assert len(unseen) == len(tests)
    assert all(np.isfinite(m.percent) and m.percent > 5.0 for m in unseen)


def test_what_only_the_record_left_out_tells_about_stays():
    """One record alone is beyond the channel's range: the others can't tell where it ends."""
    rng = np.random.default_rng(4)
    top = 1500.0

    def law(t, x, v, a):
        force = 120.0 * a + 800.0 * v
        return force - 100.0 * np.logaddexp(0.0, (force - top) / 100.0)

    tests = [(f, a) for f in (0.5, 1.0, 2.0) for a in (0.004, 0.012)]
    rows = [record_rows(observe(record(f, a, law, rng))) for f, a in [*tests, (4.0, 0.024)]]
    assert sum(float(r.observation.measured.max()) > 0.98 * top for r in rows) == 1
    limit = {"limit": 1400.0, "softness": 200.0, "side": 1.0}
    start = ForceModel(
        (
            FittedTerm("inertia", 100.0), FittedTerm("viscous-damping", 700.0),
            FittedTerm("sensor-clipping", 0.9, limit),
        )
    )
    found = stage(rows, fit_model(rows, start, free_parameters(start)))
    for seen, unseen in zip(found.misfits, found.unseen, strict=True):
        assert unseen.percent == pytest.approx(seen.percent, rel=0.1)
