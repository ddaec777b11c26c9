"""Divisions of units along a coordinate, beside all subsets that there are."""

from itertools import combinations

import numpy as np
import pytest

from discover.bands.divisions import (
    divided_again,
    finer,
    gradual,
    ordered,
    refined,
    sharp,
    undivided,
)

VALUES = np.array([3.0, 0.5, 8.0, 1.0, 1.0, 5.0, 0.7])


def by_subsets(values, fewest):
    """Return every set of units all of which are above all others, with the values beside."""
    found = []
    everyone = set(range(values.size))
    for size in range(fewest, values.size - fewest + 1):
        for upper in map(set, combinations(everyone, size)):
            high = min(values[i] for i in upper)
            low = max(values[i] for i in everyone - upper)
            if high > low:
                found.append((low, high, upper))
    return sorted(found)


@pytest.mark.parametrize("fewest", [1, 2, 3])
def test_sharp_ones_are_all_subsets_that_lie_above_the_rest(fewest):
    shares, brackets = sharp(VALUES, fewest=fewest)
    wanted = by_subsets(VALUES, fewest)
    assert [tuple(b) for b in brackets] == [(low, high) for low, high, _ in wanted]
    for (below, above), (_, _, upper) in zip(shares, wanted, strict=True):
        assert set(np.flatnonzero(above)) == upper
        np.testing.assert_array_equal(below, 1.0 - above)
    assert list(VALUES[ordered(VALUES)]) == sorted(VALUES)


def test_units_of_one_place_are_never_divided():
    shares, brackets = sharp(np.full(6, 2.5))
    assert shares.shape == (0, 2, 6)
    assert brackets.shape == (0, 2)
    assert divided_again(np.ones((1, 6)), (), {"speed": np.full(6, 2.5)}) is None


def test_a_gradual_one_is_logistic_in_the_logarithm():
    places, widths = np.array([2.0, 1.0]), np.array([1.2, 0.3])
    ends = np.exp(np.log(places) + np.outer([-0.5, 0.0, 0.5], widths))  # a tenth, half, nine tenths
    for way in range(2):
        coordinate = np.concatenate([ends[:, way], [1e-30, 1e30]])
        found = gradual(coordinate, places, widths)[way]
        np.testing.assert_allclose(found[1], [0.1, 0.5, 0.9, 0.0, 1.0], atol=1e-12)
        np.testing.assert_allclose(found.sum(axis=0), 1.0, rtol=1e-12)


def test_one_band_of_several_is_divided_and_the_others_stay():
    coordinate = np.arange(1.0, 10.0)
    whole = np.stack([coordinate <= 2, (coordinate > 2) & (coordinate <= 7), coordinate > 7])
    whole = whole.astype(float)
    parts, ends = sharp(coordinate)
    found, kept = refined(whole, 1, parts)
    # Two units at least on either side: between 4 and 5, and between 5 and 6.
    assert ends[kept].tolist() == [[4.0, 5.0], [5.0, 6.0]]
    for way, (low, high) in zip(found, ends[kept], strict=True):
        wanted = [
            whole[0],
            whole[1] * (coordinate <= low),
            whole[1] * (coordinate >= high),
            whole[2],
        ]
        np.testing.assert_array_equal(way, wanted)


def test_a_unit_counts_where_nine_tenths_of_it_are():
    part = np.array([[1.0, 1.0, 0.5, 0.0, 0.0], [0.0, 0.0, 0.5, 1.0, 1.0]])
    short = np.array([[1.0, 0.85, 0.5, 0.0, 0.0], [0.0, 0.15, 0.5, 1.0, 1.0]])
    _, kept = refined(np.ones((1, 5)), 0, np.stack([part, short, part[::-1]]))
    assert kept.tolist() == [0, 2]


@pytest.mark.parametrize("names", [("speed",), ("speed", "frequency")])
def test_all_ways_to_divide_again_share_the_prior(names):
    coordinates = {name: np.geomspace(1.0, 60.0, 11) ** (k + 1) for k, name in enumerate(names)}
    first = np.stack([np.arange(11) < 5, np.arange(11) >= 5]).astype(float)
    edge = (float(coordinates["speed"][4]), float(coordinates["speed"][5]))
    ways = divided_again(first, (edge,), coordinates)
    count = len(ways.cuts)
    assert ways.shares.shape == (count, 3, 11)
    assert len(ways.brackets) == ways.log_prior.size == count
    np.testing.assert_allclose(ways.shares.sum(axis=1), 1.0, rtol=1e-12)
    chances = np.exp(ways.log_prior)
    assert chances.sum() == pytest.approx(1.0, rel=1e-12)
    # Nine tenths are sharp where a band has both kinds; all of one kind are as probable.
    for name in names:
        for band in (0, 1):
            own = [i for i, c in enumerate(ways.cuts) if (c.coordinate, c.band) == (name, band)]
            sharp_ones = [i for i in own if ways.cuts[i].width == 0.0]
            gradual_ones = [i for i in own if ways.cuts[i].width > 0.0]
            assert np.ptp(chances[sharp_ones]) < 1e-12
            assert chances[sharp_ones].sum() == pytest.approx(0.9 / len(names) / 2, rel=0.15)
            if gradual_ones:
                share = chances[gradual_ones].sum() / chances[own].sum()
                assert share == pytest.approx(0.1, rel=1e-9)
    for brackets, cut, shares in zip(ways.brackets, ways.cuts, ways.shares, strict=True):
        assert edge in brackets
        assert list(brackets) == sorted(brackets)
        assert len(brackets) == 2
        (own,) = [b for b in brackets if b != edge] if cut.coordinate == "speed" else [brackets[-1]]
        if cut.width == 0.0 and cut.coordinate == "speed":
            assert np.exp(cut.place) == pytest.approx(np.sqrt(own[0] * own[1]), rel=1e-9)
            upper = shares[cut.band + 1] > 0.0
            assert coordinates["speed"][upper].min() == own[1]
    some = ways.only([3, 0])
    assert some.cuts == (ways.cuts[3], ways.cuts[0])
    assert some.brackets == (ways.brackets[3], ways.brackets[0])
    np.testing.assert_array_equal(some.shares, ways.shares[[3, 0]])
    np.testing.assert_array_equal(some.log_prior, ways.log_prior[[3, 0]])


def test_finer_ones_lie_around_a_gradual_one_a_third_as_far_apart():
    coordinates = {"speed": np.geomspace(1.0, 400.0, 25)}
    whole = np.ones((1, 25))
    ways = divided_again(whole, (), coordinates)
    cut = min((c for c in ways.cuts if c.width == 1.2), key=lambda c: abs(c.place - np.log(20.0)))
    found = finer(cut, whole, (), coordinates)
    places = np.array([c.place for c in found.cuts]) - cut.place
    widths = np.log([c.width / cut.width for c in found.cuts])
    thirds = np.array([-2.0, -1.0, 0.0, 1.0, 2.0]) / 3.0
    np.testing.assert_allclose(np.unique(places.round(9)), thirds * cut.steps[0], atol=1e-8)
    np.testing.assert_allclose(np.unique(widths.round(9)), thirds * cut.steps[1], atol=1e-8)
    assert len(found.cuts) == 25
    # Nine of them stand where one stood.
    np.testing.assert_allclose(np.exp(found.log_prior), 1.0 / 9.0, rtol=1e-12)
    for c, shares in zip(found.cuts, found.shares, strict=True):
        assert c.steps == pytest.approx((cut.steps[0] / 3.0, cut.steps[1] / 3.0))
        own = gradual(coordinates["speed"], np.exp([c.place]), np.array([c.width]))[0]
        np.testing.assert_allclose(shares, own, atol=1e-12)


def test_one_band_holds_all():
    one = undivided(7)
    assert one.shares.shape == (1, 1, 7)
    assert np.all(one.shares == 1.0)
    assert one.brackets == ((),)
    assert one.log_prior.tolist() == [0.0]
    assert (one.cuts[0].coordinate, one.cuts[0].width) == ("", 0.0)
