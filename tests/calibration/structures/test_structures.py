"""A small part of the study, held to its bars less the error of a count."""

import math

import pytest

from tests.calibration.structures.run import outcomes
from tests.calibration.structures.sets import cases
from tests.calibration.structures.table import BARS, SURE

pytestmark = pytest.mark.sweep
SEED = 700  # apart from those of the kept table


def holds(hits, bar):
    """Tell whether as many are right as at the bar in 19 of 20 such studies or more."""
    spread = 2.0 * math.sqrt(bar * (1.0 - bar) / len(hits))
    return sum(hits) / len(hits) >= bar - spread


@pytest.fixture(scope="module")
def answered():
    part = {name: 5 for name in BARS} | {"two-boundaries": 1, "thin": 2}
    return {
        name: list(outcomes(cases(name, [SEED])[::step])) for name, step in part.items()
    }


@pytest.mark.parametrize("name", ["structures", "one-extra", "outside"])
def test_cores_are_named(answered, name):
    assert holds([o.core_right for o in answered[name]], BARS[name]["first"])


@pytest.mark.parametrize("name", ["structures", "one-extra", "outside"])
def test_no_boundary_is_invented(answered, name):
    whole = [o for o in answered[name] if o.kind != "SFOIM"]
    assert holds([o.bands == 1 for o in whole], BARS[name]["none"])


def test_both_boundaries_are_found(answered):
    three = [o for o in answered["two-boundaries"] if o.kind == "three-bands"]
    assert holds([o.bands_right for o in three], BARS["two-boundaries"]["number"])
    assert holds([all(o.brackets) for o in three], BARS["two-boundaries"]["brackets"])


def test_extras_are_named(answered):
    assert holds([o.extra_right for o in answered["one-extra"]], BARS["one-extra"]["extra"])


def test_remainders_have_their_size(answered):
    hits = [o.remainder_right for o in answered["outside"]]
    assert holds(hits, BARS["outside"]["remainder"])


def test_sure_answers_are_right(answered):
    sure = [
        o for some in answered.values() for o in some if o.stated is not None and o.stated > SURE
    ]
    assert holds([o.core_right for o in sure], 1.0 - BARS["structures"]["sure"])
