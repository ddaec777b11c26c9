import base64
import copy
import hashlib
import re
from html.parser import HTMLParser

import pytest

from discover.figure_data import StudyFigureData
from discover.report.study import study_figures, study_report
from discover.study.verdict import (
    dean_line,
    headline,
    next_purpose,
    structure_name,
    verdict_lines,
)
from tests.discover.sample_study import sample_data, sample_document

VOID = {"meta", "br", "path", "use", "rect"}


class Page(HTMLParser):
    """Collects text, ids and addresses; fails on tags that do not close."""

    def __init__(self, html):
        super().__init__()
        self.open, self.ids, self.addresses, self.words, self.tags = [], [], [], [], []
        self.feed(html)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        values = dict(attrs)
        if "id" in values:
            self.ids.append(values["id"])
        self.addresses += [values[k] for k in ("src", "href", "xlink:href") if k in values]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


def report(document=None, data=None, command="inerter discover rig --seed 0"):
    document = document or sample_document()
    data = data or sample_data()
    return study_report(document, data, study_figures(document, data), command=command)


@pytest.fixture(scope="module")
def html():
    return report()


@pytest.fixture(scope="module")
def page(html):
    return Page(html)


def test_page_is_well_formed_and_ids_are_unique(page):
    assert page.open == []
    assert len(page.ids) == len(set(page.ids)) > 50


def test_page_loads_nothing_from_anywhere(page):
    assert page.addresses
    assert all(a.startswith("#") for a in page.addresses)
    assert not {"link", "img", "iframe"} & set(page.tags)


def test_the_only_script_is_the_one_that_the_page_lets_run(page, html):
    assert page.tags.count("script") == 1
    script = html[html.index("<script>") + len("<script>") : html.index("</script>")]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}'" in html


def test_every_reference_inside_a_picture_has_its_target(page, html):
    targets = set(re.findall(r'(?:href="|url\()#([^")]+)', html))
    assert targets <= set(page.ids)


def test_verdict_stands_before_everything_else(page):
    text = page.text
    assert text.index("FOIM of order 1.48 below 98") < text.index("Where each structure holds")


def test_page_carries_each_part(page):
    for part in (
        "Coefficients",
        "Measured beside model",
        "Dean check",
        "What other methods say",
        "STLSQ",
        "What to know",
        "What to do next",
        "inerter discover rig --seed 0",
        "98 (paper convention), 34.6 (standard convention)",
        "The boundary lies at a Dean number that holds 100.",
        "Beside the structure",
        "cubic stiffness (6 %)",
        "left over beyond noise: 0.52 % (0.31 to 0.68 %)",
        "402 N (394 to 410), deflects over 0.05 mm before it slides (0.04 to 0.06 mm)",
    ):
        assert part in page.text


def test_the_error_of_other_methods_is_named_as_another_measure_than_the_verdict_s(page):
    _, section = page.text.split("What other methods say")
    section, _ = section.split("What to know")
    assert "another measure than the verdict's" in section
    assert "‖e‖/‖F‖ over the lines" in section


def test_text_of_a_campaign_is_escaped_in_page_and_pictures():
    document, data = sample_document(), sample_data()
    document["campaign"]["title"] = "<script>alert(1)</script> & $x^2$"
    page = Page(report(document, data, command="inerter discover '<b>'"))
    assert page.tags.count("script") == 1
    assert "b" not in page.tags
    assert "<script>alert(1)</script> & $x^2$" in page.text


@pytest.mark.usefixtures("undrawn")
def test_a_study_without_device_plan_or_probabilities_still_reports():
    document = sample_document()
    document["coordinate"] = "speed"
    document["bands"] = [copy.deepcopy(document["bands"][1])]
    document["bands"][0] |= {
        "lower": None,
        "upper": None,
        "lower_hz": None,
        "upper_hz": None,
        "probability": None,
        "noise_percent": None,
    }
    document |= {"boundaries": [], "nuisance": [], "findings": [], "next_test": None}
    document["dean_check"] = {"convention": "paper", "criterion": 100.0, "verdict": "no-geometry"}
    page = Page(report(document, StudyFigureData(records=())))
    assert "Dean" not in page.text
    assert "no plan of frequencies and amplitudes to map" in page.text
    assert "Measured beside model" not in page.text


def test_verdict_says_in_each_line_one_thing_and_names_the_convention():
    lines = {
        line.split(":")[0]: line.replace("\u202f", " ") for line in verdict_lines(sample_document())
    }
    assert list(lines) == [
        "Verdict",
        "Values",
        "Beside it",
        "Friction",
        "Accuracy",
        "Left over",
        "Certainty",
        "Dean check",
        "Next test",
    ]
    assert lines["Beside it"] == (
        "Beside it: stiffness 1 210 N/m (1 190 to 1 230), 93 % sure, or cubic stiffness (6 %)."
    )
    assert "it differs between records by 2.1 %" in lines["Friction"]
    assert ": a displacement and not a speed, 98 %" in lines["Friction"]
    assert "0.52 % (0.31 to 0.68 %) in band 1" in lines["Left over"]
    assert "98 (84 to 117), paper convention, criterion 100" in lines["Dean check"]
    assert "IOIM-linear (17 %) not ruled out" in lines["Certainty"]


def test_what_friction_turns_over_is_said_as_surely_as_it_is_told():
    document = sample_document()
    document["bands"][0]["friction"]["probability"] = 0.54
    lines = "".join(verdict_lines(document)).replace("\u202f", " ")
    assert ": a displacement rather than a speed, 54 %" in lines


def test_headline_is_one_sentence_with_structures_boundary_and_dean_verdict():
    document = sample_document()
    assert headline(document) == (
        "two bands of Dean number (paper convention): FOIM of order 1.48 below 98 and IOIM-laminar"
        " above 98, with presliding and stiffness (boundary 84 to 117); Dean criterion"
        " 100: the boundary agrees with it"
    )


def test_headline_says_that_something_else_is_in_the_force_where_much_is_left():
    document = sample_document()
    document["bands"][1]["remainder_percent"] = {"value": 7.04, "interval": [6.0, 8.0]}
    assert headline(document).endswith("; the best so far, 7.04\u202f% of the force is unexplained")


def test_where_no_test_tells_structures_apart_what_is_unexplained_is_said_to_be_in_none():
    document = sample_document() | {"next_test": None, "identifiable": True}
    said = "Next test: none; no pair of structures is left to tell apart."
    assert verdict_lines(document)[-1] == said
    document["bands"][1]["remainder_percent"] = {"value": 7.04, "interval": [6.0, 8.0]}
    assert verdict_lines(document)[-1] == said + " What is unexplained is in none of them."


def test_headline_does_not_state_a_structure_that_may_well_be_another():
    document = sample_document()
    document["bands"][0]["probability"] = 0.79
    said = headline(document)
    assert "undetermined: FOIM or IOIM-linear below 98 and IOIM-laminar above 98" in said
    document["bands"] = document["bands"][:1]
    document["dean_check"] = {"criterion": 100.0, "verdict": "no-geometry"}
    assert headline(document) == (
        "undetermined: FOIM or IOIM-linear, with presliding and stiffness in all 19 fitted records"
    )
    del document["held_out_relative_error_percent"]
    assert headline(document).endswith("in all 19 records")


def test_what_may_as_well_be_nothing_is_possible_only_and_not_in_the_headline():
    document = sample_document()
    for band in document["bands"]:
        for extra in band["extras"]:
            extra["interval"] = [-20.0, 2400.0]
    assert "with presliding (boundary 84 to 117)" in headline(document)
    assert "Beside it: possibly stiffness" in "".join(verdict_lines(document))


@pytest.mark.parametrize(("effect", "unit", "many", "few"), [
    ("force-offset", "N", "force offset −240 to −237 N in 4 tests, each its own, 97",
     "force offset −240 N (−241 to −239), in test 1 only; −237 N"),
    ("sensor-gain", "1", "sensor gain −240 to −237 in 4 tests, each its own, 97",
     "sensor gain −240 (−241 to −239), in test 1 only; −237 (−238"),
])  # fmt: skip
def test_values_of_many_tests_are_told_by_their_range(effect, unit, many, few):
    document = sample_document()
    own = [
        {"id": effect, "coefficient": v, "unit": unit, "interval": [v - 1.0, v + 1.0],
         "only": float(k), "probability": 0.97, "alternatives": []}
        for k, v in enumerate((-240.0, -237.0, -239.0, -238.5), start=1)
    ]  # fmt: skip
    for count, told in ((4, many), (2, few)):
        for band in document["bands"]:
            band["extras"] = own[:count]
        assert told in "\n".join(verdict_lines(document))


def test_how_friction_reverses_is_not_told_of_friction_that_may_be_none():
    document = sample_document()
    for band in document["bands"]:
        for term in band["terms"]:
            if term["id"] == "coulomb-friction":
                term["interval"] = [0.0, 0.3]
    assert "presliding" not in headline(document)
    lines = "\n".join(verdict_lines(document))
    assert "Friction: not told from zero, at most 0.3 N." in lines
    assert "slides" not in lines


def test_friction_of_several_curves_is_told_whole_with_its_interval():
    document = sample_document()
    parts = [
        {"id": "coulomb-friction", "unit": "N", "coefficient": size, "transition_speed": speed,
         "interval": [0.9 * size, 1.1 * size]}
        for size, speed in ((18.0, 0.024), (2.0, 0.001))
    ]  # fmt: skip
    for band in document["bands"]:
        band["terms"] = [t for t in band["terms"] if t["id"] != "coulomb-friction"] + parts
    assert "Friction: 20 N (18 to 22)" in "\n".join(verdict_lines(document))


def test_terms_that_were_asked_for_are_values_and_what_stands_beside_is_told_once():
    document = sample_document()
    band = document["bands"][0]
    ids = [t["id"] for t in band["terms"]]
    assert {"stiffness", "coulomb-friction"} <= set(ids)
    document["bands"], band["extras"] = [band], []
    (line,) = (one for one in verdict_lines(document) if one.startswith("Values"))
    assert "stiffness 1 210 N/m" in line.replace("\u202f", " ")
    assert "friction" not in line
    band["extras"] = [t for t in band["terms"] if t["id"] == "stiffness"]
    for extra in band["extras"]:
        extra |= {"probability": 0.97, "alternatives": []}
    (line,) = (one for one in verdict_lines(document) if one.startswith("Values"))
    assert "stiffness" not in line


@pytest.mark.parametrize("verdict", ["consistent", "contradicted", "undetermined", "no-boundary"])
def test_dean_line_leads_with_the_verdict(verdict):
    document = sample_document()
    document["dean_check"]["verdict"] = verdict
    assert dean_line(document).startswith(f"Dean check: {verdict.replace('-', ' ')}: ")


def test_bands_of_one_structure_are_not_told_from_themselves():
    same = {"separates": ["FOIM", "FOIM"]}
    assert next_purpose(same) == "narrows the boundary between the bands of FOIM"
    assert next_purpose({"separates": ["FOIM", "other"]}) == "tells FOIM from other"
    assert next_purpose({}) == ""


def test_a_band_without_a_term_is_named_in_words():
    document = sample_document()
    (band, *_) = document["bands"]
    nothing = {"structure": "other", "terms": [], "extras": [], "friction": None}
    document["bands"] = [band | nothing]
    document["boundaries"] = []
    assert headline(document).startswith("none of the structures in all ")


def test_what_is_no_structure_is_named_by_what_is_told_from_nothing():
    damping = {"id": "viscous-damping", "interval": [2490.0, 2510.0]}
    friction = {"id": "stribeck-friction", "interval": [0.0, 9.1]}
    band = {"structure": "other", "probability": 0.9, "terms": [damping, friction]}
    assert structure_name(band) == "other (viscous damping)"
    told = {**band, "terms": [damping, {**friction, "interval": [2.0, 9.1]}]}
    assert structure_name(told) == "other (viscous damping and Stribeck friction)"
    assert structure_name({**band, "terms": [friction]}) == "other (Stribeck friction)"


@pytest.mark.usefixtures("undrawn")
def test_the_size_of_an_effect_in_one_test_may_be_zero():
    document = copy.deepcopy(sample_document())
    assert "zero not ruled out" not in report(document)
    for band in document["bands"]:
        unsure = {"coefficient": 1.0, "interval": [-1.0, 3.0]}
        band["extras"] = [{**extra, **unsure} for extra in band["extras"]]
    assert "zero not ruled out" in report(document)
    document = copy.deepcopy(sample_document())
    document["bands"][0]["terms"][-1] |= unsure
    assert report(document).count("zero not ruled out") == 1
