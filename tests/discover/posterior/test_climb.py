"""The climb over sizes, by exhaustion of its grid."""

from itertools import permutations, product

import numpy as np
import pytest

from discover.posterior.climb import STEP, Place, climb

GRID = range(-12, 1)


def test_sizes_are_powers_of_the_step():
    sizes = Place((-3, -1, -2, -5)).sizes(40.0)
    assert sizes.remainder == STEP**-3
    assert sizes.friction == 40.0 * STEP**-1
    assert sizes.loud == (STEP**-2, STEP**-5, 0.0)
    assert Place((-3, -1, -2), -4).sizes(1.0).loud == (STEP**-2, STEP**-4)


def test_what_a_place_is_made_of():
    place = Place((-3, -1, -7, -5))
    assert (place.remainder, place.own, place.loudest) == (-3, -1, -5)
    assert len(Place.start(3).powers) == 5
    assert set(Place.quiet(2).powers) == {min(GRID)}
    assert all(min(GRID) < p <= max(GRID) for p in Place.start(2).powers)


def test_moves_stay_on_the_grid():
    place = Place((-3, 0, -12))
    assert place.moved((1, 1, -1)) == Place((-2, 0, -12))
    assert place.moved((-1, -1, 1), 4) == Place((-7, -4, -8))
    assert place.moved((-1, 0, 0), 40) == Place((-12, 0, -12))


def test_the_place_half_way_is_between():
    assert Place((-2, -12, 0)).towards(Place((-8, -12, -6))) == Place((-5, -12, -3))
    assert Place((-2, 0, -1)).towards(Place((-3, 0, -4))).powers[0] in (-2, -3)


def test_where_nothing_but_terms_is_left_one_error_is_the_same_in_all_rows():
    unaided = Place((-1, -2, -3, -4)).unaided
    assert [p.flat for p in unaided] == list(GRID)
    assert {p.powers for p in unaided} == {Place.quiet(2).powers}


@pytest.mark.parametrize("kinds", [1, 2, 3])
def test_moves_change_one_size_or_exchange_two_and_each_kind_of_error_alone(kinds):
    moves = Place.start(kinds).moves
    one = [tuple(sign * v for v in row) for row in np.eye(3, dtype=int) for sign in (1, -1)]
    exchanged = set(permutations((-1, 0, 1)))
    together = {(r, f, *[e] * kinds) for r, f, e in (*one, *exchanged)}
    alone = {(0, 0, *row) for row in (*np.eye(kinds, dtype=int), *-np.eye(kinds, dtype=int))}
    assert set(moves) == together | {tuple(int(v) for v in m) for m in alone}
    assert len(moves) == len(set(moves))


def climbed(value, start, *, near=False):
    asked = []

    def noted(place):
        asked.append(place)
        return value(place.powers)

    return climb(noted, start, near=near), asked


@pytest.mark.parametrize("seed", range(6))
def test_the_top_of_a_hill_is_found_along_a_ridge(seed):
    rng = np.random.default_rng(seed)
    top = rng.integers(-10, -1, 3)
    ridge = rng.permutation([1.0, -1.0, 0.0])

    def value(powers):
        away = np.array(powers, dtype=float) - top
        along = away @ ridge / 2.0
        # Steep across the ridge, so that no size alone can move along it.
        return -20.0 * float(np.sum((away - along * ridge) ** 2)) - float(along**2)

    best = max(product(GRID, repeat=3), key=value)
    found, asked = climbed(value, Place.start(1))
    assert found.powers == best == tuple(top)
    assert max(asked, key=lambda p: value(p.powers)) == found


def test_no_neighbour_is_better_by_much_and_all_were_asked():
    rng = np.random.default_rng(0)
    rough = rng.normal(size=(13, 13, 13))

    def value(powers):
        return float(rough[tuple(np.array(powers) + 12)])

    for start in product((-12, -6, 0), repeat=3):
        found, asked = climbed(value, Place(start))
        around = {found.moved(m) for m in found.moves}
        assert around <= set(asked)
        assert value(found.powers) > max(value(p.powers) for p in around) - 0.1
        assert value(found.powers) >= value(start)


def test_a_climb_of_a_level_ground_stays():
    found, _ = climbed(lambda powers: 1.0, Place((-4, -4, -4)))
    assert found == Place((-4, -4, -4))


def test_long_strides_cross_a_dip_and_short_ones_alone_do_not():
    def value(powers):
        return {-8: 0.0, -4: 9.0}.get(powers[0], -1.0) - abs(powers[1] + 8) - abs(powers[2] + 10)

    assert climbed(value, Place.start(1))[0] == Place((-4, -8, -10))
    found, asked = climbed(value, Place.start(1), near=True)
    assert found == Place.start(1)
    assert max(np.abs(np.subtract(p.powers, found.powers)).max() for p in asked) == 1


@pytest.mark.parametrize("start", [(-8, -8, -10), (-6, -12, -12), (-12, -12, -3), (0, -6, 0)])
def test_of_two_hills_with_nothing_between_the_higher_one_is_found_from_anywhere(start):
    """A remainder of size 1 explains what is left, or independent errors, less well, of 1/8."""

    def value(powers):
        r, f, loud = powers
        hills = -40.0 * (r**2 + (loud + 12) ** 2), -200.0 - 40.0 * ((r + 12) ** 2 + (loud + 3) ** 2)
        return float(np.logaddexp(*hills)) - abs(f + 12)

    assert climbed(value, Place(start))[0] == Place((0, -12, -12))
