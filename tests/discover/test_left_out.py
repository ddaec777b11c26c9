"""Records left out in turn: the model for the others stays one that there can be."""

import numpy as np

from discover.gap.search import stage
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
