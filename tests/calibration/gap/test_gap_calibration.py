"""A small seeded part of the blind study, held to the bars less the binomial error."""

import numpy as np
import pytest

from tests.calibration.gap.study import cases, outcomes

pytestmark = pytest.mark.slow

DISTINCT = (
    "stiffness", "cubic-stiffness", "force-offset", "asymmetric-damping", "stribeck-friction",
    "hysteresis", "sensor-clipping", "end-stop",
)


def test_distinct_effects_are_named_first():
    found = outcomes(cases([61], [0.1], DISTINCT))
    right = sum(o.right for o in found)
    bar, count = 0.9, len(found)
    assert right / count >= bar - 2.0 * np.sqrt(bar * (1.0 - bar) / count)


def test_nothing_hidden_agrees():
    found = outcomes([({}, seed) for seed in range(6100, 6110)])
    assert sum(o.right for o in found) >= 9


def test_what_no_entry_explains_is_unknown():
    found = outcomes(cases([62], [0.1], ("outside:pump-pulsation", "outside:subharmonic")))
    assert all(o.named[0] == "unknown" for o in found)
