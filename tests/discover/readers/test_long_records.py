"""Records that are too long to be held, from their files."""

import hashlib

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as parquet
import pytest

from discover.motion_fit import observe
from discover.readers import long_record, long_text, read_campaign, source
from discover.readers.formats import hdf5 as hdf5_module
from discover.readers.formats import parquet as parquet_module
from models.checks import InputError

RATE = 1000.0
SIZE = 300_000
FIRST = 40_000
KINDS = ("parquet", "h5", "csv")


@pytest.fixture(autouse=True)
def _short(monkeypatch):
    """Let records of 100,000 samples be long ones."""
    for module in (long_record, long_text, hdf5_module):
        monkeypatch.setattr(module, "LONG", 100_000)
    monkeypatch.setattr(long_record, "FIRST", FIRST)
    for module in (source, parquet_module):
        monkeypatch.setattr(module, "PIECE", 30_000)


def table(size=SIZE, *, sine=True):
    """Return the columns of a sine test of 1.6 Hz, or of random motion."""
    rng = np.random.default_rng(0)
    count = np.arange(size)
    angle = 2.0 * np.pi * 1.6 * count / RATE
    place = np.sin(angle)
    if not sine:
        lines = np.fft.rfft(rng.standard_normal(size))
        lines[size // 200 :] = 0.0
        place = np.fft.irfft(lines, n=size)
        place /= np.abs(place).max()
    force = -0.3 * place + 0.05 * np.gradient(place) * RATE / 10.0
    return {
        "time [s]": count / RATE,
        "displacement [mm]": 10.0 * place,
        "force [kN]": force + 0.006 * rng.standard_normal(size),
    }


def written(folder, kind, columns, entry=""):
    """Write a campaign of one record."""
    path = folder / f"a.{kind}"
    if kind == "h5":
        with h5py.File(path, "w") as file:
            for name, column in columns.items():
                file.create_dataset(name, data=column, chunks=(2_000,))
    elif kind == "csv":
        pa_csv.write_csv(pa.table(columns), path)
    else:
        parquet.write_table(pa.table(columns), path, row_group_size=50_000)
    (folder / "campaign.toml").write_text(f'[[records]]\nfile = "a.{kind}"\n{entry}')
    return folder


@pytest.mark.parametrize("kind", KINDS)
def test_the_first_samples_are_held_and_all_are_read_in_pieces(tmp_path, kind):
    columns = table()
    campaign = read_campaign(written(tmp_path, kind, columns))
    (record,) = campaign.records
    assert record.time.size == FIRST
    assert record.samples == SIZE
    pieces = list(record.long.pieces())
    assert len(pieces) > 3
    for name, scale in (("time", 1.0), ("displacement", 1e-3), ("force", 1e3)):
        found = np.concatenate([getattr(p, name) for p in pieces])
        expected = scale * next(c for n, c in columns.items() if n.startswith(name))
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(getattr(record, name), expected[:FIRST], rtol=1e-9, atol=1e-12)
    assert any("read in pieces" in f.text for f in campaign.findings)
    assert observe(record).samples > 0.99 * SIZE


@pytest.mark.parametrize("kind", KINDS)
def test_a_range_of_a_long_file_is_read_alone(tmp_path, kind):
    folder = written(tmp_path, kind, table(), 'range = "150 s : 170 s"\n')
    (record,) = read_campaign(folder).records
    assert record.long is None
    assert record.time[0] == pytest.approx(150.0, abs=1e-9)
    assert record.samples == 20_001


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_no_sine_test_is_held_whole_with_a_warning(tmp_path, kind):
    columns = table(120_000, sine=False)
    campaign = read_campaign(written(tmp_path, kind, columns))
    (record,) = campaign.records
    assert record.long is None
    np.testing.assert_allclose(record.force, 1e3 * columns["force [kN]"], rtol=1e-12)
    (finding,) = (f for f in campaign.findings if "held whole" in f.text)
    assert finding.level == "warning"


@pytest.mark.parametrize(("kind", "place"), [("parquet", "row 200001"), ("csv", "line 200002")])
def test_a_value_that_is_missing_far_inside_is_told_by_its_place(tmp_path, kind, place):
    columns = table()
    columns["force [kN]"][200_000] = np.nan
    (record,) = read_campaign(written(tmp_path, kind, columns)).records
    with pytest.raises(InputError, match=place):
        list(record.long.pieces())


def test_time_that_steps_back_between_pieces_is_told(tmp_path):
    columns = table()
    columns["time [s]"][200_000:] -= 1.0
    (record,) = read_campaign(written(tmp_path, "parquet", columns)).records
    with pytest.raises(InputError, match="row 200001: time must be rising"):
        list(record.long.pieces())


def test_a_text_that_is_not_regular_far_inside_is_told(tmp_path):
    folder = written(tmp_path, "csv", table())
    path = folder / "a.csv"
    lines = path.read_text().splitlines()
    lines[250_000] = "a remark of the operator"
    path.write_text("\n".join(lines))
    (record,) = read_campaign(folder).records
    with pytest.raises(InputError, match="one regular table"):
        list(record.long.pieces())


def test_time_stamps_count_from_the_first(tmp_path):
    columns = table()
    count = 1_700_000_000_000_000 + 1000 * np.arange(SIZE)
    del columns["time [s]"]
    columns["time"] = pa.array(count, pa.timestamp("us"))
    (record,) = read_campaign(written(tmp_path, "parquet", columns)).records
    last = list(record.long.pieces())[-1]
    assert last.time[-1] == pytest.approx((SIZE - 1) / RATE, abs=1e-9)


def test_times_of_a_clock_count_from_the_first_sample(tmp_path):
    columns = table()
    (from_zero,) = read_campaign(written(tmp_path, "parquet", columns)).records
    columns["time [s]"] = columns["time [s]"] + 1_795_823_998.0
    (by_clock,) = read_campaign(written(tmp_path, "parquet", columns)).records
    assert by_clock.time[0] == 0.0
    pieces = [p.time for p in by_clock.long.pieces()]
    np.testing.assert_allclose(np.concatenate(pieces), np.arange(SIZE) / RATE, atol=5e-7)
    observed = observe(by_clock), observe(from_zero)
    assert observed[0].samples > 0.99 * SIZE
    assert observed[0].frequency == pytest.approx(observed[1].frequency, rel=1e-8)


def test_times_are_made_of_a_sampling_rate_from_piece_to_piece(tmp_path):
    columns = table()
    del columns["time [s]"]
    folder = written(tmp_path, "parquet", columns, 'sampling_rate = "1 kHz"\n')
    (record,) = read_campaign(folder).records
    time = np.concatenate([p.time for p in record.long.pieces()])
    np.testing.assert_allclose(time, np.arange(SIZE) / RATE, rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_the_hash_is_that_of_the_file(tmp_path, kind):
    folder = written(tmp_path, kind, table(5_000))
    digest = hashlib.sha256()
    for name in ("campaign.toml", f"a.{kind}"):
        data = (folder / name).read_bytes()
        digest.update(f"{name}\0{len(data)}\0".encode() + data)
    assert read_campaign(folder).content_hash == digest.hexdigest()


def test_one_long_file_is_a_campaign_too(tmp_path):
    folder = written(tmp_path, "parquet", table())
    (record,) = read_campaign(folder / "a.parquet").records
    assert record.samples == SIZE
    assert record.time.size == FIRST
