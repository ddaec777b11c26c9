"""What a record costs by its samples, a campaign by its records, and a batch by its processes.

``python -m tests.benchmarks scale`` prints the rows and keeps them; `rows` returns them.
"""

from __future__ import annotations

import contextlib
import io
import json
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from discover.cli import main
from discover.motion_fit import observe
from discover.records import Campaign
from discover.rows import record_rows
from discover.study import StudyOptions
from discover.study.prepare import prepare
from tests.benchmarks.bench_speed import sine_record

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_SAMPLES = (10_000, 100_000, 1_000_000)
_RECORDS = (1, 10, 100)
_SHORT = 2_000  # samples of each of many records
_CAMPAIGNS = 4
_PLAN = ("--frequencies", "0.5,1,2,4", "--amplitudes", "10", "--noise", "0.5%")


def one_record(samples: int) -> dict[str, float]:
    """Return processor time (s) and peak memory (MiB) of one sine test to its rows."""
    observe(sine_record(2_000))  # what is compiled is compiled before
    record = sine_record(samples)
    begin = time.process_time()
    record_rows(observe(record))
    took = time.process_time() - begin
    return {"time": took, "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0}


def by_samples() -> Iterator[Row]:
    """Yield processor time and memory of one record, each in a process of its own."""
    first = 0.0
    for samples in _SAMPLES:
        code = (
            "import json; from tests.benchmarks.bench_scale import one_record;"
            f" print(json.dumps(one_record({samples})))"
        )
        ran = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
        found = json.loads(ran.stdout)
        first = first or found["peak"]
        name = f"sine test of {samples:,} samples, to its rows"
        each = f"{1e6 * found['time'] / samples:.2g} µs a sample"
        yield name, found["time"], "s of processor time", each
        yield f"{name}: peak memory over that at 10,000", found["peak"] - first, "MiB", ""


def by_records() -> Iterator[Row]:
    """Yield the processor time of a campaign's records, to their rows."""
    record = sine_record(_SHORT)
    for count in _RECORDS:
        campaign = Campaign("many", (record,) * count, content_hash="0")
        begin = time.process_time()
        prepare(campaign, StudyOptions())
        took = time.process_time() - begin
        name = f"{count:,} records of {_SHORT:,} samples, to their rows"
        yield name, took, "s of processor time", f"{1e3 * took / count:.2g} ms a record"


def by_processes() -> Iterator[Row]:
    """Yield the time of a batch in one and in two processes, which begin anew each time."""
    with tempfile.TemporaryDirectory() as place:
        for seed in range(1, _CAMPAIGNS + 1):
            target = str(Path(place, "fleet", f"d{seed}"))
            command = ["synth", target, "--device", "device-12", "--model", "ioim-laminar"]
            with contextlib.redirect_stdout(io.StringIO()):
                main([*command, "--seed", str(seed), *_PLAN])
        times = {}
        for jobs in (1, 2):
            command = ["batch", str(Path(place, "fleet")), "-o", str(Path(place, f"out-{jobs}"))]
            begin = time.perf_counter()
            subprocess.run(
                [sys.executable, "-m", "discover", *command, "--jobs", str(jobs)],
                capture_output=True, check=True,
            )  # fmt: skip
            times[jobs] = time.perf_counter() - begin
            name = f"batch of {_CAMPAIGNS} campaigns of 4 records, --jobs {jobs}"
            yield name, times[jobs], "s", "studies, pictures and pages"
    yield "two processes over one", times[1] / times[2], "times as fast", ""


def rows() -> Iterator[Row]:
    """Yield all rows."""
    yield from by_samples()
    yield from by_records()
    yield from by_processes()


if __name__ == "__main__":
    for what, value, unit, other in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({other})" if other else ""))
