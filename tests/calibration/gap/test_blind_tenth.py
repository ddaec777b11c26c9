"""A tenth of the blind study: one device of each set, held to the bars less the binomial error."""

import numpy as np
import pytest

from tests.calibration.gap.case import KEPT, clean_cases, pair_cases, single_cases
from tests.calibration.gap.study import IMPOSSIBLE, outcomes
from tests.calibration.gap.table import (
    AGREES,
    BARS,
    BOTH,
    CLOSED,
    STATED,
    SURE,
    TIMES_NOISE,
    UNKNOWN,
)

pytestmark = [pytest.mark.sweep, pytest.mark.parametrize("kind", KEPT)]
DEVICE = 10_000  # of the run before the kept one; clean campaigns and pairs follow it
CLEAN, PAIRS = range(DEVICE + 1000, DEVICE + 1020), range(DEVICE + 3000, DEVICE + 3010)


def deviation(bar, count):
    return 2.0 * np.sqrt(bar * (1.0 - bar) / count)


def holds(hits, bar):
    """Tell whether as many are right as by a search at the bar in 19 of 20 studies or more."""
    return sum(hits) / len(hits) >= bar - deviation(bar, len(hits))


@pytest.mark.parametrize("size", BARS)
def test_every_effect_is_named_and_closes_the_gap(kind, size):
    asked = [c for c in single_cases(kind, [DEVICE], [size]) if c.ids != ("outside",)]
    found = [o for o in outcomes(asked) if o.named[0] != IMPOSSIBLE]
    assert len(found) >= 20
    assert holds([o.right for o in found], BARS[size])
    assert holds([o.stated for o in found], STATED)
    assert holds([o.ratio <= TIMES_NOISE for o in found if o.right], CLOSED)


def test_nothing_hidden_agrees(kind):
    assert holds([o.right for o in outcomes(clean_cases(kind, CLEAN))], AGREES)


def test_what_no_entry_explains_is_unknown(kind):
    asked = [c for c in single_cases(kind, [DEVICE], list(BARS)) if c.ids == ("outside",)]
    found = outcomes(asked)
    assert holds([o.right for o in found], UNKNOWN)
    sure = [not o.right and o.probability > 0.9 for o in found]
    assert sum(sure) / len(sure) <= SURE + deviation(SURE, len(sure))


def test_two_at_once_are_both_named(kind):
    found = [o for o in outcomes(pair_cases(kind, PAIRS)) if o.named[0] != IMPOSSIBLE]
    assert holds([o.both for o in found], BOTH)
