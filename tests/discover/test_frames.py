"""Tables in memory as a campaign, and what is said where something else is given."""

import numpy as np
import pandas as pd
import pytest

import discover
from models.checks import InputError
from models.device import Device

RATE = 200.0
TIME = np.arange(2000) / RATE
OMEGA = 2.0 * np.pi


def table(amplitude=10.0, frequency=1.0):
    """Return time in ms, displacement in mm and force in kN of 370 kg and 400 N of friction."""
    w = OMEGA * frequency
    rng = np.random.default_rng(0)
    force = -370.0e-6 * amplitude * w**2 * np.sin(w * TIME) + 0.4 * np.sign(np.cos(w * TIME))
    noise = 0.01 * np.ptp(force) * rng.normal(size=TIME.size)
    return {"t": 1e3 * TIME, "x": amplitude * np.sin(w * TIME), "F": force + noise}


NAMES = {"time": "t", "displacement": "x", "force": "F"}
UNITS = {"time": "ms", "displacement": "mm", "force": "kN"}


def from_tables(tables, **options):
    return discover.Campaign.from_frames(tables, columns=NAMES, units=UNITS, **options)


def as_polars(columns):
    return pytest.importorskip("polars").DataFrame(columns)


def as_xarray(columns):
    xarray = pytest.importorskip("xarray")
    data = {name: ("t", columns[name]) for name in ("x", "F")}
    return xarray.Dataset(data, coords={"t": columns["t"]})


@pytest.mark.parametrize(
    "make",
    [dict, pd.DataFrame, lambda c: pd.DataFrame(c).set_index("t"), as_polars, as_xarray],
    ids=["mapping", "pandas", "pandas with an index", "polars", "xarray"],
)
def test_tables_of_any_kind_become_records_in_si(make):
    columns = table()
    before = {name: values.copy() for name, values in columns.items()}
    campaign = from_tables({"1hz": make(columns)}, device="device-12", title="mine")
    (record,) = campaign.records
    np.testing.assert_allclose(record.time, TIME, atol=1e-12)
    np.testing.assert_allclose(record.displacement, 1e-3 * columns["x"], rtol=1e-14, atol=1e-17)
    np.testing.assert_allclose(record.force, 1e3 * columns["F"], rtol=1e-14)
    assert campaign.device == Device.preset("device-12")
    assert repr(campaign) == "<Campaign 'mine': 1 record of device-12>"
    assert all((before[name] == columns[name]).all() for name in columns)


def test_the_same_records_from_files_and_from_memory_are_the_same(tmp_path):
    pd.DataFrame(table()).to_csv(tmp_path / "run.csv", index=False)
    lines = ["[columns]", *(f'{k} = "{v}"' for k, v in NAMES.items()), "[units]"]
    lines += [*(f'{k} = "{v}"' for k, v in UNITS.items()), '[[records]]\nfile = "run.csv"']
    (tmp_path / "campaign.toml").write_text("\n".join(lines))
    (read,) = discover.read_campaign(tmp_path).records
    (made,) = from_tables({"run.csv": table()}).records
    np.testing.assert_allclose(made.force, read.force, rtol=1e-12)
    np.testing.assert_allclose(made.displacement, read.displacement, rtol=1e-12, atol=1e-17)


def test_the_content_s_hash_is_of_what_is_read_however_it_is_put():
    one = discover.Campaign.from_frames({"a": table()}, columns=NAMES, units=UNITS)
    turned = [dict(reversed(given.items())) for given in (NAMES, UNITS)]
    other = discover.Campaign.from_frames({"a": table()}, columns=turned[0], units=turned[1])
    assert one.content_hash == other.content_hash
    coarser = discover.Campaign.from_frames(
        {"a": {name: values[::2] for name, values in table().items()}}, columns=NAMES, units=UNITS
    )
    assert coarser.content_hash != one.content_hash


def test_headers_carry_units_and_time_stamps_count_in_seconds():
    columns = table()
    frame = pd.DataFrame({
        "time": pd.Timestamp("2025-01-01") + pd.to_timedelta(columns["t"], unit="ms"),
        "displacement [mm]": columns["x"],
        "Force (kN)": columns["F"],
        "remark": "ok",
    })  # fmt: skip
    campaign = discover.Campaign.from_frames({"run": frame}, held_out=["run"])
    (record,) = campaign.records
    assert record.held_out
    assert record.time[-1] - record.time[0] == pytest.approx(TIME[-1])
    assert np.abs(record.force).max() == pytest.approx(1e3 * np.abs(columns["F"]).max())
    assert campaign.findings == ()


def test_units_that_nobody_states_are_taken_as_si_with_a_warning():
    si = {"time": TIME, "displacement": 1e-3 * table()["x"], "force": 1e3 * table()["F"]}
    (finding,) = discover.Campaign.from_frames({"run": si}).findings
    assert finding.level == "warning"
    assert "no unit is stated for time, s taken" in finding.text


def test_a_sampling_rate_stands_for_the_time():
    columns = table()
    del columns["t"]
    campaign = from_tables({"run": columns}, sampling_rate=RATE)
    assert campaign.records[0].step == pytest.approx(1.0 / RATE)


def test_a_study_of_frames_is_that_of_the_device():
    tables = {f"{f} Hz": table(10.0, f) for f in (0.5, 1.0, 2.0, 3.0)}
    study = discover.run_study(from_tables(tables))
    assert [b.structure for b in study.bands] == ["IOIM-linear"]
    assert study.bands[0].terms[0].fitted.coefficient == pytest.approx(370.0, rel=0.02)


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({}, "Campaign.from_frames: frames must be a mapping .* got nothing"),
        (pd.DataFrame({"time": [1.0]}), "frames must be a mapping of a record's name to a table"),
        ({"run": pd.Series([1.0])}, "run: frame must be a table with columns time, .* got Series"),
        ({"run": {"t": TIME, "x": TIME}}, "run: column 'F' for force must be among the headers"),
        ({"run": table() | {"F": TIME[:9]}}, r"run: F must be of shape \(2000,\), got \(9,\)"),
        ({"run": table() | {"F": ["a"] * 2000}}, "run row 1: F must be a finite number"),
    ],
)
def test_what_is_no_table_is_refused_with_what_would_be_one(tables, message):
    with pytest.raises(InputError, match=message):
        from_tables(tables)


def test_a_name_that_is_held_out_has_to_be_there():
    with pytest.raises(InputError, match="held_out must be names of frames, got 'other'"):
        from_tables({"run": table()}, held_out=["other"])


@pytest.mark.parametrize(
    ("given", "advice"),
    [
        ("lab", r"discover\.read_campaign\('lab'\) reads one, got a path"),
        (pd.DataFrame(), r"discover\.Campaign\.from_frames\(.*\) makes one, got DataFrame"),
        (pd.Series(dtype=float), r"discover\.Campaign\.from_frames\(.*\) makes one, got Series"),
        (discover.Record("a", TIME, TIME), r"discover\.Campaign\('title', \(record,\)\) makes one"),
    ],
)
@pytest.mark.parametrize(
    "work",
    [
        discover.run_study,
        discover.check_campaign,
        lambda c: discover.close_gap(c, "foim"),
        lambda c: discover.simulate_forces(c, {"m": None}),
    ],
    ids=["run_study", "check_campaign", "close_gap", "simulate_forces"],
)
def test_where_a_campaign_is_expected_anything_else_is_told_how_to_become_one(work, given, advice):
    with pytest.raises(InputError, match=f"campaign must be a Campaign: {advice}"):
        work(given)


def test_a_record_takes_series_and_lists_and_leaves_them_alone():
    force = np.cos(TIME)
    record = discover.Record("a", pd.Series(TIME), pd.Series(force), list(np.sin(TIME)))
    assert isinstance(record.force, np.ndarray)
    assert not record.force.flags.writeable
    assert repr(record).startswith("<Record 'a': 2000 samples, 9.995 s, force up to 1 N")
    again = discover.Record("a", TIME, force)
    assert force.flags.writeable  # the caller's own stays as it was
    assert not again.force.flags.writeable
    with pytest.raises(InputError, match="a: force must be numeric, got Series"):
        discover.Record("a", TIME, pd.Series(["x"] * 2000))


@pytest.mark.parametrize("given", [pd.Series([1.0]), pd.DataFrame({"time": [0.0]}), 3])
def test_reading_what_is_no_path_says_what_takes_tables(given):
    message = f"path must be .*from_frames takes tables.*got {type(given).__name__}"
    with pytest.raises(InputError, match=message):
        discover.read_campaign(given)
