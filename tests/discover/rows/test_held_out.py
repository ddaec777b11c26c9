"""Held-out records that are met worse than the fitted ones are told, and what they go beyond."""

import numpy as np
import pytest

from discover.records import Campaign, Record
from discover.study import StudyOptions, run_study

LINEAR = ("inertia", "viscous-damping")


def sine(name, amplitude, rng, *, held_out=False, cubic=0.0):
    """Return a sine test of 80 a + 500 v + cubic v^3, with 1 % noise."""
    omega = 2.0 * np.pi
    time = np.arange(4000) / 400.0
    x, v = amplitude * np.sin(omega * time), amplitude * omega * np.cos(omega * time)
    force = -80.0 * omega**2 * x + 500.0 * v + cubic * v**3
    force = force + 0.01 * force.std() * rng.standard_normal(time.size)
    shown = x + 1e-4 * amplitude * rng.standard_normal(time.size)
    return Record(name, time, force, shown, held_out=held_out)


def told(**other):
    rng = np.random.default_rng(4)
    tests = [sine(f"{size}.csv", size, rng) for size in (0.01, 0.02)]
    tests.append(sine("held.csv", held_out=True, rng=rng, **other))
    study = run_study(Campaign("lab", tuple(tests)), StudyOptions(terms=LINEAR))
    return [f for f in study.findings if "held out" in f.text]


def test_a_law_that_fails_beyond_the_fitted_amplitudes_is_told():
    (finding,) = told(amplitude=0.06, cubic=3000.0)
    assert (finding.level, finding.record) == ("warning", "held.csv")
    assert "amplitude (60 mm, they up to 20)" in finding.text
    assert "frequency" not in finding.text


@pytest.mark.parametrize("amplitude", [0.015, 0.06])
def test_a_law_that_holds_beyond_them_is_not(amplitude):
    assert told(amplitude=amplitude) == []
