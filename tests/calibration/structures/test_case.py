"""Campaigns are what their cases ask for."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from tests.calibration.structures.answerable import TOLD
from tests.calibration.structures.case import Case, build
from tests.calibration.structures.devices import CORES, KINDS
from tests.calibration.structures.friction import LAWS
from tests.calibration.structures.sets import SETS, cases
from tests.calibration.structures.told import left

SEED = 900


def test_structures_are_every_kind_law_and_twist_over_five_seeds():
    found = cases("structures", range(5))
    assert len(found) == 250
    assert len({(c.kind, c.friction, c.twist) for c in found}) == 250
    assert set(Counter(c.twist for c in found).values()) == {50}


def test_sets_hold_what_they_say():
    assert len(cases("two-boundaries", range(8))) == 64
    assert sum(c.kind == "three-bands" for c in cases("two-boundaries", range(8))) == 40
    extras = Counter((c.effect, c.kind) for c in cases("one-extra", [0]))
    assert len(extras) == 35
    assert len({(c.effect, c.kind) for c in cases("outside", [0])}) == 45
    assert {c.kind for c in cases("thin", [0])} == set(CORES)
    for name in SETS:
        every = cases(name, range(4))
        assert len({c.key for c in every}) == len(every)
        assert {c.friction for c in every} <= set(LAWS)


def test_a_campaign_is_the_same_each_time():
    case = next(c for c in cases("structures", [SEED]) if c.twist == "short")
    build.cache_clear()
    first = case.campaign
    build.cache_clear()
    for one, other in zip(first.records, case.campaign.records, strict=True):
        np.testing.assert_array_equal(one.force, other.force)
        np.testing.assert_array_equal(one.displacement, other.displacement)


@pytest.mark.parametrize("kind", KINDS)
def test_a_campaign_holds_its_truth(kind):
    case = next(
        c for c in cases("structures", [SEED]) if c.kind == kind and c.twist in ("plain", "short")
    )
    campaign, truth = build(case)
    assert 25 <= len(campaign.records) <= 40
    assert campaign.device is not None
    assert truth.nats >= TOLD
    assert 0.7 < truth.noise_percent < 6.5
    files = [r.file for r in campaign.records]
    assert sorted(f for own in truth.members for f in own) == sorted(files)
    assert len(truth.boundaries) == (kind == "SFOIM")
    assert truth.cores == (("FOIM", "FOIM") if kind == "SFOIM" else (kind,))
    if kind == "SFOIM":
        assert abs(truth.orders[0] - truth.orders[1]) > 0.05
        assert len(truth.members[0]) >= 5
        assert len(truth.members[1]) >= 5


def test_a_boundary_parts_the_records_by_its_coordinate():
    case = next(c for c in cases("structures", [SEED]) if c.kind == "SFOIM" and c.place % 2)
    for coordinate, seed in (("dean", SEED), ("frequency", SEED + 1)):
        campaign, truth = build(replace(case, twist="plain", seed=seed))
        assert truth.coordinate == coordinate
        speeds = {
            r.file: 2.0 * np.pi * r.frequency * r.amplitude for r in campaign.records
        }
        places = {r.file: r.frequency for r in campaign.records}
        value = truth.boundaries[0]
        if truth.coordinate == "dean":
            places, value = speeds, truth.speeds[0]
        low, high = truth.members
        assert max(places[f] for f in low) < value < min(places[f] for f in high)


def test_thin_data_are_few_and_of_one_amplitude():
    for case in cases("thin", [SEED])[::9]:
        records = case.campaign.records
        assert 3 <= len(records) <= 8
        assert len({r.amplitude for r in records}) == 1


def test_a_hidden_extra_is_in_the_records():
    case = Case("one-extra", "IOIM-linear", "dahl", "plain", "stiffness", SEED, 3)
    campaign, truth = build(case)
    assert truth.extra == "stiffness"
    assert 0.03 <= truth.size <= 0.1
    assert len(campaign.records) >= 25


def test_what_columns_leave_is_that_of_least_squares():
    rng = np.random.default_rng(8)
    design = rng.standard_normal((200, 5))
    target = design[:, :4] @ np.array([1.0, 0.5, -1.0, 2.0]) + rng.standard_normal(200)
    rows = np.column_stack([design, target])
    product = rows.T @ rows
    own = design[:, [0, 1, 3]]
    off = target - own @ np.linalg.lstsq(own, target, rcond=None)[0]
    assert left(product, [0, 1, 3], between=False) == pytest.approx(0.5 * off @ off)
    # The second and third mix with unlike signs: no order lies between them.
    one = min(left(product, [i, 3], between=False) for i in (1, 2))
    assert left(product, [1, 2, 3], between=True) == pytest.approx(one)
