"""A sine test that is read in pieces, through the whole of discover: time and memory.

``python -m tests.benchmarks long`` prints the rows and keeps them; `rows` returns them. Each file
is written in pieces beside this process's temporary files, 8 bytes a sample, and removed after.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

SMALL = 20_000
_SAMPLES = (10_000_000, 100_000_000, 1_000_000_000)
_RATE, _FREQUENCY, _AMPLITUDE = 1000.0, 1.6, 0.01
_GROUP = 1_000_000  # samples
_DISCOVER = """
import resource, sys, time
from discover.cli import main
begin = time.process_time()
code = main(["discover", sys.argv[1], "-o", sys.argv[2], "--json"])
print(code, file=sys.stderr)
print(time.process_time() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
      file=sys.stderr)
"""


def write_record(folder: Path, samples: int) -> None:
    """Write a campaign of one sine test of inertance, damping and friction, with 2 % noise."""
    rng = np.random.default_rng(0)
    omega = 2.0 * np.pi * _FREQUENCY
    schema = pa.schema([("displacement [m]", pa.float32()), ("force [N]", pa.float32())])
    folder.mkdir()
    with parquet.ParquetWriter(folder / "long.parquet", schema) as writer:
        for first in range(0, samples, _GROUP):
            angle = omega / _RATE * np.arange(first, min(first + _GROUP, samples))
            speed = omega * _AMPLITUDE * np.cos(angle)
            force = 700.0 * speed - 200.0 * omega**2 * _AMPLITUDE * np.sin(angle)
            force += 30.0 * np.tanh(speed / 2e-3) + 4.0 * rng.standard_normal(angle.size)
            place = _AMPLITUDE * np.sin(angle) + 1e-6 * rng.standard_normal(angle.size)
            columns = [place.astype(np.float32), force.astype(np.float32)]
            writer.write_table(pa.Table.from_arrays(columns, schema=schema))
    entry = f'[[records]]\nfile = "long.parquet"\nsampling_rate = "{_RATE:g} Hz"\n'
    (folder / "campaign.toml").write_text(entry, encoding="utf-8")


def discovered(samples: int) -> tuple[float, float]:
    """Return processor time (s) and peak memory (MiB) of `inerter discover` in its own process."""
    with tempfile.TemporaryDirectory() as place:
        write_record(Path(place, "a"), samples)
        ran = subprocess.run(
            [sys.executable, "-c", _DISCOVER, str(Path(place, "a")), str(Path(place, "out"))],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=True,
        )  # fmt: skip
    code, told = ran.stderr.strip().splitlines()[-2:]
    if code != "0":
        raise RuntimeError(f"discover ended with {code} on {samples} samples")
    took, peak = told.split()
    return float(took), float(peak)


def rows(sizes: Sequence[int] = _SAMPLES) -> Iterator[Row]:
    """Yield all rows."""
    small, memory = discovered(SMALL)
    yield _named(SMALL), small, "s of processor time", ""
    before, sizes = [(SMALL, small)], list(sizes)
    slopes: list[float] = []
    for samples in sizes:
        took, peak = discovered(samples)
        fewer, less = before[-1]
        slopes.append((took - less) / (samples - fewer))
        before.append((samples, took))
        beside = f"{1e6 * slopes[-1]:.3g} µs for each sample more than {fewer:,}"
        yield _named(samples), took, "s of processor time", beside
        yield f"{_named(samples)}: peak memory over the first", peak - memory, "MiB", "bar 700"
    for (samples, _), slope, last in zip(before[2:], slopes[1:], slopes[2:], strict=False):
        name = f"time for each sample beyond {samples:,}, over that up to there"
        yield name, last / slope, "times", "bar 1.15"


def _named(samples: int) -> str:
    return f"discover, one sine test of {samples:,} samples in Parquet"


if __name__ == "__main__":
    for what, value, unit, other in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({other})" if other else ""))
