"""What a cluster of lines is worth, by hand."""

from dataclasses import replace

import numpy as np
import pytest

from discover.posterior.own_share import own_lines, own_share
from tests.discover.gap_data import device
from tests.discover.posterior.small import APART, assessor_of, model_of, random_rows, rows_of


@pytest.fixture(scope="module")
def assessed():
    assessor = assessor_of(rows_of(device, APART, cycles=3), friction=False)
    return assessor.assess(model_of(inertia=120.0, viscous_damping=800.0), assessor.space.start)


def leaving(assessed, left):
    """Return a model that leaves rows (U, R) of the measured force."""
    force = assessed.space.sheet.target - left
    return replace(assessed, local=replace(assessed.local, force=force))


def in_lines(assessed, lines, square):
    """Return what shows in the first of each unit's lines only, with that square."""
    left = np.zeros_like(assessed.space.sheet.target)
    left[:, :lines] = np.sqrt(square) * np.where(np.arange(lines) % 2, -1.0, 1.0)
    return left


@pytest.mark.parametrize("lines", [1, 4, 10])
def test_what_is_far_above_noise_and_shows_in_several_lines_counts_as_one(assessed, lines):
    size = assessed.space.sheet.target.shape[1]
    square = 1e3 * size / lines  # of which a thousandth is noise
    found = own_share(leaving(assessed, in_lines(assessed, lines, square)))
    assert found == pytest.approx(1.0 / (1.0 + (lines - 1) * 0.999))


def test_half_of_it_noise(assessed):
    size = assessed.space.sheet.target.shape[1]
    found = own_share(leaving(assessed, in_lines(assessed, 4, 2.0 * size / 4)))
    assert found == pytest.approx(1.0 / (1.0 + 3.0 * 0.5))


def test_of_units_the_mean_number_of_lines_counts(assessed):
    units, size = assessed.space.sheet.target.shape
    left = np.zeros((units, size))
    for unit, lines in enumerate((1, 3, 5, 7)):
        left[unit, :lines] = np.sqrt(100.0 * size / lines)
    found = own_share(leaving(assessed, left))
    assert found == pytest.approx(1.0 / (1.0 + 3.0 * 0.99))


def test_noise_says_in_every_line_something_of_its_own(assessed):
    assert own_share(leaving(assessed, np.full_like(assessed.space.sheet.target, 0.9))) == 1.0
    assert own_share(leaving(assessed, np.zeros_like(assessed.space.sheet.target))) == 1.0


def test_lines_of_a_part(assessed):
    units, size = assessed.space.sheet.target.shape
    left = leaving(assessed, in_lines(assessed, 4, 2.0 * size / 4))
    assert own_lines(left, units) == pytest.approx(0.4 * size)
    assert own_lines(left, 2) == pytest.approx(0.4 * size * units / 2)


def test_of_long_records_the_directions_that_are_told_apart_count():
    assessor = assessor_of([random_rows()], friction=False)
    units = assessor.space.sheet.units
    model = model_of(inertia=120.0, viscous_damping=800.0)
    assessed = assessor.assess(model, assessor.space.start)
    lines = sum(u.part.size if u.basis is None else u.basis.shape[1] for u in units)
    assert lines < sum(u.part.size for u in units)
    nothing = leaving(assessed, np.zeros_like(assessed.space.sheet.target))
    assert own_lines(nothing, 1) == pytest.approx(lines)
