"""Structures in bands, weighed at once, against the evidence of each by the whole covariance."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import norm

from discover.posterior.covariance import Sizes
from discover.posterior.setup import space_of
from discover.posterior.space import parts_of
from discover.posterior.structures import (
    Variant,
    choice_of,
    divided,
    sums_of_many,
    sums_of_one,
)
from models.constitutive import FittedTerm
from models.terms import TERMS
from tests.discover.posterior.small import dense, flat, log_density, rows_of

PLAN = ((0.5, 0.012), (1.0, 0.004), (2.0, 0.02), (3.0, 0.003), (5.0, 0.006), (8.0, 0.001))
SIZES = Sizes(0.02, (0.005, 0.0), 2.0)
SHARES = np.array(
    [
        [[1, 1, 0, 0, 0, 0], [0, 0, 1, 1, 1, 1]],
        [[1, 1, 1, 0, 0, 0], [0, 0, 0, 1, 1, 1]],
        [[0.9, 0.8, 0.5, 0.3, 0.2, 0.0], [0.1, 0.2, 0.5, 0.7, 0.8, 1.0]],
    ],
    dtype=float,
)


def law(t, x, v, a):
    """Quadratic damping where it is slow, and a linear one where it is fast."""
    slow = np.abs(v).max() < 0.06
    return 120.0 * a + (2e4 * v * np.abs(v) if slow else 900.0 * v) + 10.0 * np.sign(v)


@pytest.fixture(scope="module")
def problem():
    space, curve = space_of(rows_of(law, PLAN, cycles=3), TERMS["coulomb-friction"])
    wanted = [
        (FittedTerm("inertia", 1.0),), (FittedTerm("viscous-damping", 1.0),),
        (FittedTerm("quadratic-damping", 1.0),), (FittedTerm("stiffness", 1.0),),
    ]  # fmt: skip
    mass, viscous, quadratic, spring = parts_of(space, wanted)
    core = np.concatenate([mass.columns, viscous.columns, quadratic.columns])
    # Variants name columns by their place among the core's.
    own = {p.id: i for i, p in enumerate((mass, viscous, quadratic))}
    mass, viscous, quadratic = (
        replace(p, columns=np.array([own[p.id]])) for p in (mass, viscous, quadratic)
    )
    variants = (
        Variant("linear", (mass, viscous), -1.0),
        Variant("laminar", (mass, quadratic), -1.5),
        Variant("both", (mass, viscous, quadratic), -2.0),
        Variant("none", (), -3.0),
    )
    return space, core, (curve, spring), variants


def direct(problem, shares, chosen, scales):
    """Return the log evidence of one division with these variants, by dense matrices."""
    space, core, common, variants = problem
    columns, spread, sign = [], [], []
    for part, scale in zip(common, scales, strict=True):
        columns.append(flat(space.columns[:, part.columns]))
        spread.append(scale * part.spread)
        sign.append(np.zeros(part.columns.size))
    prior = 0.0
    for share, place in zip(shares, chosen, strict=True):
        prior += variants[place].log_prior
        for part in variants[place].parts:
            whole = share[:, None, None] * space.columns[:, core[part.columns]]
            columns.append(flat(whole))
            spread.append(part.scales[0] * part.spread)
            sign.append(part.sign)
    columns, spread = np.concatenate(columns, axis=1), np.concatenate(spread)
    sign = np.concatenate(sign)
    force = space.sheet.target.ravel()
    whole = dense(space, SIZES)
    value = log_density(force, whole + (columns * spread**2) @ columns.T)
    posterior = np.linalg.inv(columns.T @ np.linalg.solve(whole, columns) + np.diag(spread**-2.0))
    mean = posterior @ (columns.T @ np.linalg.solve(whole, force))
    ratio = mean / np.sqrt(np.diag(posterior))
    cut = np.log(2.0) + norm.logcdf(sign * ratio)
    return value + prior + float(np.sum(cut[sign != 0.0]))


def scales_of(problem):
    return np.array([p.scales[1 if len(p.scales) > 1 else 0] for p in problem[2]])


def answered(problem, shares, start):
    space, core, common, variants = problem
    here = space.given(SIZES)
    sums = sums_of_many(here, core, common, scales_of(problem), shares)
    return divided(sums, choice_of(variants, core.size), start)


def test_every_variant_of_a_band_has_its_evidence_beside_the_best_of_the_others(problem):
    variants = problem[3]
    found = answered(problem, SHARES, np.zeros((3, 2), dtype=int))
    for d, shares in enumerate(SHARES):
        best = found.best[d]
        for v in range(len(variants)):
            last = direct(problem, shares, (best[0], v), scales_of(problem))
            assert found.by_variant[d, 1, v] == pytest.approx(last, rel=1e-6, abs=1e-3)
        first = direct(problem, shares, best, scales_of(problem))
        assert found.by_variant[d, 0, best[0]] == pytest.approx(first, rel=1e-6, abs=1e-3)


def test_the_best_variants_are_those_of_all_pairs_and_their_evidence_that_of_the_division(problem):
    pairs = list(product(range(len(problem[3])), repeat=2))
    found = answered(problem, SHARES, np.zeros((3, 2), dtype=int))
    for d, shares in enumerate(SHARES[:2]):
        values = [direct(problem, shares, pair, scales_of(problem)) for pair in pairs]
        assert tuple(found.best[d]) == pairs[int(np.argmax(values))]
        assert found.value[d] == pytest.approx(float(logsumexp(values)), abs=0.1)


def test_where_the_law_changes_is_the_most_probable_division(problem):
    every = [np.arange(6) >= k for k in range(2, 5)]
    speeds = np.array([u.speed for u in problem[0].sheet.units])
    order = np.argsort(speeds)
    shares = np.zeros((3, 2, 6))
    for i, upper in enumerate(every):
        shares[i, 1, order] = upper
        shares[i, 0, order] = ~upper
    found = answered(problem, shares, np.zeros((3, 2), dtype=int))
    best = int(found.value.argmax())
    assert set(speeds[shares[best, 1] > 0.5]) == set(speeds[speeds > 0.06])
    names = [problem[3][v].core for v in found.best[best]]
    assert names == ["laminar", "linear"]


def test_one_division_at_every_scale_is_the_same_as_many_at_one(problem):
    space, core, common, variants = problem
    here = space.given(SIZES)
    scales = np.array([[s, common[1].scales[0]] for s in common[0].scales])
    alone = sums_of_one(here, core, common, scales, SHARES[0])
    for one, scale in zip(alone, scales, strict=True):
        many = sums_of_many(here, core, common, scale, SHARES[:1])
        size = np.sqrt(np.abs(np.einsum("dbbkk->dbk", many.gram)))[0] + 1e-9
        np.testing.assert_allclose(
            one.gram[0] / size[:, None, :, None] / size[None, :, None, :],
            many.gram[0] / size[:, None, :, None] / size[None, :, None, :], atol=1e-7,
        )  # fmt: skip
        np.testing.assert_allclose(one.side[0] / size, many.side[0] / size, rtol=1e-6, atol=1e-6)
        assert one.log_normal == pytest.approx(many.log_normal, rel=1e-9)


def test_one_band_is_the_evidence_of_each_structure(problem):
    whole = np.ones((1, 1, 6))
    found = answered(problem, whole, np.zeros((1, 1), dtype=int))
    for v in range(len(problem[3])):
        expected = direct(problem, whole[0], (v,), scales_of(problem))
        assert found.by_variant[0, 0, v] == pytest.approx(expected, rel=1e-6, abs=1e-3)
    assert found.value[0] == pytest.approx(float(logsumexp(found.by_variant[0, 0])), rel=1e-12)
