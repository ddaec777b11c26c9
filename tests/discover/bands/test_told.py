"""No structure is stated for terms that are idle where terms alone predict."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.extras import searched_with
from discover.bands.told import told
from discover.bands.ways import found
from discover.posterior.spread import idle
from discover.study import StudyOptions
from discover.study.bands import core_probabilities
from discover.study.prepare import prepare
from models.cores import core_of
from tests.discover.exact import campaign


def yielding(amplitude, omega, theta):
    """A force that saturates, late by a displacement: no inertance and no power of speed."""
    late = min(1.0, 2e-3 / amplitude)
    v = amplitude * omega * np.cos(theta + late)
    return 400.0 * np.tanh(v / 0.03) * (1.0 + 0.2 * np.sin(3.0 * theta))


def test_idle_terms_make_no_structure():
    records = campaign(yielding, frequencies=(0.1, 0.3, 1.0, 3.0), noise=0.002)
    device = replace(prepare(records, StudyOptions()).device, extras=(), bands=1)
    before = searched_with(device, (), None)
    assert not before.banded.quiet
    assert not working(device, before)
    assert working(device, told(found(device)))


def working(device, answer):
    """Tell whether every term of the bands' structures makes a force of its sign."""
    best = answer.assessed.predicting
    count = sum(len(p.terms) for v in answer.banded.variants for p in answer.variants[v].parts)
    return not any(place < count for place in idle(best))


def test_few_records_that_no_law_holds_for_make_no_structure_sure():
    """By evidence one is: it is a little less wrong than the others."""
    records = campaign(yielding, frequencies=(0.3, 1.0), amplitudes=(0.01, 0.02), noise=0.002)
    device = replace(prepare(records, StudyOptions()).device, extras=())
    before, after = searched_with(device, (), None), told(found(device))
    assert not before.banded.quiet
    assert after.banded.bands == 1
    assert max(core_probabilities(before, 0).values()) > 0.95
    assert max(core_probabilities(after, 0).values()) < 0.8


def test_a_spring_is_no_derivative_of_order_zero():
    """One record has a third harmonic that no term has: too few to say that more is missing."""
    def law(amplitude, omega, theta):
        odd = 0.05 * np.sin(3.0 * theta) if amplitude > 0.015 and omega > 15.0 else 0.0
        return 4e4 * amplitude * (np.sin(theta) + odd)

    records = campaign(law, frequencies=(0.1, 0.3, 1.0, 3.0), noise=0.002)
    device = prepare(records, StudyOptions()).device
    answer = told(found(replace(device, extras=("stiffness",), bands=1)))
    found_terms = {p.fitted.id: p.fitted.coefficient for p in answer.assessed.model.terms}
    assert found_terms["stiffness"] == pytest.approx(4e4, rel=0.02)
    assert "fractional-derivative" not in found_terms


def offset(amplitude, omega, theta):
    """A force that saturates beside a constant one."""
    return yielding(amplitude, omega, theta) + 90.0


@pytest.fixture(scope="module")
def ways():
    """One band with the constant force that there is, and without."""
    records = campaign(offset, frequencies=(0.3, 1.0), amplitudes=(0.01, 0.02), noise=0.002)
    device = replace(prepare(records, StudyOptions()).device, bands=1)
    one, other = (found(replace(device, extras=e)) for e in (("force-offset",), ()))
    assert [j.id for j in one.joined] == ["force-offset"]
    return one, other


def test_the_way_that_holds_what_there_is_beside_is_told(ways):
    one, other = ways
    assert [j.id for j in told(replace(other, rivals=(one,))).joined] == ["force-offset"]


def test_structures_are_weighed_over_all_that_may_be_beside_them(ways):
    one, other = ways
    own, others, mixed = (
        core_probabilities(told(way), 0)
        for way in (one, other, replace(one, rivals=(other,)))
    )
    for core, probability in mixed.items():
        between = sorted((own.get(core, 0.0), others.get(core, 0.0)))
        assert between[0] - 0.03 < probability < between[1] + 0.03


def test_what_is_told_has_the_terms_of_the_structure_that_is_most_probable():
    """A way may have been looked for beside the other family."""
    def law(amplitude, omega, theta):
        v, a = amplitude * omega * np.cos(theta), -amplitude * omega**2 * np.sin(theta)
        return 35.0 * a + 1200.0 * v

    records = campaign(law, frequencies=(1.0,), amplitudes=(0.01,), noise=0.03)
    device = replace(prepare(records, StudyOptions()).device, extras=(), bands=1)
    beside = searched_with(replace(device, family="fractional"), (), None)
    assert beside.quiet
    answer = told(beside)
    chances = core_probabilities(answer, 0)
    stated = answer.variants[answer.banded.variants[0]]
    assert chances[stated.core] == max(chances.values())
    assert core_of([p.fitted.id for p in answer.assessed.model.terms]) == stated.core
