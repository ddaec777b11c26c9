"""Records read and compressed by the workers of a local Dask cluster: one worker beside two.

``python -m tests.benchmarks workers`` prints the rows and keeps them; `rows` returns them. Each
worker has done a small campaign first, so that neither its start nor what it compiles is measured.
"""

from __future__ import annotations

import json
import logging
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import distributed

from discover import check_campaign, read_campaign
from discover.executor import executor
from discover.records import Campaign
from tests.benchmarks.bench_long import Row, write_record

_RECORDS, _SAMPLES = 60, 1_000_000


def write_campaign(folder: Path, records: int, samples: int) -> None:
    """Write a campaign of copies of one sine test, each a file of its own."""
    write_record(folder, samples)
    entry = (folder / "campaign.toml").read_text(encoding="utf-8")
    for k in range(1, records):
        shutil.copy(folder / "long.parquet", folder / f"long-{k}.parquet")
    names = ["long.parquet", *(f"long-{k}.parquet" for k in range(1, records))]
    text = "\n".join(entry.replace("long.parquet", name) for name in names)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")


def rows(records: int = _RECORDS, samples: int = _SAMPLES) -> Iterator[Row]:
    """Yield all rows."""
    with tempfile.TemporaryDirectory() as place:
        small, large = Path(place, "small"), Path(place, "large")
        write_campaign(small, 2, 20_000)
        write_campaign(large, records, samples)
        took, answers = {}, set()
        for workers in (1, 2):
            with distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, dashboard_address=None,
                silence_logs=logging.CRITICAL,
            ) as cluster:  # fmt: skip
                for _ in range(2 * workers):
                    _read(small, cluster.scheduler_address)
                begin = time.perf_counter()
                campaign = _read(large, cluster.scheduler_address)
                took[workers] = time.perf_counter() - begin
            answers.add(json.dumps(check_campaign(campaign).to_dict()))
            yield f"{_named(records, samples)}: {workers} workers", took[workers], "s of wall", ""
    name = _named(records, samples)
    yield f"{name}: speed with two", took[1] / took[2], "times", "one worker; >= 1.8"
    yield f"{name}: different answers of check", float(len(answers) - 1), "", "0"


def _read(folder: Path, address: str) -> Campaign:
    with executor(cluster=address) as over:
        return read_campaign(folder, over=over)


def _named(records: int, samples: int) -> str:
    return f"{records} records of {samples:,} samples, read and compressed"


if __name__ == "__main__":
    for what, value, unit, other in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({other})" if other else ""))
