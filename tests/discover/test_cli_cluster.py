"""Verbs on one campaign over processes and over a cluster: the same bytes, and nothing lost."""

import contextlib
import logging
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest

from discover.cli import main

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("ignore")  # of Dask's own, when workers die

VERBS = {
    "discover": ("study.json", []),
    "gap": ("gap.json", ["--model", "fit:inertia,viscous-damping", "--effects", "stiffness"]),
    "check": ("check.json", []),
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Six sine tests, of which two are longer than what is held of one."""
    folder = tmp_path_factory.mktemp("lab") / "campaign"
    folder.mkdir()
    rng = np.random.default_rng(5)
    lines = []
    for number, (frequency, size) in enumerate(
        [(0.7, 80_000), (1.1, 5_000), (1.6, 5_000), (2.3, 5_000), (3.1, 5_000), (4.2, 200_000)]
    ):
        omega = 2.0 * np.pi * frequency
        angle = omega * np.arange(size) / 1000.0
        speed = 0.01 * omega * np.cos(angle)
        force = 700.0 * speed - 2.0 * omega**2 * np.sin(angle) + 30.0 * np.tanh(speed / 2e-3)
        force += 0.02 * np.std(force) * rng.standard_normal(size)
        place = 0.01 * np.sin(angle) + 1e-6 * rng.standard_normal(size)
        columns = {"displacement [m]": place, "force [N]": force}
        parquet.write_table(pa.table(columns), folder / f"r{number}.parquet")
        lines.append(f'[[records]]\nfile = "r{number}.parquet"\nsampling_rate = "1 kHz"\n')
    (folder / "campaign.toml").write_text("\n".join(lines))
    return folder


@contextlib.contextmanager
def two_workers():
    """Yield a cluster of two processes on this machine."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
    ) as cluster:
        yield cluster


def document(verb, campaign, out, *more):
    """Return the document that a verb writes."""
    name, options = VERBS[verb]
    assert main([verb, str(campaign), *options, "-o", str(out), *more]) == 0
    return (out / name).read_bytes()


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_a_check_is_the_same_to_the_byte_over_processes(campaign, tmp_path):
    alone = document("check", campaign, tmp_path / "1")
    assert document("check", campaign, tmp_path / "2", "--jobs", "2") == alone


@pytest.mark.sweep
@pytest.mark.usefixtures("undrawn")
def test_documents_are_the_same_to_the_byte_over_processes_and_on_a_cluster(campaign, tmp_path):
    with two_workers() as cluster:
        for verb in VERBS:
            alone = document(verb, campaign, tmp_path / f"{verb}-1")
            assert document(verb, campaign, tmp_path / f"{verb}-2", "--jobs", "2") == alone
            address = cluster.scheduler_address
            assert document(verb, campaign, tmp_path / f"{verb}-c", "--cluster", address) == alone


def busy_worker(client):
    """Return the address of a worker once one has work."""
    until = time.monotonic() + 60.0
    while time.monotonic() < until:
        for address, tasks in client.processing().items():
            if tasks:
                return address
        time.sleep(0.005)
    raise TimeoutError("no worker was given anything")


@pytest.mark.sweep
@pytest.mark.usefixtures("undrawn")
def test_a_killed_worker_loses_nothing(campaign, tmp_path):
    killed = []

    def kill(client):
        address = busy_worker(client)
        (process,) = client.run(os.getpid, workers=[address]).values()
        os.kill(process, signal.SIGKILL)
        killed.append(process)

    with two_workers() as cluster, distributed.Client(cluster, set_as_default=False) as client:
        killer = threading.Thread(target=kill, args=(client,))
        killer.start()
        address = cluster.scheduler_address
        there = document("check", campaign, tmp_path / "there", "--cluster", address)
        killer.join()
    assert len(killed) == 1
    assert there == document("check", campaign, tmp_path / "here")


@pytest.mark.sweep
@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals for another process")
def test_an_interrupt_cancels_what_is_queued(campaign, tmp_path):
    out = tmp_path / "out"
    home = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    with two_workers() as cluster, distributed.Client(cluster, set_as_default=False) as client:
        command = ["discover", str(campaign), "-o", str(out)]
        with subprocess.Popen(
            [sys.executable, "-m", "discover", *command, "--cluster", cluster.scheduler_address],
            env=home, stderr=subprocess.PIPE, text=True, start_new_session=True,
        ) as run:
            busy_worker(client)
            os.killpg(run.pid, signal.SIGINT)
            _, told = run.communicate(timeout=60.0)
        assert run.returncode == 130
        assert told.splitlines()[-1] == "inerter: interrupted"
        assert "Traceback" not in told
        until = time.monotonic() + 30.0
        while any(client.processing().values()):
            assert time.monotonic() < until
            time.sleep(0.05)
    assert not out.exists()


@pytest.mark.parametrize("verb", VERBS)
def test_a_scheduler_that_is_not_there_is_told_in_one_line(verb, campaign, tmp_path, capsys):
    _, options = VERBS[verb]
    out = tmp_path / "out"
    command = [verb, str(campaign), *options, "-o", str(out), "--cluster", "tcp://127.0.0.1:9"]
    with dask.config.set({"distributed.comm.timeouts.connect": "500ms"}):
        assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("inerter: --cluster tcp://127.0.0.1:9: scheduler must be reachable")
    assert not out.exists()
