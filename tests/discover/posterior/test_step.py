"""What may join a model, by hand."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import expit

from discover.posterior.step import Candidate, Step, ordered
from tests.discover.gap_data import device
from tests.discover.posterior.small import APART, assessor_of, model_of, rows_of

EQUAL = np.array([0.02, 0.03, 0.01, 0.02])


@pytest.fixture(scope="module")
def assessed():
    assessor = assessor_of(rows_of(device, APART, cycles=3), friction=False)
    model = model_of(inertia=120.0, viscous_damping=800.0, stiffness=1.0)
    return replace(assessor.assess(model, assessor.space.start), value=-50.0)


def weighed(*values):
    names = ("", "stiffness", "cubic-stiffness", "force-offset")
    return [Candidate(n, v, None) for n, v in zip(names, values, strict=False)]


def test_by_evidence_probabilities_are_in_the_ratio_of_it():
    found = Step(tuple(weighed(-9.0, -9.0 + np.log(3.0), -9.0 + np.log(4.0)))).probabilities
    assert found == pytest.approx({"": 1 / 8, "stiffness": 3 / 8, "cubic-stiffness": 4 / 8})


def test_the_most_probable_comes_first_and_of_equals_the_model_as_it_is():
    assert [c.id for c in ordered(Step(tuple(weighed(1.0, 3.0, 2.0)))).candidates] == [
        "stiffness", "cubic-stiffness", ""
    ]  # fmt: skip
    equal = ordered(Step(tuple(weighed(2.0, 2.0, 1.0)[::-1])))
    assert [c.id for c in equal.candidates] == ["", "stiffness", "cubic-stiffness"]
    assert equal.best.id == ""


def test_without_some_the_others_share_what_there_is():
    step = ordered(Step(tuple(weighed(0.0, 5.0, np.log(3.0))), seed=4, lines=7.0))
    left = step.without(["stiffness", "end-stop"])
    assert left.probabilities == pytest.approx({"": 1 / 4, "cubic-stiffness": 3 / 4})
    assert left.best.id == "cubic-stiffness"
    assert (left.seed, left.lines) == (4, 7.0)


def predicting(assessed, *entries, lines=20.0):
    """Return a step by prediction, of ids, values, priors and errors."""
    return Step(
        tuple(
            Candidate(i, value, replace(assessed, value=value - prior), 1, left)
            for i, value, prior, left in entries
        ),
        lines=lines,
    )


def test_what_predicts_alike_is_as_probable_as_beforehand_and_beside_a_remainder(assessed):
    step = predicting(
        assessed, ("", -50.0, 0.0, EQUAL), ("stiffness", -49.0, -1.5, EQUAL),
        ("cubic-stiffness", -53.0, -0.5, EQUAL),
    )  # fmt: skip
    odds = np.array([1.0, np.exp(-1.5) * expit(1.0), np.exp(-0.5) * expit(-3.0)])
    assert list(step.probabilities.values()) == pytest.approx(list(odds / odds.sum()))


def test_what_predicts_better_is_more_probable_the_more_lines_say_so(assessed):
    def probable(lines):
        step = predicting(
            assessed, ("", -50.0, 0.0, EQUAL), ("stiffness", -45.0, 0.0, 0.7 * EQUAL), lines=lines
        )
        return step.probabilities["stiffness"]

    assert probable(1e-6) == pytest.approx(0.5, abs=0.01)
    assert 0.5 < probable(1.0) < probable(5.0)
    assert probable(200.0) > 0.99


def test_a_name_that_predicts_but_makes_records_less_probable_is_ruled_out(assessed):
    step = predicting(
        assessed, ("", -50.0, 0.0, EQUAL), ("stiffness", -80.0, 0.0, 0.9 * EQUAL), lines=5.0
    )
    assert step.probabilities["stiffness"] < 1e-6


def test_one_error_predicts_nothing_and_evidence_decides(assessed):
    step = predicting(
        assessed, ("", -50.0, 0.0, EQUAL[:1]),
        ("stiffness", -50.0 - np.log(4.0), 0.0, 1e-9 * EQUAL[:1]),
    )
    assert step.probabilities == pytest.approx({"": 4 / 5, "stiffness": 1 / 5})


def test_where_some_predict_others_have_no_probability(assessed):
    step = predicting(assessed, ("", -50.0, 0.0, EQUAL), ("stiffness", -49.0, 0.0, EQUAL))
    more = Step((*step.candidates, Candidate("end-stop", -40.0, None)), lines=step.lines)
    assert more.probabilities["end-stop"] == 0.0
    assert sum(more.probabilities.values()) == pytest.approx(1.0)
    assert ordered(more).candidates[-1].id == "end-stop"


def test_a_candidate_s_terms_are_the_last_ones_and_its_prior_is_beside_the_evidence(assessed):
    one = Candidate("stiffness", -52.5, assessed, 1)
    assert list(one.places) == [2]
    assert list(Candidate("stiffness", -52.5, assessed, 2).places) == [1, 2]
    assert one.log_prior == -2.5
    assert Candidate("stiffness", -52.5, None).log_prior == 0.0
    assert list(Candidate("stiffness", -52.5, None).places) == []
