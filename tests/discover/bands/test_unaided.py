"""A device beside whose remainder, as great as its force, no structure is more probable."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.extras import searched_with
from discover.bands.found import held, ids_of
from discover.records import Campaign, Record
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.bouc_wen import driven, random_force

pytestmark = pytest.mark.slow
STEP, COUNT = 1.0 / 750.0, 8192


def random_test(size, rng):
    force = random_force(size, COUNT, STEP, rng)
    x = driven(force, STEP, 8)
    noise = 0.002 * force.std() * rng.standard_normal(COUNT)
    seen = x + 8e-7 * rng.standard_normal(COUNT)
    return Record(f"{size:g}n.csv", STEP * np.arange(COUNT), force + noise, seen)


def test_where_a_remainder_stands_for_the_whole_law_a_family_begins_with_what_explains_more():
    rng = np.random.default_rng(8)
    tests = tuple(random_test(size, rng) for size in (20.0, 50.0))
    device = replace(
        prepare(Campaign("bouc-wen", tests), StudyOptions()).device, family="integer"
    )
    way = searched_with(device, (), None)
    one = way.fewer[0]
    beside, alone = (
        way.variants[held(device, way.search, banded).variants[0]]
        for banded in (one, way.search.unaided(one))
    )
    assert set(ids_of(alone)) > set(ids_of(beside))
