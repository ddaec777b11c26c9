import csv
import io

import pyarrow.parquet
import pytest

from discover.batch.answer import Answer
from discover.batch.document import batch_document
from discover.batch.table import COLUMNS, table_files, table_rows
from discover.report.batch import batch_lines, batch_report


def study(inertance, boundary, *, title="device"):
    def band(lower, upper, structure, value):
        return {
            "lower": lower, "upper": upper, "records": ["a.csv"], "structure": structure,
            "probability": 0.99, "relative_error_percent": 2.0, "noise_percent": 1.9,
            "remainder_percent": {"value": 0.1, "interval": [0.0, 0.2]}, "extras": [],
            "terms": [
                {"id": "inertia", "coefficient": value, "unit": "kg",
                 "interval": [value - 2.0, value + 2.0]},
                {"id": "fractional-derivative", "coefficient": 5.0, "unit": f"N s^{value:g}/m",
                 "interval": [4.0, 6.0], "order": 0.5, "order_interval": [0.45, 0.55]},
            ],
        }  # fmt: skip

    return {
        "campaign": {"title": title, "hash": f"hash of {title}"},
        "coordinate": "dean", "identifiable": True, "relative_error_percent": 2.0,
        "headline": "two bands", "dean_check": {"verdict": "consistent"},
        "boundaries": [{"interval": [0.9 * boundary, boundary / 0.9]}],
        "bands": [
            band(None, boundary, "FOIM", inertance), band(boundary, None, "IOIM-linear", inertance)
        ],
    }  # fmt: skip


@pytest.fixture
def answers():
    values = [100.0, 101.0, 99.0, 100.5, 99.5, 160.0]
    fleet = [
        Answer(f"d{i}", f"fleet/d{i}", study(v, 90.0 + i, title=f"d{i}"))
        for i, v in enumerate(values)
    ]
    return [*fleet, Answer("bad <one>", "bad", None, error="force must be there, got none")]


def test_each_term_of_each_band_has_a_row_and_each_failure_one(answers):
    rows = table_rows(answers)
    assert len(rows) == 6 * 4 + 1
    assert all(list(r) == list(COLUMNS) for r in rows)
    assert rows[-1]["error"] == "force must be there, got none"
    assert rows[-1]["term"] is None


def test_csv_and_parquet_hold_the_same_numbers_to_the_last_digit(answers):
    files = table_files(table_rows(answers))
    parquet = pyarrow.parquet.read_table(io.BytesIO(files["table.parquet"])).to_pylist()
    text = list(csv.DictReader(io.StringIO(files["table.csv"].decode())))
    assert [r["coefficient"] for r in parquet] == [
        float(r["coefficient"]) if r["coefficient"] else None for r in text
    ]
    assert [r["campaign"] for r in parquet] == [r["campaign"] for r in text]


def test_the_one_device_that_differs_stands_apart_in_its_inertance(answers):
    rows = table_rows(answers)
    document = batch_document(answers, rows, seed=0, model=None)
    assert {(o["campaign"], o["name"]) for o in document["outliers"]} == {("d5", "inertance")}
    means = [q["mean"] for q in document["quantities"] if q["name"] == "inertance"]
    assert means == pytest.approx([100.0, 100.0])  # of the others


def test_coefficients_of_different_units_are_not_compared(answers):
    document = batch_document(answers, table_rows(answers), seed=0, model=None)
    names = {q["name"] for q in document["quantities"]}
    assert "order of fractional derivative" in names
    assert "fractional derivative" not in names


def test_the_shared_boundary_lies_among_the_devices(answers):
    document = batch_document(answers, table_rows(answers), seed=0, model=None)
    (boundary,) = [q for q in document["quantities"] if q["kind"] == "boundary"]
    assert len(boundary["values"]) == 6
    assert 90.0 < boundary["mean"] < 95.0
    assert boundary["spread"] == 0.0  # they differ by less than their intervals are wide


def test_the_page_links_every_device_and_tells_every_failure(answers):
    rows = table_rows(answers)
    document = batch_document(answers, rows, seed=0, model=None)
    page = batch_report(document, rows, command="inerter batch fleet -o out")
    for i in range(6):
        assert f'href="d{i}/report.html"' in page
    assert "bad &lt;one&gt;" in page
    assert "force must be there, got none" in page
    assert page.count("<svg") == len(document["quantities"])
    assert batch_lines(document)[0] == "Fleet: 6 of 7 campaigns studied, 1 failed."
