"""What a notebook and a script see of an answer."""

import json
from dataclasses import replace
from xml.etree import ElementTree

import pytest

import discover
from discover.gap import close_gap
from discover.study import run_study
from models.checks import InputError
from tests.discover.exact import DEVICE_12, campaign, integer


@pytest.fixture(scope="module")
def measured():
    force = integer(370.4, 3913.0, 6000.0, 0.0, 400.0)
    return campaign(force, frequencies=(0.5, 1.5, 4.0), amplitudes=(0.005, 0.02), held_out=(3,))


@pytest.fixture(scope="module")
def study(measured):
    return run_study(measured)


@pytest.fixture(scope="module")
def gap(measured):
    return close_gap(
        measured, "fit:inertia,viscous-damping,coulomb-friction", effects=["quadratic-damping"]
    )


def test_a_study_shows_its_answer_briefly_in_sentences_and_as_a_page_of_a_notebook(study):
    headline = study.to_dict()["headline"]
    assert repr(study) == f"<Study of 'exact records': {headline}>"
    assert study.summary().startswith(f"Verdict: {headline}.\n")
    html = study._repr_html_()
    assert headline in html
    assert "<td>inertance</td>" in html


def test_a_study_as_a_table_has_a_row_for_every_term_with_its_interval(study):
    frame = study.to_frame()
    (inertia,) = frame[frame["term"] == "inertia"].to_dict("records")
    assert inertia["coefficient"] == pytest.approx(370.4, rel=0.02)
    assert inertia["lower"] < inertia["coefficient"] < inertia["upper"]
    assert (inertia["band"], inertia["unit"]) == (1, "kg")
    assert len(frame) == sum(len(b.terms) for b in study.bands)


def test_a_study_comes_back_from_its_file_as_it_was_but_for_its_pictures(study, tmp_path):
    path = tmp_path / "study.json"
    study.save(path)
    again = discover.load_study(path)
    assert again.to_dict() == json.loads(json.dumps(study.to_dict()))
    assert again.model.to_dict() == study.model.to_dict()
    with pytest.raises(InputError, match="run the study again"):
        _ = again.figure_data


def test_a_file_that_holds_no_study_is_refused_with_what_was_found(study, tmp_path):
    path = tmp_path / "study.json"
    with pytest.raises(InputError, match=r"study\.json"):
        discover.load_study(path)
    path.write_text('{"schema": "inerter.gap/1"}')
    with pytest.raises(InputError, match=r"inerter\.gap/1"):
        discover.load_study(path)
    study.save(path)
    document = json.loads(path.read_text())
    del document["bands"][0]["terms"][0]["interval"]
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match="interval"):
        discover.load_study(path)


def test_a_gap_shows_its_answer_briefly_in_sentences_and_as_a_table(gap, tmp_path):
    assert repr(gap).startswith("<Gap of 'exact records': closed, quadratic-damping, gap ")
    assert "Missing: quadratic damping" in gap.summary()
    assert "<td>quadratic damping, v|v|</td>" in gap._repr_html_()
    frame = gap.to_frame().set_index("term")
    assert frame.loc["quadratic-damping", "added"]
    assert not frame.loc["inertia", "added"]
    assert frame.loc["quadratic-damping", "coefficient"] == pytest.approx(6000.0, rel=0.05)
    gap.save(tmp_path / "gap.json")
    assert json.loads((tmp_path / "gap.json").read_text())["verdict"] == "closed"


def test_public_names_are_there_for_tab_completion():
    names = dir(discover)
    assert {"read_campaign", "run_study", "close_gap", "load_study", "StudyOptions"} <= set(names)
    assert all(getattr(discover, n) is not None for n in discover.__all__)


def test_a_study_predicts_other_records_as_well_as_it_says(study, measured):
    found = study.predict(measured)
    (model,) = found.models
    assert model.relative_percent(held_out=True) == pytest.approx(
        study.held_out_relative_error_percent, rel=1e-6
    )
    assert repr(found).startswith("<Forces on 6 records of 'exact records', error: study ")
    errors = found.to_frame()
    assert errors["held_out"].tolist() == [r.held_out for r in measured.records]
    samples = found.forces()[measured.records[0].file]
    assert list(samples) == [
        "time [s]", "displacement [m]", "velocity [m/s]", "force [N]", "study [N]"
    ]
    alone = study.predict(measured.records[0]).to_frame()
    assert alone["error_percent"][0] == pytest.approx(errors["error_percent"][0])
    with pytest.raises(InputError, match="reads one, got a path"):
        study.predict("folder")


def test_a_study_draws_its_pictures_by_name(study, measured, tmp_path):
    assert repr(study.plot) == "<Pictures of a study: map(), probabilities(), errors(), loops()>"
    for name in ("map", "probabilities", "errors", "loops"):
        picture = getattr(study.plot, name)()
        assert picture._repr_html_().count("<svg") == len(picture.drawings) > 0
    one = study.plot.loops(measured.records[2].file)
    assert measured.records[2].file in one.drawings[0]
    written = study.plot.loops().save(tmp_path / "loops.svg")
    assert [f.name for f in written][:2] == ["loops.svg", "loops-2.svg"]
    assert all(ElementTree.parse(f).getroot().tag.endswith("svg") for f in written)
    with pytest.raises(InputError, match="record must be one of"):
        study.plot.loops("none")
    with pytest.raises(InputError, match=r"path must be a name that ends in \.svg"):
        one.save(tmp_path / "loops.jpg")


def test_a_notebook_shows_a_study_s_map_where_records_are_at_hand(study, tmp_path):
    assert "<svg" in study._repr_html_()
    study.save(tmp_path / "study.json")
    assert "<svg" not in discover.load_study(tmp_path / "study.json")._repr_html_()


def test_a_gap_draws_its_pictures_by_name(gap):
    assert repr(gap.plot) == (
        "<Pictures of a gap: records(), rounds(), contests(), shapes(), surface(), loops()>"
    )
    assert gap.plot.records().drawings[0].startswith("<svg")
    assert gap.plot.rounds().drawings[0].startswith("<svg")


def test_a_study_in_place_of_its_model_is_told_from_it(study, measured):
    with pytest.raises(InputError, match=r"model must be .* `study\.model` is one"):
        discover.close_gap(measured, study)


def test_what_is_printed_fits_on_a_screen(study, gap, measured):
    check = discover.check_campaign(measured)
    for value in (
        study, gap, measured, measured.records[0], study.plot, study.predict(measured), check,
        study.figure_data, study.figure_data.records[0], gap.figure_data,
    ):  # fmt: skip
        assert len(repr(value)) < 400
        assert "array(" not in repr(value)


def test_a_model_is_taken_by_name_or_file_as_the_command_takes_it(study, measured, tmp_path):
    path = tmp_path / "model.json"
    path.write_text(json.dumps(study.model_dict()))
    known = replace(measured, device=DEVICE_12)
    effects = ["force-offset"]
    (inertia, *_) = discover.close_gap(known, "ioim-laminar", effects=effects, fixed=True).baseline
    assert inertia.coefficient == pytest.approx(370.38, rel=1e-3)
    again = discover.close_gap(measured, str(path), effects=effects)
    assert again.verdict == "agrees"
    with pytest.raises(InputError, match="ioim-laminar must be used with a device"):
        discover.close_gap(replace(measured, device=None), "ioim-laminar", effects=effects)


def test_friction_of_several_curves_is_one_row_in_a_notebook(study):
    curves = [t for t in study.bands[0].terms if t.fitted.id == "coulomb-friction"]
    row = "<td>Coulomb friction, sign\u00a0v</td>"
    assert study._repr_html_().count(row) == min(len(curves), 1)


def test_a_campaign_and_its_check_show_every_record_in_a_notebook(measured):
    check = discover.check_campaign(measured)
    for value in (measured, check):
        tree = ElementTree.fromstring(value._repr_html_())
        cells = [row[0].text for row in tree.iterfind("./table[2]/tbody/tr")]
        assert cells == [r.file for r in measured.records]
    assert "exact records" in measured._repr_html_() and "held out" in measured._repr_html_()
    assert ("Passed" in check._repr_html_()) == check.passed
    for finding in check.findings:
        assert finding.level.capitalize() in check._repr_html_()


def test_what_a_notebook_shows_of_a_campaign_is_text_and_not_markup():
    time = [0.01 * i for i in range(200)]
    frame = {"time": time, "displacement": [t * t for t in time], "force": [5.0 - t for t in time]}
    shown = discover.Campaign.from_frames({"<b>1</b>": frame}, title="a < b")._repr_html_()
    assert "a &lt; b" in shown and "<b>" not in shown


def test_what_python_prints_fits_on_a_screen(measured, study, gap):
    values = (measured, measured.records[0], study, gap, discover.check_campaign(measured))
    assert all(len(repr(v)) <= 400 and "\n" not in repr(v) for v in values)
