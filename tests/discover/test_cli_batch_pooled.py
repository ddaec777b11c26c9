import csv
import io
import json

import pyarrow.parquet
import pytest

from discover.cli import main
from tests.discover.batch.made_fleet import make_device
from tests.undrawn import blank_pictures

ORDERS = {"d0": 0.57, "d1": 0.60, "d2": 0.63, "thin": 0.61}


@pytest.fixture(scope="module")
def fleet(tmp_path_factory):
    """Three devices with fair tests and one with two tests, drowned in noise."""
    folder = tmp_path_factory.mktemp("fleet")
    for seed, (name, order) in enumerate(ORDERS.items()):
        thin = name == "thin"
        make_device(
            folder / name, order, noise=1.0 if thin else 0.1, amplitudes=(0.01,), seed=seed,
            frequencies=(1.0, 2.0) if thin else (0.5, 1.4, 4.0),
        )  # fmt: skip
    return folder


def content(folder):
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


@pytest.fixture(scope="module")
def results(fleet, tmp_path_factory):
    """The files of a batch: not pooled, then pooled, then not pooled again."""
    out = tmp_path_factory.mktemp("out") / "batch"
    found = []
    for options in ([], ["--pooled"], []):
        with blank_pictures():
            assert main(["batch", str(fleet), "-o", str(out), *options]) == 0
        found.append(content(out))
    return found


def of_orders(files):
    rows = csv.DictReader(io.StringIO(files["pooled.csv"].decode()))
    return {r["campaign"]: r for r in rows if r["quantity"] == "order of fractional derivative"}


def ends(row, which):
    return float(row[f"{which}_lower95"]), float(row[f"{which}_upper95"])


@pytest.mark.slow
def test_pooled_orders_hold_the_truth_and_the_thin_device_gains(results):
    rows = of_orders(results[1])
    assert set(rows) == set(ORDERS)
    for name, row in rows.items():
        (low, high), (first, last) = ends(row, "pooled"), ends(row, "alone")
        assert low <= ORDERS[name] <= high
        assert high - low < 1.02 * (last - first)
    low, high = ends(rows["thin"], "pooled")
    first, last = ends(rows["thin"], "alone")
    assert high - low < 0.8 * (last - first)


@pytest.mark.slow
def test_without_the_option_nothing_is_otherwise(results):
    before, pooled, after = results
    assert before == after
    assert set(pooled) - set(before) == {"pooled.csv", "pooled.parquet"}
    assert all(before[name] == pooled[name] for name in ("table.csv", "table.parquet"))
    document = json.loads(pooled["batch.json"])
    assert document.pop("pooling")["quantities"]
    assert document == json.loads(before["batch.json"])


@pytest.mark.slow
def test_both_tables_and_the_document_hold_the_same(results):
    files = results[1]
    parquet = pyarrow.parquet.read_table(io.BytesIO(files["pooled.parquet"])).to_pylist()
    text = list(csv.DictReader(io.StringIO(files["pooled.csv"].decode())))
    assert [r["pooled"] for r in parquet] == [float(r["pooled"]) for r in text]
    pooling = json.loads(files["batch.json"])["pooling"]
    told = [v["pooled"]["value"] for q in pooling["quantities"] for v in q["values"]]
    assert told == [r["pooled"] for r in parquet if r["kind"] != "probability"]
    chances = [r for r in parquet if r["kind"] == "probability"]
    assert {r["quantity"] for r in chances} >= {"structure of the only band: FOIM"}
    assert b"What pooling changed" in files["report.html"]


def test_one_device_has_no_others_to_hear(fleet, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["batch", str(fleet / "thin"), "-o", str(out), "--pooled"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == "inerter: --pooled: campaigns must be two or more, got one"
    assert not out.exists()
