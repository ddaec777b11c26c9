"""Where one band ends: no surer than the structures beside it."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.boundaries import boundaries_of
from discover.bands.extras import searched_with
from discover.bands.found import Found
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.exact import campaign

CHANGES = 0.06  # m/s


def divided(missing):
    """Order 0.5 below a speed amplitude and 1.4 above it, with a harmonic that no term has."""

    def law(amplitude, omega, theta):
        order = 0.5 if amplitude * omega < CHANGES else 1.4
        force = 900.0 * amplitude * omega**order * np.sin(theta + order * np.pi / 2.0)
        return force * (1.0 + missing * np.cos(2.0 * theta + amplitude * 100.0))

    records = campaign(
        law, frequencies=np.geomspace(0.1, 6.0, 6), amplitudes=(0.005, 0.02), noise=0.01
    )
    device = replace(prepare(records, StudyOptions()).device, extras=(), bands=2)
    return searched_with(device, (), None)


@pytest.mark.parametrize("missing", [0.0, 0.25])
def test_the_interval_holds_the_place_where_the_law_changes(missing):
    (end,) = boundaries_of(divided(missing))
    low, high = end.interval
    assert low <= end.bracket[0] < CHANGES < end.bracket[1] <= high


def test_beside_a_remainder_the_interval_is_that_of_the_likelihood_at_a_power(monkeypatch):
    way = divided(0.25)
    assert not way.quiet
    assert 0.0 < way.power < 1.0

    def interval(power):
        monkeypatch.setattr(Found, "power", power)
        ((low, high),) = (end.interval for end in boundaries_of(replace(way)))
        return low, high

    (own, sure, unsure) = (interval(p) for p in (way.power, 1.0, 1e-9))
    assert unsure[0] <= own[0] <= sure[0]
    assert unsure[1] >= own[1] >= sure[1]
    assert unsure[1] / unsure[0] > 2.0 * sure[1] / sure[0]


def test_where_but_noise_is_left_the_likelihood_is_whole():
    assert divided(0.0).power == 1.0
