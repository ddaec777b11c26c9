import numpy as np
import pytest

from discover.batch.answer import Answer
from discover.batch.document import batch_document
from discover.batch.pooled_table import POOLED_COLUMNS, pooled_rows
from discover.batch.table import table_rows
from discover.report.batch import batch_lines, batch_report
from discover.words import THIN_SPACE


def study(order, error, *, sure=0.99, boundary=(90.0, 110.0), turns=1e-3):
    """Return a study of two bands; `sure` is the probability of FOIM in the lower one."""

    def band(lower, upper, core, chance, terms):
        others = [{"structure": "IOIM-linear", "probability": 1.0 - chance}]
        return {
            "lower": lower, "upper": upper, "records": ["a.csv"], "structure": core,
            "probability": chance, "relative_error_percent": 2.0, "noise_percent": 1.9,
            "remainder_percent": {"value": 0.1, "interval": [0.0, 0.2]}, "extras": [],
            "equivalents": [{"structure": core, "probability": chance},
                            *(o for o in others if o["probability"] >= 0.05)],
            "friction": {"curve": "in words", "transition_speed": turns, "probability": 0.9,
                         "transition_speed_interval": [turns / 1.41, turns * 1.41]},
            "terms": terms,
        }  # fmt: skip

    middle = float(np.sqrt(boundary[0] * boundary[1]))
    fractional = {
        "id": "fractional-derivative", "coefficient": 5.0, "unit": "N s^0.5/m",
        "interval": [4.0, 6.0], "order": order,
        "order_interval": [max(order - 1.96 * error, 0.0), order + 1.96 * error],
    }  # fmt: skip
    inertia = {"id": "inertia", "coefficient": 370.0, "unit": "kg", "interval": [360.0, 380.0]}
    return {
        "campaign": {"title": "device", "hash": "hash"}, "coordinate": "dean",
        "identifiable": True, "relative_error_percent": 2.0, "headline": "two bands",
        "dean_check": {"verdict": "consistent"}, "boundaries": [{"interval": list(boundary)}],
        "bands": [
            band(None, middle, "FOIM", sure, [fractional]),
            band(middle, None, "IOIM-laminar", 0.99, [inertia]),
        ],
    }  # fmt: skip


@pytest.fixture
def studies():
    fleet = {f"d{i}": study(0.5 + 0.01 * i, 0.004) for i in range(6)}
    fleet["thin"] = study(0.8, 0.3, sure=0.6, boundary=(40.0, 220.0))
    return fleet


def documented(studies):
    answers = [Answer(name, name, s) for name, s in studies.items()]
    rows = table_rows(answers)
    return batch_document(answers, rows, seed=0, model=None, pool=True), rows


def found(pooling, kind, campaign):
    (q,) = [q for q in pooling["quantities"] if q["kind"] == kind and "friction" not in q["name"]]
    (value,) = [v for v in q["values"] if v["campaign"] == campaign]
    return value["alone"], value["pooled"]


def width(told):
    return told["upper"] - told["lower"]


def test_a_thin_device_gains_in_order_boundary_and_structure(studies):
    pooling = documented(studies)[0]["pooling"]
    orders = {**pooling, "quantities": [q for q in pooling["quantities"] if q["unit"] == ""]}
    for kind, share in (("shape", 0.3), ("boundary", 0.5)):
        alone, pooled = found(orders, kind, "thin")
        assert width(pooled) < share * width(alone)
        alone, pooled = found(orders, kind, "d0")
        assert width(pooled) < 1.02 * width(alone)
    assert found(orders, "shape", "thin")[1]["value"] == pytest.approx(0.53, abs=0.04)
    (choice,) = [c for c in pooling["choices"] if c["name"] == "structure of band 1 of 2"]
    (thin,) = [v for v in choice["values"] if v["campaign"] == "thin"]
    chances = {w["way"]: w for w in thin["ways"]}
    assert chances["FOIM"]["alone"] == 0.6
    assert chances["FOIM"]["pooled"] > 0.9
    assert sum(w["pooled"] for w in thin["ways"]) == pytest.approx(1.0)


def test_a_device_that_surely_differs_stays(studies):
    studies["other"] = study(1.4, 0.004, boundary=(400.0, 420.0))
    pooling = documented(studies)[0]["pooling"]
    orders = {**pooling, "quantities": [q for q in pooling["quantities"] if q["unit"] == ""]}
    alone, pooled = found(orders, "shape", "other")
    assert abs(pooled["value"] - alone["value"]) < 0.1 * 0.004
    alone, pooled = found(orders, "boundary", "other")
    assert 400.0 <= pooled["lower"] < pooled["upper"] <= 420.0


def test_a_value_stays_within_what_its_term_allows(studies):
    studies = {name: study(0.02, 0.03) for name in ("a", "b", "c")}
    pooling = documented(studies)[0]["pooling"]
    orders = {**pooling, "quantities": [q for q in pooling["quantities"] if q["unit"] == ""]}
    assert found(orders, "shape", "a")[1]["lower"] >= 0.0


def test_the_table_has_a_row_for_each_device_and_quantity(studies):
    pooling = documented(studies)[0]["pooling"]
    rows = pooled_rows(pooling)
    assert all(list(r) == list(POOLED_COLUMNS) for r in rows)
    numbers = [r for r in rows if r["kind"] != "probability"]
    assert len(numbers) == 7 * len(pooling["quantities"])
    assert {r["quantity"] for r in numbers} == {
        "dean", "order of fractional derivative", "fractional derivative", "inertance",
        "speed that friction turns over",
    }  # fmt: skip


def test_page_and_lines_tell_what_changed(studies):
    document, rows = documented(studies)
    page = batch_report(document, rows, command="inerter batch fleet -o out --pooled")
    assert "What pooling changed" in page
    pictures = len(document["quantities"]) + len(document["pooling"]["quantities"])
    assert page.count("<svg") == pictures
    (line,) = [one for one in batch_lines(document) if one.startswith("Pooled probabilities")]
    assert "thin, structure of band 1 of 2: FOIM 60 % to" in line.replace(THIN_SPACE, " ")


def test_without_pooling_page_and_document_do_not_speak_of_it(studies):
    answers = [Answer(name, name, s) for name, s in studies.items()]
    rows = table_rows(answers)
    document = batch_document(answers, rows, seed=0, model=None)
    assert "pooling" not in document
    assert "pooling" not in batch_report(document, rows, command="inerter batch fleet -o out")


def test_where_one_device_was_studied_nothing_is_pooled_and_it_is_told(studies):
    answers = [Answer("d0", "d0", studies["d0"]), Answer("bad", "bad", None, error="no force")]
    rows = table_rows(answers)
    document = batch_document(answers, rows, seed=0, model=None, pool=True)
    assert document["pooling"] == {"quantities": [], "choices": []}
    assert "Pooled: nothing: no two devices that were studied have an answer in common." in (
        batch_lines(document)
    )
    assert "Nothing: no two devices" in batch_report(document, rows, command="inerter batch x")
