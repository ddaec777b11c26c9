"""Records that an executor reads: what comes back says what all their samples say."""

import pickle

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest

from discover.data_check import check_campaign
from discover.executor import executor
from discover.motion_fit import observe
from discover.readers import read_campaign
from discover.readers.taken import HELD
from discover.rows import accuracy, record_rows
from models.checks import InputErrors
from models.constitutive import FittedTerm, ForceModel

RATE = 1000.0
SIZES = {"long.parquet": 150_000, "short.parquet": 6_000, "random.parquet": 70_000}
MODEL = ForceModel((FittedTerm("inertia", 200.0), FittedTerm("viscous-damping", 690.0)))


def motion(name, rng):
    """Return displacement (m), speed and acceleration: a sine test, or random motion."""
    time = np.arange(SIZES[name]) / RATE
    if name != "random.parquet":
        omega = 2.0 * np.pi * (1.6 if name == "long.parquet" else 2.7)
        sine = np.sin(omega * time)
        return 0.01 * sine, 0.01 * omega * np.cos(omega * time), -0.01 * omega**2 * sine
    lines = np.zeros(time.size // 2 + 1, dtype=complex)
    few = slice(40, 300)
    lines[few] = rng.standard_normal(260) + 1j * rng.standard_normal(260)
    omega = 2.0 * np.pi * np.fft.rfftfreq(time.size, 1.0 / RATE)
    x, v, a = (np.fft.irfft(lines * (1j * omega) ** k, n=time.size) for k in range(3))
    scale = 0.01 / np.abs(x).max()
    return scale * x, scale * v, scale * a


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A campaign of a longer sine test, a short one, and a longer random record."""
    place = tmp_path_factory.mktemp("campaign")
    rng = np.random.default_rng(3)
    for name in SIZES:
        x, v, a = motion(name, rng)
        force = 200.0 * a + 700.0 * v + 30.0 * np.tanh(v / 2e-3)
        force += 0.02 * np.std(force) * rng.standard_normal(x.size)
        columns = {
            "displacement [m]": x + 1e-6 * rng.standard_normal(x.size),
            "force [N]": force,
        }
        parquet.write_table(pa.table(columns), place / name)
    entries = [f'[[records]]\nfile = "{name}"\nsampling_rate = "1 kHz"\n' for name in SIZES]
    (place / "campaign.toml").write_text("\n".join(entries))
    return place


def read(folder, jobs):
    with executor(jobs) as over:
        return read_campaign(folder, over=over)


@pytest.fixture(scope="module")
def here(folder):
    return read(folder, 1)


@pytest.fixture(scope="module")
def whole(folder):
    """The campaign with all its samples."""
    return read_campaign(folder)


def test_the_first_samples_of_a_longer_sine_test_are_held(here):
    held = {r.file: (r.time.size, r.samples) for r in here.records}
    assert held == {
        "long.parquet": (HELD, 150_000), "short.parquet": (6_000, 6_000),
        "random.parquet": (70_000, 70_000),
    }


def test_what_is_told_of_all_samples_stays(here, whole):
    assert here.content_hash == whole.content_hash
    assert here.findings == whole.findings
    for ours, theirs in zip(here.records, whole.records, strict=True):
        assert ours.step == theirs.step
        one, other = observe(ours), observe(theirs)
        assert one.samples == other.samples
        assert one.duration == other.duration
        for w, v in zip(one.windows, other.windows, strict=True):
            np.testing.assert_array_equal(w.force, v.force)
            np.testing.assert_array_equal(w.variance, v.variance)
        np.testing.assert_array_equal(record_rows(one).target, record_rows(other).target)
        left, right = accuracy(one, MODEL), accuracy(other, MODEL)
        assert left.relative_percent == pytest.approx(right.relative_percent, rel=1e-6)
        assert left.force_power == pytest.approx(right.force_power, rel=1e-12)


def test_a_check_of_held_records_is_that_of_whole_ones(here, whole):
    ours, theirs = check_campaign(here), check_campaign(whole)
    assert ours.findings == theirs.findings
    for one, other in zip(ours.records, theirs.records, strict=True):
        told, expected = one.to_dict(), other.to_dict()
        assert told.pop("force_noise_percent") == pytest.approx(
            expected.pop("force_noise_percent"), rel=1e-9
        )
        assert told == expected


def test_no_more_than_the_first_samples_travel(folder):
    record = read(folder, 1).records[0]
    size = len(pickle.dumps(record))
    assert size < 3 * 8 * HELD + 2_000_000  # the columns, and the sums
    found = pickle.loads(pickle.dumps(record))
    np.testing.assert_array_equal(observe(found).motion.velocity, observe(record).motion.velocity)


@pytest.mark.slow
def test_other_processes_give_the_same(folder, here):
    there = read(folder, 2)
    assert there.findings == here.findings
    for ours, theirs in zip(there.records, here.records, strict=True):
        for name in ("time", "force", "displacement"):
            assert getattr(ours, name).tobytes() == getattr(theirs, name).tobytes()
        for w, v in zip(observe(ours).windows, observe(theirs).windows, strict=True):
            assert w.force.tobytes() == v.force.tobytes()
            assert w.variance.tobytes() == v.variance.tobytes()
    assert check_campaign(there).to_dict() == check_campaign(here).to_dict()


@pytest.mark.slow
def test_records_in_memory_are_observed_by_other_processes_too(folder, whole):
    there = check_campaign(read_campaign(folder), jobs=2)
    assert there.to_dict() == check_campaign(whole).to_dict()


def test_samples_that_drive_a_carried_system_are_all_held(tmp_path):
    time = np.arange(HELD + 5_000) / RATE
    x = 0.01 * np.sin(10.0 * time)
    columns = {
        "displacement [m]": x, "force [N]": -20.0 * x + np.cos(10.0 * time),
        "base_acceleration [m/s^2]": np.sin(10.0 * time),
    }
    parquet.write_table(pa.table(columns), tmp_path / "a.parquet")
    entry = '[[records]]\nfile = "a.parquet"\nsampling_rate = "1 kHz"\n'
    (tmp_path / "campaign.toml").write_text(entry)
    (record,) = read(tmp_path, 1).records
    assert record.time.size == time.size


@pytest.mark.slow
def test_errors_are_told_as_by_one_process(tmp_path):
    names = ["gone.csv", "lost.csv"]
    (tmp_path / "campaign.toml").write_text("".join(f'[[records]]\nfile = "{n}"\n' for n in names))
    told = []
    for jobs in (1, 2):
        with pytest.raises(InputErrors, match="gone.csv") as error:
            read(tmp_path, jobs)
        told.append(str(error.value))
    with pytest.raises(InputErrors, match="lost.csv") as error:
        read_campaign(tmp_path)
    assert set(told) == {str(error.value)}
