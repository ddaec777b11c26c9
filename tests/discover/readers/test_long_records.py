"""Records that are too long to be held, from their files."""

import hashlib

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest

from discover.readers import read_campaign
from discover.readers.long_record import FIRST, LONG
from models.checks import InputError

RATE = 1000.0
SIZE = LONG + 70_000


def written(folder, *, spoilt=None, size=SIZE, entry="", stamps=False):
    """Write a campaign of one sine test of 1.6 Hz, a group of rows at a time."""
    rng = np.random.default_rng(0)
    writer = None
    for first in range(0, size, 2**20):
        count = np.arange(first, min(first + 2**20, size))
        angle = 2.0 * np.pi * 1.6 * count / RATE
        time = pa.array(1_700_000_000_000_000 + 1000 * count, pa.timestamp("us"))
        columns = {
            "time": time if stamps else count / RATE,
            "displacement [mm]": 10.0 * np.sin(angle),
            "force [kN]": -0.3 * np.sin(angle) + 0.006 * rng.standard_normal(count.size),
        }
        if spoilt is not None and first <= spoilt < first + count.size:
            columns["force [kN]"][spoilt - first] = np.nan
        table = pa.table(columns)
        writer = writer or parquet.ParquetWriter(folder / "a.parquet", table.schema)
        writer.write_table(table)
    writer.close()
    text = f'[units]\ntime = "s"\n[[records]]\nfile = "a.parquet"\n{entry}'
    (folder / "campaign.toml").write_text(text if not stamps else text.partition("\n[units]")[0])
    return folder


def test_the_first_samples_are_held_and_all_are_read_in_pieces(tmp_path):
    campaign = read_campaign(written(tmp_path))
    (record,) = campaign.records
    assert record.time.size == FIRST
    assert record.samples == SIZE
    pieces = list(record.long.pieces())
    time = np.concatenate([p.time for p in pieces])
    np.testing.assert_allclose(time, np.arange(SIZE) / RATE, rtol=1e-12)
    place = np.concatenate([p.displacement for p in pieces])
    np.testing.assert_allclose(place[:FIRST], record.displacement, rtol=1e-12)
    assert np.abs(place).max() == pytest.approx(0.01, rel=1e-3)
    assert any("read in pieces" in f.text for f in campaign.findings)


def test_a_value_that_is_missing_far_inside_is_told_by_its_row(tmp_path):
    (record,) = read_campaign(written(tmp_path, spoilt=3_000_000)).records
    with pytest.raises(InputError, match="row 3000001"):
        list(record.long.pieces())


def test_time_stamps_count_from_the_first(tmp_path):
    (record,) = read_campaign(written(tmp_path, stamps=True)).records
    last = list(record.long.pieces())[-1]
    assert last.time[-1] == pytest.approx((SIZE - 1) / RATE, abs=1e-9)


def test_a_range_of_a_long_file_is_held(tmp_path):
    folder = written(tmp_path, entry='range = "3000 s : 3020 s"\n')
    (record,) = read_campaign(folder).records
    assert record.long is None
    assert record.time[0] == pytest.approx(3000.0, abs=1e-9)
    assert record.samples == 20_001


def test_the_hash_is_that_of_the_file(tmp_path):
    folder = written(tmp_path, size=5_000)
    digest = hashlib.sha256()
    for name in ("campaign.toml", "a.parquet"):
        data = (folder / name).read_bytes()
        digest.update(f"{name}\0{len(data)}\0".encode() + data)
    assert read_campaign(folder).content_hash == digest.hexdigest()
