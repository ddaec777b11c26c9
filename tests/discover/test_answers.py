"""What a notebook and a script see of an answer."""

import json

import pytest

import discover
from discover.gap import close_gap
from discover.study import run_study
from models.checks import InputError
from tests.discover.exact import campaign, integer


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
