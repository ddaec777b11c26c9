"""Two effects at once: which of them is the first, and what a pair has to explain."""

import numpy as np
import pytest

from discover.naming.candidates import Part, Variant
from discover.naming.evidence import Entry
from discover.naming.pairs import pairs_with


def variant(effect, **shape):
    return Variant(effect, (Part(effect, shape),), len(shape))


QUADRATIC = variant("quadratic-damping")
NEARLY, SLOW = (variant("power-law-damping", exponent=p) for p in (2.3, 0.25))
CHOSEN = [QUADRATIC, NEARLY, SLOW]
SPEED = np.linspace(0.01, 1.0, 60)
COLUMNS = np.stack([SPEED**2, SPEED**2.3, SPEED**0.25])


@pytest.mark.parametrize(
    ("lead", "truth", "first"),
    [
        (QUADRATIC, (10.0, 0.0, 1.0), "quadratic-damping"),
        (SLOW, (10.0, 0.0, 1.0), "quadratic-damping"),
        (QUADRATIC, (1.0, 0.0, 10.0), "power-law-damping"),
    ],
)
def test_the_first_of_a_pair_explains_more_in_the_shape_that_it_has_there(lead, truth, first):
    """Alone another power might do better than the square: it is not in the pair."""
    target = np.asarray(truth) @ COLUMNS
    chi2 = float(target @ target)
    entry = Entry((lead.effect,), (lead,), ((1.0,),), 0.5 * chi2, 0.0)
    spans = [slice(i, i + 1) for i in range(3)]
    found = pairs_with(entry, CHOSEN, spans, COLUMNS, (target, chi2), lambda left, _: -left, 8.0)
    (pair,) = found
    assert pair.effects[0] == first
    values = {v.effect: c[0] for v, c in zip(pair.variants, pair.coefficients, strict=True)}
    assert values == pytest.approx({QUADRATIC.effect: truth[0], SLOW.effect: truth[2]})
    assert pair.chi2 == pytest.approx(0.0, abs=1e-9 * chi2)
