"""A small part of the blind study, held to its bars less the error of a count.

Of each set a third of the effects of one device at one size and four campaigns with nothing hidden,
and of the first three pairs: 43 campaigns, where the whole study has more than 2,000.
"""

import pytest

from tests.calibration.counting import holds
from tests.calibration.gap.case import SETS, clean_cases, pair_cases, single_cases
from tests.calibration.gap.study import IMPOSSIBLE, outcomes
from tests.calibration.gap.table import TIMES_NOISE, bars

pytestmark = pytest.mark.sweep
DEVICE = 10_000  # apart from those of the kept table, as the campaigns below
CLEAN, PAIRS = range(DEVICE + 1000, DEVICE + 1004), range(DEVICE + 3000, DEVICE + 3003)
SIZES = (0.2, 0.1, 0.05)


def part(kind, place):
    """Return a third of the effects of one device at one size."""
    return single_cases(kind, [DEVICE], [SIZES[place]])[place::3]


@pytest.mark.parametrize(
    ("kind", "place"),
    [("first", 2), ("second", 0), ("third", 1)],
)
def test_effects_are_named_and_close_the_gap(kind, place):
    bar = bars(kind)
    found = [o for o in outcomes(part(kind, place)) if o.named[0] != IMPOSSIBLE]
    single = [o for o in found if o.case.ids != ("outside",)]
    outside = [o for o in found if o.case.ids == ("outside",)]
    assert len(single) >= 6
    assert holds([o.right for o in single], bar.named[SIZES[place]])
    assert holds([o.stated for o in single], bar.stated)
    assert holds([o.ratio <= TIMES_NOISE for o in single if o.right], bar.closed)
    assert holds([o.right for o in outside], bar.unknown)
    assert holds([o.right or o.probability <= 0.9 for o in outside], 1.0 - bar.sure)


@pytest.mark.parametrize("kind", SETS)
def test_nothing_hidden_agrees(kind):
    assert holds([o.right for o in outcomes(clean_cases(kind, CLEAN))], bars(kind).agrees)


def test_two_at_once_are_both_named():
    kind = SETS[0]
    found = [o for o in outcomes(pair_cases(kind, PAIRS)) if o.named[0] != IMPOSSIBLE]
    assert holds([o.both for o in found], bars(kind).both)
