"""The catalogue's trials beside a model."""

import numpy as np
import pytest

from discover.posterior.catalogue import starts_of, trials_of
from discover.posterior.model import Number
from models.constitutive import FittedTerm
from models.terms import TERMS, Parameter, Start, Term
from tests.discover.gap_data import device
from tests.discover.posterior.small import APART, assessor_of, model_of, of_formula, rows_of

MODEL = model_of(inertia=120.0, viscous_damping=800.0)


@pytest.fixture(scope="module")
def assessor():
    return assessor_of(rows_of(device, APART, cycles=3), friction=False)


def tried(assessor, *ids, model=MODEL, **options):
    return trials_of(assessor.space.scales, assessor.evaluator, ids, model, **options)


def test_what_needs_a_term_that_the_model_lacks_is_left_out(assessor):
    ids = ("stribeck-friction", "stiffness", "position-dependent-friction")
    assert {e.id for e in tried(assessor, *ids, among=3).entries} == {"stiffness"}
    rubbing = MODEL.plus(FittedTerm("coulomb-friction", 40.0))
    assert {e.id for e in tried(assessor, *ids, model=rubbing, among=3).entries} == set(ids)
    assert tried(assessor, "stribeck-friction", among=3).entries == ()


def test_priors_of_all_shapes_add_up_to_the_number_that_is_expected(assessor):
    ids = ("stiffness", "cubic-stiffness", "asymmetric-damping", "end-stop")
    found = tried(assessor, *ids, among=4, expected=0.3)
    chance = {i: [np.exp(e.log_prior) for e in found.entries if e.id == i] for i in ids}
    for own in chance.values():
        assert own == pytest.approx([own[0]] * len(own))
        assert sum(own) == pytest.approx(0.3 / 4)
    assert len(chance["stiffness"]) == 1 < len(chance["cubic-stiffness"])
    fewer = tried(assessor, "stiffness", among=8, expected=0.3)
    assert np.exp(fewer.entries[0].log_prior) == pytest.approx(0.3 / 8)


def test_what_most_records_have_is_expected_whatever_else_may_join(assessor):
    for among in (4, 20):
        (offset,) = {e.log_prior for e in tried(assessor, "force-offset", among=among).entries}
        (spring,) = {e.log_prior for e in tried(assessor, "stiffness", among=among).entries}
        shapes = len(tried(assessor, "force-offset", among=among).entries)
        assert np.exp(offset) * shapes == pytest.approx(TERMS["force-offset"].common)
        assert np.exp(spring) < 0.5 * np.exp(offset)


def test_columns_are_those_of_the_trials_in_their_order(assessor):
    rows = assessor.space.sheet.rows
    rubbing = MODEL.plus(FittedTerm("coulomb-friction", 40.0))
    ids = ("stiffness", "time-delay", "position-dependent-friction", "cubic-stiffness")
    found = tried(assessor, *ids, model=rubbing, among=4)
    places = np.concatenate([e.places for e in found.entries])
    np.testing.assert_array_equal(places, np.arange(found.columns.shape[1]))
    assert max(e.places.size for e in found.entries) == 3
    (spring,) = (e for e in found.entries if e.id == "stiffness")
    cube = next(e for e in found.entries if e.id == "cubic-stiffness")
    for entry, formula in ((spring, lambda t, x, v, a: x), (cube, lambda t, x, v, a: x**3)):
        expected = of_formula(rows, formula)
        found_here = found.columns[:, entry.places[0]]
        np.testing.assert_allclose(found_here, expected, atol=1e-9 * np.abs(expected).max())
    for entry in found.entries:
        assert entry.places.size == len(entry.terms)
        if entry.id == "position-dependent-friction":
            for place, term in zip(entry.places, entry.terms, strict=True):
                expected = assessor.evaluator.unit(term)
                size = np.abs(expected).max()
                np.testing.assert_allclose(
                    found.columns[:, place], expected, atol=1e-9 * size
                )


def test_what_changes_the_force_is_tried_at_its_probe_and_told_over_it(assessor):
    found = tried(assessor, "sensor-gain", "time-delay", among=2)
    assert all(e.terms[0].coefficient not in (0.0, 1.0) for e in found.entries)
    gain = next(e for e in found.entries if not any(
        v for n, v in e.terms[0].shape.items() if n != "side"))  # fmt: skip
    late = next(e for e in found.entries if e.id == "time-delay")
    rows = assessor.space.sheet.rows

    def earlier(t, x, v, a):
        return 120.0 * (v.max() / x.max()) ** 2 * v - 800.0 * a  # -dF/dt

    for entry, formula in ((gain, device), (late, earlier)):
        expected = of_formula(rows, formula)
        np.testing.assert_allclose(
            found.columns[:, entry.places[0]], expected, atol=2e-3 * np.abs(expected).max()
        )


def test_changes_act_on_the_model(assessor):
    other = MODEL.with_values([Number(0, None), Number(1, None)], [240.0, 1600.0])
    once, twice = (tried(assessor, "sensor-gain", model=m, among=1) for m in (MODEL, other))
    np.testing.assert_allclose(
        twice.columns[:, 0], 2.0 * once.columns[:, 0], atol=1e-6 * np.abs(once.columns).max()
    )


def test_a_term_without_shapes_of_its_own_has_its_parameters_spread(assessor):
    scales = assessor.space.scales
    term = Term("a", "N", "", column=lambda m, s: m.velocity,
                parameters=(Parameter("gap", 0.5, 1.5, 1.0, "m", "displacement"),))  # fmt: skip
    gaps = [s.shapes[0]["gap"] for s in starts_of(term, scales)]
    assert min(gaps) == pytest.approx(0.5 * scales.displacement)
    assert max(gaps) == pytest.approx(1.5 * scales.displacement)
    assert all(s.probe == 1.0 and len(s.shapes) == 1 for s in starts_of(term, scales))
    assert [s.shapes for s in starts_of(TERMS["stiffness"], scales)] == [({},)]


def test_a_change_without_shapes_of_its_own_is_tried_where_it_is_noticed(assessor):
    scales = assessor.space.scales
    gain = Term("g", "1", "", transform=lambda f, m, c, s: (1.0 + c) * f(m), acts="output")
    (start,) = starts_of(gain, scales)
    assert start.probe == pytest.approx(0.02, rel=1e-6)
    offset = Term("o", "N", "", transform=lambda f, m, c, s: f(m) + c, acts="output")
    # Of a force whose peak is the greatest that was measured, and that nearly is a sine.
    (start,) = starts_of(offset, scales)
    assert start.probe == pytest.approx(0.02 * scales.force / np.sqrt(2.0), rel=1e-2)
    late = Term("l", "s", "", transform=turned, acts="output")
    (start,) = starts_of(late, scales)
    assert start.probe == pytest.approx(0.02 * scales.displacement / scales.speed, rel=0.01)


def turned(force_of, motion, delay, shape):
    """Return a sine test's force a little later."""
    force = force_of(motion)
    omega = 2.0 * np.pi / (motion.step * force.size)
    return force - delay * omega * np.roll(force, force.size // 4)


def test_a_term_s_own_shapes_come_first(assessor):
    own = [Start.one(3.0, gap=0.7), Start(({"gap": 0.2}, {"gap": 0.3}))]
    gap = Parameter("gap", 0.1, 1.5, 1.0, "m")
    term = Term(
        "a", "N", "", column=lambda m, s: m.velocity, parameters=(gap,), starts=lambda s: own
    )
    assert starts_of(term, assessor.space.scales) == own
