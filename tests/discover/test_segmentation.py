"""Bands by dynamic programming against every division tried in turn."""

from itertools import combinations

import numpy as np
import pytest

from discover.regression.support import ProfiledFit
from discover.segmentation import MIN_WINDOWS, boundary_cost, segment
from discover.selection.evidence import score
from discover.selection.structures import named_supports
from discover.triangle import triangle_of
from tests.discover.spectra import dictionary, windows

SPEEDS = np.geomspace(0.01, 1.0, 9)
RATES = (2.0, 4.0, 1.0) * 3
PLAN = [(v / (2.0 * np.pi * f), f) for v, f in zip(SPEEDS, RATES, strict=True)]
SPACE = dictionary("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction")
SUPPORTS = named_supports(SPACE, ())
LAMINAR = {"inertia": 300.0, "viscous-damping": 2000.0, "coulomb-friction": 50.0}
ROUGH = {"inertia": 300.0, "quadratic-damping": 9000.0, "coulomb-friction": 50.0}


def speed(amplitude, frequency):
    return 2.0 * np.pi * amplitude * frequency


def changing(at, **options):
    return windows(
        SPACE, lambda a, f: LAMINAR if speed(a, f) < at else ROUGH, PLAN, noise=0.03, **options
    )


def every_division(tests, bands):
    """Return the best total over all divisions, each band refitted from its own rows."""
    rows = triangle_of(tests).rows
    best = -np.inf, ()
    for inner in combinations(range(1, len(tests)), bands - 1):
        ends = (0, *inner, len(tests))
        if min(np.diff(ends)) < MIN_WINDOWS:
            continue
        total = -(bands - 1) * boundary_cost(len(tests))
        for a, b in zip(ends[:-1], ends[1:], strict=True):
            engine = ProfiledFit(triangle_of(tests[a:b]), SPACE)
            total += score(engine, SUPPORTS, rows=rows)[0].log_evidence
        best = max(best, (total, ends[:-1]))
    return best


@pytest.mark.parametrize(("at", "bands"), [(0.13, 2), (0.4, 2), (0.13, 3)])
def test_the_best_division_is_that_of_brute_force(at, bands):
    tests = changing(at, seed=bands)
    found = segment(tests, SPEEDS, SPACE, SUPPORTS, bands=bands)
    total, starts = every_division(tests, bands)
    assert found.starts == starts
    assert found.log_evidence[bands - 1] == pytest.approx(total, rel=1e-9)


def test_the_order_of_the_tests_does_not_matter():
    tests = changing(0.13)
    shuffle = np.random.default_rng(0).permutation(len(tests))
    found = segment([tests[i] for i in shuffle], SPEEDS[shuffle], SPACE, SUPPORTS)
    straight = segment(tests, SPEEDS, SPACE, SUPPORTS)
    assert found.starts == straight.starts
    assert [sorted(shuffle[found.members(b)]) for b in range(found.bands)] == [
        sorted(straight.members(b)) for b in range(straight.bands)
    ]
    np.testing.assert_allclose(found.log_evidence, straight.log_evidence, rtol=1e-9)


@pytest.mark.parametrize("at", [0.04, 0.13, 0.4])
def test_a_change_of_law_is_found_in_its_bracket(at):
    found = segment(changing(at), SPEEDS, SPACE, SUPPORTS)
    (boundary,) = found.boundaries
    assert boundary.bracket[0] < at < boundary.bracket[1]
    assert boundary.value == pytest.approx(np.sqrt(np.prod(boundary.bracket)))
    assert [s.structure for s in found.best] == ["IOIM-linear", "IOIM-laminar"]


def test_one_model_has_no_boundary():
    for seed in range(8):
        for terms in (LAMINAR, {("order", 1.8): 400.0, "coulomb-friction": 50.0}):
            tests = windows(SPACE, terms, PLAN, noise=0.03, seed=seed)
            found = segment(tests, SPEEDS, SPACE, SUPPORTS)
            assert found.bands == 1
            assert found.boundaries == ()


def test_the_interval_is_never_tighter_than_the_bracket():
    for seed in range(4):
        found = segment(changing(0.13, seed=seed), SPEEDS, SPACE, SUPPORTS, bands=3)
        assert len(found.boundaries) == 2
        for boundary in found.boundaries:
            assert boundary.interval[0] <= boundary.bracket[0]
            assert boundary.interval[1] >= boundary.bracket[1]
            assert boundary.probabilities.sum() == pytest.approx(1.0)


def test_a_weak_change_widens_the_interval():
    close = {**LAMINAR, "viscous-damping": 2120.0}
    weak = windows(
        SPACE, lambda a, f: LAMINAR if speed(a, f) < 0.13 else close, PLAN, noise=0.03, seed=1
    )
    wide = segment(weak, SPEEDS, SPACE, SUPPORTS, bands=2).boundaries[0].interval
    sharp = segment(changing(0.13), SPEEDS, SPACE, SUPPORTS, bands=2).boundaries[0].interval
    assert wide[1] / wide[0] > sharp[1] / sharp[0]


def test_tests_at_one_place_are_never_divided():
    coordinate = np.repeat([0.1, 0.2, 0.4], 3)
    plan = [(v / (2.0 * np.pi * f), f) for v, f in zip(coordinate, RATES, strict=True)]
    tests = windows(SPACE, LAMINAR, plan, noise=0.03)
    found = segment(tests, coordinate, SPACE, SUPPORTS, bands=2)
    assert found.starts[1] in (3, 6)


def test_a_boundary_costs_more_among_more_tests():
    assert boundary_cost(40) - boundary_cost(10) == pytest.approx(np.log(39 / 9))
