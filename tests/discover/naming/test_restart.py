"""Starts of what moves through a joint. The model's own force: it is the search that is tested."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from discover.motion_fit import observe
from discover.naming import polish
from discover.naming.fit import fit_model, free_parameters
from discover.naming.forces import has_joint, is_joint
from discover.naming.polish import polished
from discover.naming.refine import is_a_spring
from discover.naming.restart import restarted
from discover.naming.rows import record_rows
from models.constitutive import FittedTerm, ForceModel
from models.motion import sine_motion
from tests.discover.gap_data import campaign

DEVICE = (FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0))
PLAY = {"gap": 2e-4, "contact": 400.0, "loss": 0.5, "inside": 0.0}


def through(joint, points=1024):
    model = ForceModel((*DEVICE, joint))

    def law(t, x, v, a):
        amplitude = round(float(np.abs(x).max()), 5)
        frequency = round(float(np.abs(v).max()) / amplitude / (2.0 * np.pi), 2)
        cycle = sine_motion(amplitude, frequency, samples=points)
        force = model.force(cycle)
        grid = np.arange(points + 1) / points
        return np.interp(np.mod(t * frequency, 1.0), grid, np.append(force, force[0]))

    return [record_rows(observe(r)) for r in campaign(law).records]


@pytest.fixture(scope="module")
def play():
    return through(FittedTerm("backlash", 1.0, PLAY))


def test_a_start_in_another_hollow_is_left(play):
    wrong = FittedTerm("backlash", 0.6, {**PLAY, "gap": 2.3e-4, "contact": 600.0})
    model = ForceModel((*DEVICE, wrong))
    stuck = fit_model(play, model, free_parameters(model), iterations=8)
    found = restarted(play, stuck)
    assert found.chi2 < 0.05 * stuck.chi2
    assert found.model.terms[2].shape["gap"] == pytest.approx(PLAY["gap"], rel=0.03)
    assert abs(stuck.model.terms[2].shape["gap"] / PLAY["gap"] - 1.0) > 0.1


def test_a_good_start_is_kept(play):
    model = ForceModel((*DEVICE, FittedTerm("backlash", 1.0, PLAY)))
    good = fit_model(play, model, free_parameters(model), iterations=2)
    assert restarted(play, good) is good


def test_samples_say_more_of_impacts_than_lines(play):
    samples = [r.samples for r in play]
    model = ForceModel((*DEVICE, FittedTerm("backlash", 1.0, {**PLAY, "gap": 2.004e-4})))
    rough = fit_model(play, model, free_parameters(model), iterations=0)
    found = polished(play, rough)
    before = fit_model(samples, rough.model, ()).chi2
    assert fit_model(samples, found.model, ()).chi2 < 0.8 * before
    assert found.residual.size == rough.residual.size


def unwanted(*_):
    raise AssertionError("sought further")


def test_a_good_fit_is_polished_without_seeking_another_joint(monkeypatch):
    monkeypatch.setattr(polish, "scattered", unwanted)
    monkeypatch.setattr(polish, "_step_by_step", unwanted)
    model = ForceModel((*DEVICE, FittedTerm("backlash", 1.0, PLAY)))
    fine = through(model.terms[2], points=8192)
    good = fit_model(fine, model, free_parameters(model), iterations=0)
    assert polished(fine, good).model.terms[2].shape["gap"] == pytest.approx(2e-4, rel=0.01)


def test_a_mount_that_yields_has_no_impacts_to_step_to(play, monkeypatch):
    monkeypatch.setattr(polish, "_step_by_step", unwanted)
    model = ForceModel((*DEVICE, FittedTerm("series-compliance", 1e-8)))
    assert polished(play, fit_model(play, model, free_parameters(model), iterations=1))


def test_samples_of_other_terms_are_their_force(play):
    """The rows of samples hold the same force as the record, over the noise."""
    r = play[-1]
    rows = r.samples
    count = rows.target.size
    scale = rows.target / r.observation.measured[:count]
    np.testing.assert_allclose(scale, scale[0])
    velocity = r.observation.motion.velocity
    np.testing.assert_allclose(rows.project(velocity), scale[0] * velocity[:count])
    cycle = rows.observation.cycle.velocity
    near = np.abs(cycle @ rows.cycle_rows - rows.project(velocity)).max()
    assert near < 1e-3 * np.abs(rows.project(velocity)).max()


def test_what_is_a_joint():
    assert is_joint("backlash")
    assert is_joint("series-compliance")
    assert is_joint("cavitation")
    assert not is_joint("sensor-clipping")
    assert has_joint(ForceModel((*DEVICE, FittedTerm("backlash", 1.0, PLAY))))
    assert not has_joint(ForceModel(DEVICE))


def test_no_start_is_followed_where_none_is_better_by_far(play):
    """A device without a joint: play explains nothing of it."""

    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + 50.0 * np.sign(x)

    rows = [record_rows(observe(r)) for r in campaign(law).records]
    plain = ForceModel(DEVICE)
    without = fit_model(rows, plain, free_parameters(plain))
    tried = ForceModel((*without.model.terms, FittedTerm("backlash", 1.0, PLAY)))
    begun = fit_model(rows, tried, ())
    assert restarted(rows, begun, instead_of=without) is begun
    plain = fit_model(play, plain, free_parameters(plain))
    wrong = FittedTerm("backlash", 0.6, {**PLAY, "gap": 2.5e-4, "contact": 250.0})
    begun = fit_model(play, ForceModel((*plain.model.terms, wrong)), ())
    assert restarted(play, begun, instead_of=plain).chi2 < 0.5 * plain.chi2


@pytest.mark.parametrize(("gap", "contact", "spring"), [
    (2e-6, 230.0, True), (2e-4, 400.0, False), (2e-5, 1800.0, False),
])
def test_a_play_far_smaller_than_what_its_flanks_give_is_a_spring(play, gap, contact, spring):
    joint = FittedTerm("backlash", 1.0, {**PLAY, "gap": gap, "contact": contact})
    assert is_a_spring(play, ForceModel((*DEVICE, joint))) is spring
    held = [replace(r, held=DEVICE) for r in play]
    assert is_a_spring(held, ForceModel((joint,))) is spring
    assert not is_a_spring(play, ForceModel(DEVICE))


@pytest.mark.parametrize("softness", [0.03, 0.08, 0.15, 0.4, 1.0])
@pytest.mark.parametrize("contact", [400.0, 1800.0])
def test_soft_flanks_that_bear_in_the_middle_of_a_play_are_a_spring(play, softness, contact):
    """As far as a fitted law of a joint goes, it then only stiffens; solved for by SciPy."""
    shape = {**PLAY, "contact": contact, "softness": softness}
    stiffness = DEVICE[0].coefficient * contact**2
    greatest = max(np.abs(r.observation.measured).max() for r in play)
    width = softness * PLAY["gap"]

    def law(depth):
        flanks = (np.logaddexp(0.0, (s * depth - 0.5 * PLAY["gap"]) / width) for s in (1.0, -1.0))
        return stiffness * width * float(np.subtract(*flanks))

    under = brentq(lambda depth: law(depth) - greatest, 0.0, PLAY["gap"] + greatest / stiffness)
    middle, secant = law(1e-9) / 1e-9, greatest / under
    joint = FittedTerm("backlash", 1.0, shape)
    assert is_a_spring(play, ForceModel((*DEVICE, joint))) is bool(middle > 0.25 * secant)


TORN = {
    "limit": 260.0, "softness": 0.0, "contact": 400.0, "loss": 0.4,
    "refill": 1.0, "lag": 0.0, "side": -1.0,
}


def test_starts_are_around_the_kind_that_fits_not_the_first_one():
    """A straight line may lead to the wrong side at a size that means nothing."""
    rows = through(FittedTerm("cavitation", 1.0, TORN))
    plain = ForceModel(DEVICE)
    without = fit_model(rows, plain, free_parameters(plain))
    wrong = FittedTerm("cavitation", 0.07, {**TORN, "limit": 40.0, "side": 1.0})
    stuck = fit_model(rows, ForceModel((*DEVICE, wrong)), ())
    other = FittedTerm("cavitation", 0.05, {**TORN, "limit": 330.0, "contact": 250.0})
    found = restarted(rows, stuck, instead_of=without, besides=(other,))
    assert found.chi2 - found.residual.size < 0.02 * without.chi2
    assert found.model.terms[2].shape["limit"] == pytest.approx(TORN["limit"], rel=0.03)
    assert found.model.terms[2].shape["side"] == -1.0
