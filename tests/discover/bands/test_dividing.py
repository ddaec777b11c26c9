"""One law is one band, however well the records tell it."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.divisions import divided_again, sharp
from discover.bands.extras import searched_with
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.exact import campaign, fractional


@pytest.fixture(scope="module", params=(0.4, 0.6, 1.3))
def fractional_damper(request):
    """Many cycles at little noise: they tell an order to less than a thousandth."""
    records = campaign(
        fractional(9000.0, request.param, 0.0), noise=0.01, cycles=30.0,
        frequencies=(0.3, 1.0, 3.0, 8.0), amplitudes=(0.005, 0.02), most_acceleration=40.0,
    )  # fmt: skip
    device = prepare(records, StudyOptions()).device
    return request.param, searched_with(replace(device, with_friction=False), (), None)


def test_one_fractional_law_is_one_band_whose_order_is_told(fractional_damper):
    order, found = fractional_damper
    assert found.banded.bands == 1
    assert found.quiet
    (term,) = (p.fitted for p in found.assessed.model.terms)
    assert term.shape["order"] == pytest.approx(order, abs=1e-3)


def test_between_the_places_of_the_grid_an_order_is_moved_to_where_it_is(fractional_damper):
    order, found = fractional_damper
    (part,) = found.variants[found.banded.variants[0]].parts
    assert part.terms[0].shape["order"] == pytest.approx(order, abs=0.01)


@pytest.mark.parametrize("spread", [0.02, 0.3, 3.0])
def test_every_band_has_records_that_are_wholly_in_it(spread):
    coordinate = 2.8 * np.exp(np.linspace(0.0, spread, 9))
    ways = divided_again(np.ones((1, 9)), (), {"frequency": coordinate})
    assert np.all(np.count_nonzero(ways.shares >= 0.9, axis=2) >= 2)
    widest = max(c.width for c in ways.cuts)
    assert widest < spread


def test_no_boundary_lies_between_tests_of_one_set_point():
    set_points = np.repeat([0.5, 1.0, 2.0, 4.0], 3)
    measured = set_points * (1.0 + 2e-6 * np.arange(12))
    _, brackets = sharp(measured)
    assert np.round(brackets, 3).tolist() == [[0.5, 1.0], [1.0, 2.0], [2.0, 4.0]]
