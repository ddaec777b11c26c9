"""A division as a model to fit: it starts where the search found it, or as its terms were."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.composite import as_it_was
from discover.bands.extras import searched_with
from discover.posterior.model import Composite, Placed
from discover.study import StudyOptions
from discover.study.prepare import prepare
from models.constitutive import FittedTerm
from models.cores import Core
from tests.discover.exact import campaign

MASS, VISCOUS = 80.0, 2500.0


@pytest.fixture(scope="module")
def way():
    def law(amplitude, omega, theta):
        return amplitude * omega * (VISCOUS * np.cos(theta) - MASS * omega * np.sin(theta))

    records = campaign(
        law, frequencies=np.geomspace(0.3, 6.0, 5), amplitudes=(0.004, 0.02), noise=0.01
    )
    device = replace(prepare(records, StudyOptions()).device, extras=(), bands=1)
    return searched_with(device, (), None)


def test_a_fit_starts_at_the_coefficients_that_the_search_found(way):
    begun = {p.fitted.id: p.fitted.coefficient for p in way.model.terms}
    assert begun["inertia"] == pytest.approx(MASS, rel=0.02)
    assert begun["viscous-damping"] == pytest.approx(VISCOUS, rel=0.02)


def test_a_coefficient_that_may_not_be_negative_starts_above_zero(way):
    assert all(p.fitted.coefficient > 0.0 for p in way.model.terms)


def test_terms_are_as_they_were_in_their_order_and_their_units():
    one, two = FittedTerm("viscous-damping", 3.0, {}), FittedTerm("viscous-damping", 4.0, {})
    spring = FittedTerm("stiffness", 5.0, {})
    damper, other = replace(one, coefficient=1.0), replace(spring, coefficient=1.0)
    model = Composite((Placed(damper, (1.0, 0.0)), Placed(damper, (0.0, 1.0)), Placed(other)))
    before = Composite((Placed(one, (0.5, 0.5)), Placed(spring), Placed(two, (0.5, 0.5))))
    found = as_it_was(model, before)
    assert [p.fitted.coefficient for p in found.terms] == [3.0, 4.0, 5.0]
    assert [p.share for p in found.terms] == [(1.0, 0.0), (0.0, 1.0), None]


def test_terms_that_were_not_there_begin_at_next_to_nothing_and_more_of_them_as_the_last():
    spring, damper = FittedTerm("stiffness", 1.0), FittedTerm("viscous-damping", 3.0)
    model = Composite((Placed(spring), Placed(damper), Placed(damper)))
    found = as_it_was(model, Composite((Placed(replace(damper, coefficient=4.0)),)))
    assert [p.fitted.coefficient for p in found.terms] == pytest.approx([0.0, 4.0, 4.0], abs=1e-3)


def test_a_structure_without_any_term_is_a_model_too(way):
    """As where only a spring is asked for: what joins comes first."""
    device = replace(way.device, with_friction=False, cores=(Core("other", "integer", ()),))
    found = searched_with(device, (), None)
    assert found.model.terms == ()
    assert np.isfinite(found.assessed.value)
