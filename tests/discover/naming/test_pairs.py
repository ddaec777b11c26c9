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
    singles = {v.effect: Entry((v.effect,), (v,), ((1.0,),), 0.0, 1.0) for v in CHOSEN}
    start = target, chi2
    found = pairs_with(entry, singles, CHOSEN, spans, COLUMNS, start, lambda left, _: -left, 8.0)
    (pair,) = found
    assert pair.effects[0] == first
    values = {v.effect: c[0] for v, c in zip(pair.variants, pair.coefficients, strict=True)}
    assert values == pytest.approx({QUADRATIC.effect: truth[0], SLOW.effect: truth[2]})
    assert pair.chi2 == pytest.approx(0.0, abs=1e-9 * chi2)


@pytest.mark.parametrize(
    ("stiff", "first"),
    [((1.0, 0.0, 0.0), "coulomb-friction"), ((0.0, 1.0, 0.0), "power-law-damping")],
)
def test_what_nearly_the_same_shape_explains_counts_as_the_shapes_own(stiff, first):
    """Friction that deflects a little longer beside a power law is the friction it is alone."""
    short, long = (variant("coulomb-friction", presliding=z) for z in (1e-6, 5e-5))
    chosen = [SLOW, short, long]
    columns = np.array([[-0.2, 0.7, 0.8], stiff, [0.95, -0.312, 0.0]])
    target = np.array([0.2, 0.1, 0.2])
    start = target, float(target @ target)
    spans = [slice(i, i + 1) for i in range(3)]
    lead = Entry((SLOW.effect,), (SLOW,), ((1.0,),), 0.0, 0.0)
    (pair,) = pairs_with(lead, {}, chosen, spans, columns, start, lambda left, _: -left, 8.0)
    assert dict(pair.variants[pair.effects.index("coulomb-friction")].parts[0].shape) == {
        "presliding": 5e-5
    }
    assert pair.effects[0] == first


@pytest.mark.parametrize("better", ["time-delay", "sensor-gain"])
def test_the_first_of_two_sensors_is_the_one_of_the_best_entry_alone(better):
    """How large a gain behind a filter may be its column does not know."""
    chosen = [variant("sensor-gain", filter_time=1e-3), variant("time-delay", filter_order=1.0)]
    columns = COLUMNS[[0, 2]]
    target = np.array([0.2, 0.05]) @ columns
    chi2 = float(target @ target)
    singles = {
        v.effect: Entry((v.effect,), (v,), ((1.0,),), 0.0, float(v.effect == better))
        for v in chosen
    }
    spans = [slice(0, 1), slice(1, 2)]
    start = target, chi2
    (pair,) = pairs_with(
        singles["sensor-gain"], singles, chosen, spans, columns, start, lambda left, _: -left, 8.0
    )
    assert pair.effects[0] == better


@pytest.mark.parametrize(("gain", "number"), [(0.2, 1), (1.7, 0)])
def test_a_gain_behind_a_filter_is_in_no_pair_as_greater_than_it_may_be(gain, number):
    """A straight line to a small one meets what a great delay leaves, and is none."""
    chosen = [QUADRATIC, variant("sensor-gain", filter_time=1e-3)]
    target = np.array([10.0, gain]) @ COLUMNS[[0, 2]]
    start = target, float(target @ target)
    spans = [slice(0, 1), slice(1, 2)]
    for lead in chosen:
        entry = Entry((lead.effect,), (lead,), ((1.0,),), 0.0, 0.0)
        found = pairs_with(
            entry, {}, chosen, spans, COLUMNS[[0, 2]], start, lambda left, _: -left, 8.0
        )
        assert len(found) == number
