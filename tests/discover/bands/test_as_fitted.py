"""A structure is no more probable than a fit of it."""

from dataclasses import replace

import numpy as np
import pytest

from discover.bands.as_fitted import as_fitted
from discover.bands.extras import searched_with
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.discover.exact import campaign, integer


@pytest.fixture(scope="module")
def linear():
    """A mass, a damper and friction, told from all other structures."""
    records = campaign(
        integer(200.0, 3000.0, 0.0, 0.0, 60.0),
        frequencies=(0.3, 1.0, 3.0), amplitudes=(0.005, 0.02),
    )  # fmt: skip
    return searched_with(prepare(records, StudyOptions()).device, (), None)


def core_of(found):
    return found.variants[found.banded.variants[0]].core


def promising(found, core, nats):
    """Return an answer in which slopes promise more of a core's structures than a fit holds."""
    values = found.banded.by_variant.copy()
    for place, variant in enumerate(found.variants):
        if variant.core == core and any(p.slopes for p in variant.parts):
            values[0, place] += nats
    return found.with_values(values)


def test_what_slopes_promise_and_no_fit_holds_does_not_count(linear):
    assert core_of(linear) == "IOIM-linear"
    promised = promising(linear, "IOIM-turbulent", 60.0)
    assert core_of(promised) == "IOIM-turbulent"
    held = as_fitted(promised)
    assert core_of(held) == "IOIM-linear"
    assert held.banded.value < promised.banded.value


def test_what_a_fit_holds_stays_as_it_is(linear):
    assert as_fitted(linear) is linear
    loud = replace(linear, banded=replace(linear.banded, quiet=False))
    promised = promising(loud, "IOIM-turbulent", 60.0)
    np.testing.assert_array_equal(
        as_fitted(promised).banded.by_variant, promised.banded.by_variant
    )
