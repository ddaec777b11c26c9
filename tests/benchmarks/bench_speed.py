"""Where time goes: reading, lines of the force, loading; each beside its floor in the same run.

``python -m tests.benchmarks speed`` prints the rows and keeps them; `rows` returns them. A floor
and what is held to it are timed in turn, and the least of each counts: so other programs on the
machine slow both.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from discover.motion_fit import observe
from discover.readers import read_campaign
from discover.readers.formats import open_book
from discover.records import Record
from models.checks import Array

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_SAMPLES = 1_000_000
_RATE = 1000.0  # Hz
_FREQUENCY = 1.6  # Hz
_HARMONICS = 17
_REPEATS = 5
_NAMES = ("time [s]", "displacement [m]", "force [N]")
_CHECK = (
    "from discover.cli import app; from discover.data_check import check_campaign;"
    " from discover.readers import read_campaign; from discover.report.check import check_figures"
)
_HELP = "from discover.cli import main; main(['check', '--help'])"


def beside(work: Callable[[], object], floor: Callable[[], object]) -> tuple[float, float]:
    """Return the least times of the work and of its floor, run in turn, s."""
    times = np.empty((_REPEATS, 2))
    for row in times:
        for place, function in enumerate((work, floor)):
            begin = time.perf_counter()
            function()
            row[place] = time.perf_counter() - begin
    least, lowest = times.min(axis=0)
    return float(least), float(lowest)


def sine_record(samples: int) -> Record:
    """Return a sine test with 2 % noise."""
    rng = np.random.default_rng(0)
    t = np.arange(samples) / _RATE
    angle = 2.0 * np.pi * _FREQUENCY * t
    force = -300.0 * np.sin(angle) + 50.0 * np.cos(angle) + 20.0 * np.sign(np.cos(angle))
    force += 6.0 * rng.standard_normal(samples)
    return Record("sine", t, force, 0.01 * np.sin(angle) + 1e-6 * rng.standard_normal(samples))


def random_record(samples: int) -> Record:
    """Return a random test of up to 10 Hz with 2 % noise."""
    rng = np.random.default_rng(1)
    spectrum = np.fft.rfft(rng.standard_normal(samples))
    spectrum[np.fft.rfftfreq(samples, 1.0 / _RATE) > 10.0] = 0.0
    x = np.fft.irfft(spectrum, n=samples)
    x *= 0.01 / np.abs(x).max()
    force = 1e5 * np.gradient(np.gradient(x, 1.0 / _RATE), 1.0 / _RATE) / 3e3 + 2e4 * x
    force += 0.02 * force.std() * rng.standard_normal(samples)
    x = x + 1e-6 * rng.standard_normal(samples)
    return Record("random", np.arange(samples) / _RATE, force, x)


def harmonic_sums(record: Record) -> Array:
    """Return the sums of a force over the cosines and sines of 17 harmonics: one pass of numpy."""
    step = np.exp(2j * np.pi * _FREQUENCY * record.time)
    power = np.ones_like(step)
    sums = np.empty(_HARMONICS, dtype=complex)
    for harmonic in range(_HARMONICS):
        power *= step
        sums[harmonic] = power @ record.force
    return sums.view(np.float64)


def _table(record: Record) -> pa.Table:
    motion = np.zeros(0) if record.displacement is None else record.displacement
    return pa.table(dict(zip(_NAMES, (record.time, motion, record.force), strict=True)))


def _read(data: bytes, name: str) -> list[Array]:
    return open_book(data, name, where=name).parts[0].read([0, 1, 2])


def _arrow(table: pa.Table) -> list[Array]:
    return [np.array(table.column(name)) for name in _NAMES]


def reading() -> Iterator[Row]:
    """Yield the times of reading the columns of a file that is in memory."""
    table = _table(sine_record(_SAMPLES))
    binary, text = io.BytesIO(), io.BytesIO()
    pa_parquet.write_table(table, binary)
    pa_csv.write_csv(table, text)
    parquet, csv = binary.getvalue(), text.getvalue()

    def parquet_floor() -> list[Array]:
        return _arrow(pa_parquet.ParquetFile(io.BytesIO(parquet)).read())

    def csv_floor() -> list[Array]:
        return _arrow(pa_csv.read_csv(io.BytesIO(csv)))

    for name, work, floor, bar in (
        ("Parquet", lambda: _read(parquet, "a.parquet"), parquet_floor, 1.5),
        ("CSV", lambda: _read(csv, "a.csv"), csv_floor, 2.0),
    ):
        took, least = beside(work, floor)
        yield f"{name} of {_SAMPLES:,} samples: columns", took, "s", f"pyarrow {least:.3g} s"
        yield f"{name}: over pyarrow's own", took / least, "times", f"bar {bar:g}"


def lines() -> Iterator[Row]:
    """Yield the times from samples to motion and lines of the force, of records not seen yet."""
    sine, random = sine_record(_SAMPLES), random_record(_SAMPLES)

    def spectrum() -> object:
        return np.fft.rfft(random.force)

    for name, record, floor, what in (
        ("sine test", sine, lambda: harmonic_sums(sine), "sums of 17 harmonics"),
        ("random record", random, spectrum, "its rfft"),
    ):
        took, least = beside(lambda record=record: observe(replace(record)), floor)
        label = f"{name} of {_SAMPLES:,} samples: motion and lines"
        yield label, took, "s", f"{what} {least:.3g} s"
        yield f"{name}: over {what}", took / least, "times", "bar 3"


def campaigns() -> Iterator[Row]:
    """Yield the time of reading a campaign with all that reading judges."""
    with tempfile.TemporaryDirectory() as folder:
        pa_parquet.write_table(_table(sine_record(_SAMPLES)), Path(folder, "a.parquet"))
        Path(folder, "campaign.toml").write_text('[[records]]\nfile = "a.parquet"\n')
        data = Path(folder, "a.parquet").read_bytes()
        took, least = beside(
            lambda: read_campaign(folder), lambda: pa_parquet.ParquetFile(io.BytesIO(data)).read()
        )
    yield "campaign of one such Parquet file: read and judged", took, "s", f"pyarrow {least:.3g} s"


def loading() -> Iterator[Row]:
    """Yield the processor times of the command's imports, in new processes."""
    for name, code, bar in (("--help", _HELP, "0.6 s"), ("check", _CHECK, "1.2 s")):
        timed = f"import time; {code}; print('took', time.process_time())"
        times = []
        for _ in range(_REPEATS):
            ran = subprocess.run(
                [sys.executable, "-c", timed], capture_output=True, text=True, check=True
            )
            times.append(float(ran.stdout.rpartition("took")[2]))
        yield f"imports of inerter {name}", min(times), "s of processor time", f"bar {bar}"


def rows() -> Iterator[Row]:
    """Yield all rows."""
    yield from reading()
    yield from lines()
    yield from campaigns()
    yield from loading()


if __name__ == "__main__":
    for what, value, unit, other in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({other})" if other else ""))
