from dataclasses import replace

import numpy as np
import pytest

from discover.data_check import check_campaign
from discover.data_check.conditioning import conditioning
from tests.discover.data_check.plan import (
    SINGLE,
    WIDE,
    campaign,
    checked,
    louder,
    planned,
    record,
    white,
)


def by_name(items):
    return {s.name: s for s in items}


@pytest.fixture(scope="module")
def single():
    return checked(SINGLE)


@pytest.fixture(scope="module")
def wide():
    return checked(WIDE)


@pytest.fixture(scope="module")
def plan():
    return planned(WIDE)


def test_at_one_frequency_both_structures_have_full_rank_but_share_their_forces(single):
    found = by_name(single.structures)
    assert (found["FOIM"].rank, found["FOIM"].columns) == (3, 3)
    assert (found["IOIM-linear"].rank, found["IOIM-linear"].columns) == (3, 3)
    pair = next(p for p in single.pairs if p.structures == ("FOIM", "IOIM-linear"))
    # Velocity and acceleration are all that one frequency holds of any order; friction is a third.
    assert (pair.rank, pair.columns) == (3, 5)


def test_over_a_wide_plan_every_column_counts(wide):
    assert all(s.rank == s.columns for s in wide.structures)
    assert all(p.rank == p.columns for p in wide.pairs)
    columns = {p.structures: p.columns for p in wide.pairs}
    assert columns["FOIM", "IOIM-linear"] == 5
    assert columns["IOIM-linear", "IOIM-laminar"] == 4
    assert columns["IOIM-laminar", "IOIM-turbulent"] == 5


def test_the_condition_number_is_that_of_the_samples_themselves(plan):
    """Singular values in the time domain: exact columns, each record's white noise."""
    sigma = np.array([1.0, 3.0, 2.0, 5.0, 1.0, 4.0])
    columns = []
    for (frequency, amplitude), own in zip(WIDE, sigma, strict=True):
        omega = 2.0 * np.pi * frequency
        phase = omega * (np.arange(800) + 0.5) / (100.0 * frequency)
        velocity = amplitude * omega * np.cos(phase)
        acceleration = -amplitude * omega**2 * np.sin(phase)
        columns.append(np.stack([acceleration, velocity, np.sign(velocity)]) / own)
    design = np.concatenate(columns, axis=1).T
    values = np.linalg.svd(design / np.linalg.norm(design, axis=0), compute_uv=False)
    found = by_name(conditioning(white(plan, sigma, plan.size)))["IOIM-linear"]
    assert found.condition == pytest.approx(values[0] / values[-1], rel=0.03)


def test_noise_takes_rank_but_leaves_the_condition_number(plan):
    quiet = by_name(conditioning(plan))
    loud = by_name(conditioning(louder(plan, 1000.0)))
    assert loud["IOIM-linear"].condition == pytest.approx(quiet["IOIM-linear"].condition, rel=1e-6)
    assert quiet["IOIM-laminar"].rank == 4
    assert loud["IOIM-laminar"].rank < 4


def test_a_single_test_is_described_too():
    found = conditioning(planned(((2.0, 0.01),)))
    assert [s.columns for s in found] == [3, 3, 4, 4]
    assert all(s.condition is not None and s.condition >= 1.0 for s in found)


def test_nothing_is_judged_where_every_record_is_held_out():
    plan = replace(campaign(()), records=(record(2.0, 0.01, held_out=True),))
    found = check_campaign(plan)
    assert (found.structures, found.pairs, found.added_test) == ((), (), None)
    assert not found.passed
    assert [t.held_out for t in found.figure_data.tests] == [True]
