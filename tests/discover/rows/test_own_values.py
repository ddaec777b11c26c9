"""What every test has of its own, in a record that was not fitted."""

from dataclasses import replace

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.records import Campaign
from discover.rows import accuracy, record_rows, with_own_values
from discover.study import run_study
from models.constitutive import FittedTerm, ForceModel
from tests.discover.gap_data import PLAN, device, record

LAW = (FittedTerm("inertia", 120.0), FittedTerm("viscous-damping", 800.0))
OWN = (-28.0, 35.0, -42.0, 12.0, -17.0, 55.0, 21.0, -33.0)
HELD_OUT = 6


def observed(offset, late=0.0):
    """Return a test at 1 Hz whose force is some seconds late."""
    w = 2.0 * np.pi
    cos, sin = np.cos(w * late), np.sin(w * late)

    def force(t, x, v, a):
        return device(t, x, v * cos + w * x * sin, a * cos + w * v * sin) + offset

    rng = np.random.default_rng(3)
    return replace(observe(record(1.0, 0.01, force, rng, noise=0.01)), test=3)


def fitted(*own):
    return ForceModel((*LAW, *own))


def each(name, values):
    return [FittedTerm(name, v, {"only": float(k)}) for k, v in enumerate(values, start=1)]


def test_an_offset_of_every_test_is_the_record_s_own():
    observation = observed(35.0)
    model = fitted(*each("force-offset", (-20.0, 5.0)))
    own = with_own_values(model, record_rows(observation))
    assert own.coefficient("force-offset") == pytest.approx(35.0, abs=0.2)
    assert own.coefficient("inertia") == 120.0
    left = accuracy(observation, own)
    assert left.relative_percent == pytest.approx(left.noise_percent, rel=0.1)
    assert accuracy(observation, model).relative_percent > 5.0 * left.relative_percent


def test_a_delay_of_every_test_is_too_beside_an_offset():
    observation = observed(35.0, late=4e-3)
    model = fitted(*each("force-offset", (-20.0, 5.0)), *each("time-delay", (1e-3, 2e-3)))
    own = with_own_values(model, record_rows(observation))
    assert own.coefficient("force-offset") == pytest.approx(35.0, abs=0.2)
    assert own.coefficient("time-delay") == pytest.approx(4e-3, rel=0.03)


def test_a_model_of_all_tests_stays_as_it_is():
    model = fitted(FittedTerm("force-offset", 12.0))
    assert with_own_values(model, record_rows(observed(35.0))) is model


def test_a_study_says_what_the_law_leaves_beside_the_offset_that_it_can_not_know():
    records = []
    rng = np.random.default_rng(8)
    for place, ((f, a), offset) in enumerate(zip(PLAN, OWN, strict=True)):
        one = record(
            f, a, lambda *m, at=offset: device(*m) + at, rng, noise=0.02,
            held_out=place == HELD_OUT,
        )  # fmt: skip
        records.append(one)
    study = run_study(Campaign("offsets of their own", tuple(records)))
    assert [e.term.fitted.id for e in study.bands[0].extras][:1] == ["force-offset"]
    assert study.held_out_with_own_values_percent == pytest.approx(2.0, abs=0.15)
    assert study.held_out_relative_error_percent > 1.5 * study.held_out_with_own_values_percent
    assert "% once a force offset of their own is fitted to them)" in study.summary()
    assert "held_out_with_own_values_percent" in study.to_dict()
