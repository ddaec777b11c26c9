"""Names of structures, and the supports that a search weighs."""

from itertools import combinations

import pytest

from discover.regression.support import Support
from discover.selection.structures import (
    EXTRAS,
    candidate_supports,
    family_of,
    named_supports,
    structure_of,
)
from tests.discover.spectra import dictionary

FULL = dictionary(
    "inertia", "viscous-damping", "quadratic-damping", "coulomb-friction", "stiffness",
    "force-offset", exponents=(0.4, 3.0), delay=True,
)  # fmt: skip


@pytest.mark.parametrize(
    ("core", "exponent", "name"),
    [
        ({"fractional-derivative"}, 1.75, "FOIM"),
        ({"inertia"}, 1.75, "IOIM-linear"),
        ({"inertia", "viscous-damping"}, 1.75, "IOIM-linear"),
        ({"inertia", "quadratic-damping"}, 1.75, "IOIM-laminar"),
        ({"inertia", "viscous-damping", "quadratic-damping"}, 1.75, "IOIM-laminar"),
        ({"inertia", "power-law-damping"}, 1.75, "IOIM-turbulent"),
        ({"inertia", "power-law-damping", "quadratic-damping", "viscous-damping"}, 1.6,
         "IOIM-turbulent"),
        ({"inertia", "power-law-damping"}, 1.2, "other"),
        ({"inertia", "power-law-damping"}, 2.3, "other"),
        ({"inertia", "fractional-derivative"}, 1.75, "other"),
        ({"viscous-damping"}, 1.75, "other"),
        ({"inertia", "stiffness"}, 1.75, "other"),
        (set(), 1.75, "other"),
    ],
)  # fmt: skip
def test_a_structure_s_name_is_that_of_its_core(core, exponent, name):
    nuisance = ("coulomb-friction", "force-offset", "asymmetric-damping", "time-delay")
    for size in range(3):
        for extra in combinations(nuisance, size):
            assert structure_of([*extra, *core], exponent) == name


@pytest.mark.parametrize(
    ("ids", "family"),
    [
        (["fractional-derivative", "coulomb-friction", "stiffness"], "fractional"),
        (["fractional-derivative", "inertia"], "mixed"),
        (["fractional-derivative", "power-law-damping"], "mixed"),
        (["inertia", "viscous-damping", "quadratic-damping"], "integer"),
        ([], "integer"),
    ],
)
def test_families(ids, family):
    assert family_of(ids) == family


def test_the_search_repeats_nothing_and_has_one_fractional_order_at_most():
    supports = candidate_supports(FULL)
    keys = [(frozenset(s.plain), s.free, s.fixed) for s in supports]
    assert len(set(keys)) == len(keys)
    assert all(len(set(s.ids)) == len(s.ids) for s in supports)
    assert all(s.free.count("fractional-derivative") <= 1 for s in supports)
    sizes = [s.parameters for s in supports]
    assert sizes == sorted(sizes)


def test_every_structure_of_the_paper_is_in_the_search_with_every_extra():
    supports = {(frozenset(s.plain), s.free, s.fixed) for s in candidate_supports(FULL)}
    turbulent = (("power-law-damping", 1.75),)
    for extra in (e for e in EXTRAS if FULL.has(e)):
        for plain, free, fixed in (
            ((), ("fractional-derivative",), ()),
            (("inertia", "viscous-damping"), (), ()),
            (("inertia", "viscous-damping", "quadratic-damping"), (), ()),
            (("inertia", "viscous-damping", "quadratic-damping"), (), turbulent),
        ):
            assert (frozenset((*plain, extra)), free, fixed) in supports


def test_terms_that_the_dictionary_lacks_are_not_searched():
    small = dictionary("inertia", "viscous-damping", orders=None)
    every = {i for s in (*candidate_supports(small), *named_supports(small, ())) for i in s.ids}
    assert every == {"inertia", "viscous-damping"}


def test_named_supports_stand_with_and_without_friction():
    supports = named_supports(FULL, ("force-offset",))
    assert all("force-offset" in s.plain for s in supports)
    with_friction = [s for s in supports if "coulomb-friction" in s.plain]
    assert 2 * len(with_friction) == len(supports)
    assert {structure_of(s.ids) for s in supports} == {
        "FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent",
    }  # fmt: skip


def test_a_shape_that_is_free_counts_as_a_parameter():
    assert Support(("inertia",), free=("fractional-derivative",)).parameters == 3
    assert Support(("inertia",), fixed=(("power-law-damping", 1.75),)).parameters == 2
