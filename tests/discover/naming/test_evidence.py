"""Probabilities of names from how well hypotheses fit."""

import pytest

from discover.naming.contest import Contest
from discover.naming.evidence import AGREES, UNKNOWN, Entry, probabilities_of, usual_left

NOISE, EXCESS, INFORMATIVE = 1000.0, 50_000.0, 96.0
MANY = [None] * 12  # records: their number alone counts


def entry(*effects, left, evidence):
    """Return a hypothesis that leaves a share of the misfit."""
    return Entry(effects, (), (), NOISE + left * EXCESS, evidence)


def contest(*entries):
    """Return the contest of entries beside the model as it is."""
    everything = (*entries, entry(left=1.0, evidence=-400.0))
    names = ["stiffness", "inertia", "end-stop"]
    usual = usual_left(MANY, 0.0)
    chances = probabilities_of(everything, names, EXCESS, INFORMATIVE, usual)
    return Contest(everything, chances, EXCESS, 600, NOISE, 0.0, {})


@pytest.mark.parametrize(
    ("left", "first"), [(0.01, "stiffness"), (0.03, "stiffness"), (0.06, UNKNOWN), (0.4, UNKNOWN)]
)
def test_two_shapes_have_to_leave_less_than_one(left, first):
    """A single shape that leaves 6 % is named; two that leave as much are by chance."""
    pair = contest(
        entry("stiffness", left=0.5, evidence=-150.0),
        entry("stiffness", "inertia", left=left, evidence=-149.0),
    )
    assert pair.ranked[0][0] == first
    alone = contest(entry("stiffness", left=0.06, evidence=-150.0))
    assert alone.ranked[0][0] == "stiffness"


@pytest.mark.parametrize(("left", "sure"), [(0.045, "stiffness"), (0.12, UNKNOWN)])
def test_how_sure_is_what_shapes_were_seen_to_leave(left, sure):
    """On rigs right shapes left up to 4.5 % and wrong ones, the nearest there were, 7.6 and up."""
    alone = contest(entry("stiffness", left=left, evidence=-150.0))
    assert alone.ranked[0][0] == sure
    assert alone.ranked[0][1] > 0.85


def test_what_was_said_for_one_alone_is_lost_when_it_does_not_help():
    """Only what rests on both passes on to the other one."""
    found = contest(
        entry("stiffness", left=0.02, evidence=-150.0),
        entry("stiffness", "inertia", left=0.02, evidence=-153.0),
        entry("stiffness", "end-stop", left=0.02, evidence=-180.0),
    )
    without = found.without_alone("stiffness", "inertia")
    assert without.probabilities["stiffness"] == 0.0
    assert sum(without.probabilities.values()) == pytest.approx(1.0)
    assert without.ranked[0][0] == UNKNOWN
    share = without.probabilities["inertia"] / found.probabilities["stiffness"]
    assert share == pytest.approx(1.0 / (1.0 + 2.718281828), rel=1e-3)
    both = contest(entry("stiffness", "inertia", left=0.01, evidence=-150.0))
    assert both.without_alone("stiffness", "inertia").ranked[0][0] == "inertia"


def test_what_may_be_one_record_s_noise_stays_among_the_alternatives():
    """The model agrees with the chance that the name had; others keep their order."""
    found = contest(
        entry("stiffness", left=0.02, evidence=-150.0), entry("inertia", left=0.02, evidence=-151.0)
    )
    doubtful = found.in_doubt("stiffness")
    assert doubtful.probabilities[AGREES] == pytest.approx(found.probabilities["stiffness"])
    assert sum(doubtful.probabilities.values()) == pytest.approx(1.0)
    assert [name for name, _ in doubtful.ranked[:3]] == [AGREES, "stiffness", "inertia"]


def test_nothing_said_for_a_pair_is_nothing_passed_on():
    found = contest(entry("stiffness", left=0.02, evidence=-150.0))
    without = found.without_alone("stiffness", "end-stop")
    assert without.probabilities["end-stop"] == 0.0
    assert without.probabilities[AGREES] == found.probabilities[AGREES]
