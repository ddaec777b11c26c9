from dataclasses import replace

import pytest

from discover.figure_data import GapFigureData
from discover.plots.gap import effect_shape, gap_by_round
from discover.report.gap import gap_figures, gap_lines, gap_report
from discover.words import warning_lines
from tests.discover.sample_gap import sample_gap_data, sample_gap_document
from tests.discover.test_report_study import Page


def page_of(document, data):
    return Page(gap_report(document, data, gap_figures(document, data), command="inerter gap rig"))


def test_page_is_self_contained_and_carries_each_part():
    page = page_of(sample_gap_document(), sample_gap_data())
    assert page.open == []
    assert len(page.ids) == len(set(page.ids))
    assert all(a.startswith(("#", "data:image/png;base64,")) for a in page.addresses)
    for part in (
        "Round 1: Coulomb friction",
        "Round 2: force offset",
        "Record by record",
        "The mended model",
        "396 to 406",
        "Where the baseline misses",
        "The effect's shape",
        "395 to 409",
        "Transition speed 2 mm/s",
        "direction of motion",
        "inerter gap rig",
    ):
        assert part in page.text
    verdict = page.text.index("Closed: with Coulomb friction and force offset added")
    assert verdict < page.text.index("How the gap shrinks")


def test_lines_name_effects_with_alternatives_and_both_gaps():
    lines = [line.replace("\u202f", " ") for line in gap_lines(sample_gap_document())]
    assert lines[1] == "Missing: Coulomb friction 93 % and force offset > 99 %."
    assert lines[2] == (
        "Round 1: Coulomb friction 93 %, or Stribeck friction (6 %); explains 99 % of what was more"
        " than noise, gap 18.3 % to 2.4 %; its formula leaves more than noise; records not fitted"
        " are met better (21 % to 2.6 %)."
    )
    assert "; its shape holds; " in lines[3]
    assert lines[4] == (
        "Gap: 18.3 % before, 1.2 % after; 1.3 % on records that were not fitted; noise 1.1 %;"
        " of single tests 0.5hz-10mm.csv is worst, 1.19 times its noise."
    )
    assert lines[5] == (
        "Left over: of the force, beyond noise, 0.21 % (0.1 to 0.32 %); every record counts alike."
    )


def test_a_round_that_serves_the_quiet_records_says_so():
    document = sample_gap_document()
    alike = {"rms_record_gap_before_percent": 61.0, "rms_record_gap_after_percent": 20.4}
    document["rounds"] = [{**document["rounds"][0], "gap_after_percent": 19.5, **alike}]
    text = " ".join(gap_lines(document)).replace("\u202f", " ")
    assert "gap 18.3 % to 19.5 % pooled, 61 % to 20.4 % with every record counting alike" in text


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("verdict", ["agrees", "unexplained"])
def test_nothing_named_still_reports(verdict):
    document = sample_gap_document()
    document |= {"rounds": [], "verdict": verdict, "final_held_out_gap_percent": None}
    if verdict == "unexplained":
        document["shape"] = "odd in velocity, growing with the square of speed"
    page = page_of(document, GapFigureData(records=sample_gap_data().records))
    assert verdict.capitalize() in page.text
    assert ("Odd in velocity" in page.text) == (verdict == "unexplained")
    assert "Round 1" not in page.text


def test_lines_say_what_is_not_told_apart_and_what_refitting_alone_closed():
    document = sample_gap_document()
    first = {**document["rounds"][0], "not_distinguishable_from": ["stribeck-friction"]}
    document |= {"rounds": [{**first, "gap_before_percent": 8.0}], "final_gap_percent": 1.3}
    lines = [line.replace("\u202f", " ") for line in gap_lines(document)]
    assert "Coulomb friction 93 % (or Stribeck friction: not told apart)" in lines[1]
    assert "18.3 % as given, 8 % with the model's own coefficients refitted, 1.3 %" in lines[3]
    assert "added nothing more shows in the tests' own lines" in lines[0]  # above the noise


def test_a_restricted_search_does_not_speak_for_the_catalogue():
    document = sample_gap_document()
    document |= {"rounds": [], "verdict": "unexplained", "effects": ["stiffness"]}
    assert "none of the effects asked for explains" in gap_lines(document)[0]


def test_warnings_stand_on_the_terminal_with_their_record():
    document = sample_gap_document()
    document["findings"] = [
        {"level": "note", "text": "quiet"},
        {"level": "warning", "text": "loud", "record": "a.csv"},
    ]
    assert warning_lines(document) == ["Warning: a.csv: loud"]


def test_what_a_later_name_replaced_is_not_said_to_be_missing():
    document = sample_gap_document()
    first = document["rounds"][0]
    other = {**first, "effect": "viscous-damping", "dropped": [first["effect"]]}
    lines = gap_lines({**document, "rounds": [first, other]})
    said = [line.replace("\u202f", " ") for line in lines]
    missing = next(line for line in said if line.startswith("Missing"))
    assert "viscous damping" in missing
    assert "Coulomb" not in missing
    assert any("instead of Coulomb friction" in line for line in said)


def drawn_shape(joined):
    shape = replace(sample_gap_data().shapes[0], joined=joined)
    return effect_shape(shape, name="shape")


def test_an_effect_that_is_no_curve_over_what_it_follows_is_drawn_as_points():
    # A joined curve is one path; points are as many uses of a mark.
    joined, scattered = (drawn_shape(j).count("<use ") for j in (True, False))
    assert scattered - joined >= sample_gap_data().shapes[0].x.size


def test_rounds_start_from_the_baseline_refitted_unless_it_is_held():
    document = sample_gap_document()
    assert "refitted" in gap_by_round(document)
    assert "refitted" not in gap_by_round({**document, "baseline": {"terms": [], "fixed": True}})


def test_names_of_many_rounds_do_not_run_into_each_other():
    document = sample_gap_document()
    few = gap_by_round(document)
    many = gap_by_round({**document, "rounds": 3 * document["rounds"]})
    assert "rotate(-28" in many
    assert "rotate(-28" not in few


def test_a_model_that_agrees_only_when_refitted_is_not_said_to_agree_as_it_is():
    document = sample_gap_document()
    document |= {"rounds": [], "verdict": "agrees", "noise_percent": 1.3, "final_gap_percent": 1.3}
    refitted = gap_lines(document)[0]
    assert "with the model's own coefficients refitted" in refitted
    as_it_is = gap_lines({**document, "gap_percent": 1.3})[0]
    assert as_it_is.endswith("agree within the noise; nothing is missing.")


def test_the_worst_test_stands_beside_the_pooled_gap():
    document = sample_gap_document()
    quiet = {"file": "slow.csv", "held_out": False, "gap_before_percent": 9.0}
    quiet |= {"gap_after_percent": 1.5, "noise_percent": 1.0}
    loud = {**quiet, "file": "fast.csv", "gap_after_percent": 4.0, "noise_percent": 4.0}
    document |= {"verdict": "closed", "records": [loud, quiet]}
    verdict, gap = (s for s in gap_lines(document) if s.startswith(("Verdict", "Gap")))
    assert "the gap over all tests is down to 1.1 times the noise" in verdict
    assert gap.endswith("; of single tests slow.csv is worst, 1.5 times its noise.")
    alone = " ".join(gap_lines({**document, "records": [loud], "final_gap_percent": 1.11}))
    assert "worst" not in alone and "the gap is down to the noise" in alone


def test_an_effect_whose_size_may_be_zero_is_said_to_be_so():
    document = sample_gap_document()
    document["rounds"] = [{**document["rounds"][0], "interval": [-3.0, 20.0]}]
    (missing,) = (s for s in gap_lines(document) if s.startswith("Missing"))
    assert "its size is not told from zero" in missing
    document["rounds"] = [{**document["rounds"][0], "interval": [3.0, 20.0]}]
    assert "told from zero" not in " ".join(gap_lines(document))
