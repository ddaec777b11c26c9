"""What is left over of records whose noise is greatest where most of their force is."""

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Record
from discover.rows import accuracy, force_rows, record_rows
from discover.rows.accuracy import unexplained
from models.constitutive import FittedTerm, ForceModel

STEP, COUNT = 0.01, 6000
SPRING = ForceModel((FittedTerm("stiffness", 2e3),))


def strip(seed):
    """One slow loading and unloading; the load cell drifts as a random walk does."""
    rng = np.random.default_rng(seed)
    time = STEP * np.arange(COUNT)
    x = 0.04 * (1.0 - np.abs(2.0 * time / time[-1] - 1.0))
    drift = np.cumsum(0.003 * rng.standard_normal(COUNT))
    force = 2e3 * x + 4e5 * x**3 + drift + 1e-3 * rng.standard_normal(COUNT)
    return Record(f"{seed}.csv", time, force, x + 1e-7 * rng.standard_normal(COUNT))


def test_it_is_what_the_model_misses():
    seen = [observe(strip(seed)) for seed in range(3)]
    rows = [record_rows(o) for o in seen]
    left = unexplained(rows, [force_rows(r, SPRING) for r in rows]).percent
    missed = np.sqrt(np.mean([accuracy(o, SPRING).relative_percent ** 2 for o in seen]))
    assert left == pytest.approx(missed, rel=0.1)
