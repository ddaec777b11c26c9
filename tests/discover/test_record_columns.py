"""Columns of the table of records: one list for the report and for records.csv."""

from dataclasses import replace

from markupsafe import escape

from discover.report.record_columns import COLUMNS, shown_columns
from tests.discover.sample_study import sample_data

(RECORD,) = (r for r in sample_data().records if r.file == "2hz-10mm.csv")
BY_NAME = {column.name: column for column in COLUMNS}


def test_names_are_unique():
    assert len(BY_NAME) == len(COLUMNS)


def test_a_cell_is_told_in_the_unit_that_suits_it_and_its_value_is_si():
    told = {n: BY_NAME[n].cell(RECORD) for n in ("amplitude", "frequency", "kind", "dean_paper")}
    assert told == {
        "amplitude": "10 mm", "frequency": "2 Hz", "kind": "sine, held out", "dean_paper": "100",
    }  # fmt: skip
    assert [BY_NAME[n].value(RECORD) for n in ("amplitude", "held_out", "band")] == [0.01, True, 2]


def test_what_no_record_has_is_not_shown_and_what_one_lacks_is_a_dash():
    bare = replace(RECORD, frequency=None, dean_paper=None, structure="")
    assert {c.name for c in shown_columns([RECORD])} - {c.name for c in shown_columns([bare])} == {
        "frequency", "dean_paper",
    }  # fmt: skip
    assert BY_NAME["frequency"] in shown_columns([bare, RECORD])
    assert [BY_NAME[n].cell(bare) for n in ("frequency", "dean_paper", "structure")] == ["–"] * 3


def test_a_file_s_name_is_no_html():
    named = replace(RECORD, file="<b>.csv")
    assert escape(BY_NAME["file"].cell(named)) == "<code>&lt;b&gt;.csv</code>"
