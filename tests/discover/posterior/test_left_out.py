"""Which model predicts records that are left out best, and how surely."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.posterior.covariance import Sizes
from discover.posterior.left_out import (
    is_less,
    is_needed,
    is_told_from_noise,
    left_out,
    predicted_no_worse,
    predicts_best,
    predicts_better,
    unseen,
)
from discover.posterior.left_out import predicted as compared
from discover.posterior.model import Composite
from discover.records import Campaign, Record
from discover.rows.columns import force_columns
from discover.study import StudyOptions
from discover.study.prepare import prepare
from models.constitutive import FittedTerm, ForceModel
from tests.discover.exact import campaign
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    model_of,
    of_formula,
    random_rows,
    rows_of,
    whole_force,
)

EQUAL = np.zeros(2)


def test_a_model_that_is_better_in_every_record_is_surer_of_more_records():
    few, many = np.full((2, 2), 1.0), np.full((2, 30), 1.0)
    few[1] = many[1] = 1.5
    assert 0.6 < predicts_best(few, EQUAL, 4.0, 0)[0] < 0.9
    assert predicts_best(many, EQUAL, 4.0, 0)[0] > 0.98


def test_a_model_that_is_better_by_a_hair_in_every_record_is_no_surer():
    errors = np.full((2, 5), 0.02)
    errors[1] *= 1.001
    assert predicts_best(errors, EQUAL, 30.0, 0) == pytest.approx([0.5, 0.5], abs=0.03)


def test_models_that_are_better_in_half_of_the_records_are_equally_probable():
    errors = np.array([[1.0, 2.0] * 10, [2.0, 1.0] * 10])
    found = predicts_best(errors, EQUAL, 3.0, 3)
    assert found == pytest.approx([0.5, 0.5], abs=0.05)
    assert found.sum() == pytest.approx(1.0)
    np.testing.assert_array_equal(found, predicts_best(errors, EQUAL, 3.0, 3))


def test_one_record_in_which_a_model_is_far_better_makes_it_less_sure_than_all_records_do():
    once, always = np.full((2, 6), 1.0), np.full((2, 6), 1.0)
    once[0, 0], always[0] = np.exp(-6.0), np.exp(-1.0)
    one, every = (predicts_best(e, EQUAL, 2.0, 0)[0] for e in (once, always))
    assert every > 0.98 > 0.95 > one


def test_what_is_known_beforehand_counts():
    errors = np.full((2, 4), 1.0)
    found = predicts_best(errors, np.log([0.9, 0.1]), 5.0, 0)
    assert found == pytest.approx([0.9, 0.1])


def test_errors_are_less_by_more_than_their_standard_error_only():
    was = np.array([1.0, 1.2, 0.9, 1.1])
    assert is_less(was - 0.1, was)
    assert not is_less(was, was)
    assert not is_less(was + [-0.5, 0.4, 0.4, -0.4], was)


def test_a_lone_record_can_t_tell():
    assert is_less(np.array([2.0]), np.array([1.0]))


FREQUENCIES = (0.3, 0.7, 1.5)


def loaded(amplitude, omega, theta):
    """Inertia and damping, with an offset of each record that follows no law."""
    v = amplitude * omega * np.cos(theta)
    offset = 60.0 * np.sin(730.0 * amplitude * omega)
    return -80.0 * amplitude * omega**2 * np.sin(theta) + 900.0 * v + offset


def test_what_belongs_to_one_record_is_taken_from_it_when_it_is_left_out():
    records = campaign(loaded, frequencies=FREQUENCIES, amplitudes=(0.01, 0.02), noise=0.01)
    device = prepare(records, StudyOptions()).device
    structure = (FittedTerm("inertia", 1.0, {}), FittedTerm("viscous-damping", 1.0, {}))
    count = len(records.records)
    own = tuple(FittedTerm("force-offset", 1.0, {"only": float(n)}) for n in range(1, count + 1))
    none, one, each = (
        predicted(device, ForceModel((*structure, *offsets)))
        for offsets in ((), (FittedTerm("force-offset", 1.0, {}),), own)
    )
    assert np.all(each < 2.0 * 0.01**2)
    assert np.mean(none) > 100.0 * np.mean(each)
    assert np.mean(one) > 100.0 * np.mean(each)


def predicted(device, model):
    """Return what a model leaves of each record, predicted by the others."""
    assessor = device.assessor
    assessed = assessor.assess(Composite.of(model), assessor.space.start)
    return left_out(assessed.predicting)[1]


def test_an_offset_of_every_record_s_own_has_to_be_worth_a_number_for_each():
    """Beside an offset that all share, and a third harmonic that no term has."""
    def law(amplitude, omega, theta):
        v = amplitude * omega
        nearly = 60.0 + 9.0 * v * np.sign(np.sin(730.0 * v))
        plain = -80.0 * v * omega * np.sin(theta) + 900.0 * v * np.cos(theta)
        return plain + nearly + 200.0 * v * np.cos(3.0 * theta)

    records = campaign(law, frequencies=FREQUENCIES, amplitudes=(0.01, 0.02), noise=0.001)
    device = prepare(records, StudyOptions()).device
    structure = FittedTerm("inertia", 80.0), FittedTerm("viscous-damping", 900.0)
    count = len(records.records)
    own = tuple(FittedTerm("force-offset", 60.0, {"only": n + 1.0}) for n in range(count))
    shared, each = (
        device.assessor.assess(
            Composite.of(ForceModel((*structure, *offsets))), device.assessor.space.start
        )
        for offsets in ((FittedTerm("force-offset", 60.0),), own)
    )
    assert is_less(left_out(each.predicting)[1], left_out(shared.predicting)[1])
    assert not predicts_better(shared, each)
    np.testing.assert_array_equal(compared(shared), left_out(shared.predicting)[1])


@pytest.mark.parametrize(("alike", "worse"), [(True, False), (False, True)])
def test_what_every_test_has_of_its_own_is_known_by_its_mean_where_nothing_was_seen(alike, worse):
    """Offsets of both signs explain every record, and say nothing of the next one."""
    def law(amplitude, omega, theta):
        v = amplitude * omega
        plain = -80.0 * v * omega * np.sin(theta) + 900.0 * v * np.cos(theta)
        return plain + (60.0 if alike or amplitude < 0.015 else -60.0) + 30.0 * np.cos(3.0 * theta)

    records = campaign(law, frequencies=FREQUENCIES, amplitudes=(0.01, 0.02), noise=0.001)
    device = prepare(records, StudyOptions()).device
    structure = FittedTerm("inertia", 80.0), FittedTerm("viscous-damping", 900.0)
    own = [FittedTerm("force-offset", 60.0, {"only": n + 1.0}) for n in range(len(records.records))]
    none, each = (
        device.assessor.assess(
            Composite.of(ForceModel((*structure, *offsets))), device.assessor.space.start
        )
        for offsets in ((), own)
    )
    assert not each.quiet
    assert is_less(unseen(none), unseen(each)) == worse
    assert (predicted_no_worse(each, unseen(none)) is None) == worse
    assert predicts_better(none, each) != worse
    np.testing.assert_array_equal(predicted_no_worse(none, unseen(none)), compared(none))


def test_of_one_record_in_one_piece_evidence_decides():
    rows = rows_of(misfit(20.0), APART[:1], cycles=3)
    assessor = assessor_of(rows, friction=False)
    bare, sprung = (assessor.assess(m, assessor.space.start) for m in (DEVICE, SPRUNG))
    less = replace(sprung, value=bare.value - 1.0)
    more = replace(sprung, value=bare.value + 1.0)
    assert (predicts_better(bare, less), predicts_better(bare, more)) == (False, True)


def long_record():
    """Return a long random record of a device with a cube, with noise that rises to slow motion."""
    rng = np.random.default_rng(4)
    time = 0.005 * np.arange(12_000)
    omega = 2.0 * np.pi * np.sort(rng.uniform(0.3, 8.0, 80))[:, None]
    angle = omega * time + rng.uniform(0.0, 2.0 * np.pi, omega.shape)
    x = np.sum(0.002 / omega * np.sin(angle), axis=0)
    v = np.sum(0.002 * np.cos(angle), axis=0)
    a = np.sum(-0.002 * omega * np.sin(angle), axis=0)
    noise = lfilter([1.0], [1.0, -0.995], rng.standard_normal(time.size))
    return Record("random.csv", time, 80.0 * a + 900.0 * v + 1e9 * x**3 + 0.02 * noise, x)


@pytest.mark.parametrize("names", [("inertia", "viscous-damping"), ("inertia", "cubic-stiffness")])
def test_what_a_model_leaves_of_a_long_record_is_what_least_squares_on_all_its_rows_leave(names):
    device = prepare(Campaign("one", (long_record(),)), StudyOptions()).device
    (rows,) = device.rows
    assert rows.target.size > 400
    terms = [FittedTerm(n, 1.0, {}) for n in names]
    *columns, force = np.vstack([force_columns(rows, terms), rows.target]) / rows.size
    missed = force - np.transpose(columns) @ np.linalg.lstsq(np.transpose(columns), force)[0]
    assessor = device.assessor
    assessed = assessor.assess(Composite.of(ForceModel(tuple(terms))), assessor.space.start)
    fitted, unseen = left_out(assessed.predicting)
    assert np.sum(fitted) == pytest.approx(float(missed @ missed / (force @ force)), rel=0.02)
    assert np.all(unseen >= 0.99 * fitted)


@pytest.mark.parametrize(("terms", "told"), [
    ({"inertia": 120.0, "viscous_damping": 800.0}, False),
    ({"viscous_damping": 800.0}, True),
])  # fmt: skip
def test_of_long_records_what_is_left_is_told_from_all_the_noise_that_is_in_it(terms, told):
    assessor = assessor_of([random_rows(seed) for seed in range(1, 5)], friction=False)
    assert any(u.basis is not None for u in assessor.space.sheet.units)
    assessed = assessor.assess(model_of(**terms), assessor.space.start)
    assert is_told_from_noise(assessed) is told


DEVICE = model_of(inertia=100.0, viscous_damping=700.0)
SPRUNG = DEVICE.plus(FittedTerm("stiffness", 1.0))


def misfit(size, spring=3e3):
    """Return a law of a device with a spring, and a third harmonic that no term has."""
    def law(t, x, v, a):
        phase = np.arctan2(v / np.abs(v).max(), x / np.abs(x).max())
        return 120.0 * a + 800.0 * v + spring * x + size * np.cos(3.0 * phase)

    return law


def assessed_of(law, model=DEVICE):
    assessor = assessor_of(rows_of(law, APART, cycles=3), friction=False)
    return assessor.assess(model, assessor.space.start)


@pytest.mark.parametrize(("spring", "held"), [(3e3, False), (4e4, True)])
def test_each_record_is_predicted_by_least_squares_on_the_others(spring, held):
    assessed = assessed_of(misfit(20.0, spring)).predicting
    np.testing.assert_array_equal(assessed.local.held, [held, False])
    space = assessed.space
    sheet, sizes = space.sheet, assessed.place.sizes(space.own_unit)
    columns = np.stack([of_formula(sheet.rows, f) for f in (lambda t, x, v, a: a,
                                                            lambda t, x, v, a: v)], axis=1)
    columns = columns[:, ~assessed.local.held]  # a coefficient at its limit stays there
    spread = whole_force(columns, sheet.target)
    own = dense(space, Sizes(np.sqrt(0.1) * sizes.remainder, sizes.loud, sizes.friction))
    size = sheet.target.shape[1]

    def errors(kept, unit):
        gram, side = np.diag(spread**-2.0), 0.0
        for u in kept:
            here = slice(u * size, (u + 1) * size)
            weighted = np.linalg.solve(own[here, here], columns[u].T)
            gram, side = gram + columns[u] @ weighted, side + weighted.T @ sheet.target[u]
        left = sheet.target[unit] - np.linalg.solve(gram, side) @ columns[unit]
        scale = sheet.rows[unit].size
        return np.sum((left / scale) ** 2) / np.sum((sheet.target[unit] / scale) ** 2)

    every = range(len(sheet.units))
    fitted, unseen = left_out(assessed)
    np.testing.assert_allclose(fitted, [errors(every, u) for u in every], rtol=1e-3)
    np.testing.assert_allclose(
        unseen, [errors([o for o in every if o != u], u) for u in every], rtol=1e-3
    )
    assert np.all(unseen > fitted)


@pytest.mark.parametrize("model", [DEVICE, SPRUNG])
def test_what_no_term_has_is_not_used_to_predict(model):
    """Beside a remainder too, what is left of a test is what the terms leave of it."""
    assessed = assessed_of(misfit(20.0), model)
    fitted, _ = left_out(assessed)
    rows = assessed.space.sheet.rows
    left = assessed.space.sheet.target - assessed.local.force
    plain = [np.sum((d / r.size) ** 2) / np.sum((r.target / r.size) ** 2)
             for d, r in zip(left, rows, strict=True)]  # fmt: skip
    assert np.sum(fitted) == pytest.approx(np.sum(plain), rel=0.3)


def test_a_model_with_the_term_that_is_missing_predicts_better_and_needs_it():
    without, with_it = (assessed_of(misfit(20.0), m) for m in (DEVICE, SPRUNG))
    better, worse = predicts_better(without, with_it), predicts_better(with_it, without)
    assert (better, worse) == (True, False)
    quiet = without.quiet, with_it.quiet
    assert quiet == (False, False)
    assert is_needed(without, with_it)


def test_where_a_model_leaves_but_noise_evidence_tells_what_it_needs():
    bare, sprung = assessed_of(misfit(0.0)), assessed_of(misfit(0.0), SPRUNG)
    quiet = bare.quiet, sprung.quiet
    assert quiet == (False, True)
    more = replace(sprung, value=sprung.value - 5.0)
    needed = is_needed(bare, sprung), is_needed(sprung, more), is_needed(more, sprung)
    assert needed == (True, False, True)
