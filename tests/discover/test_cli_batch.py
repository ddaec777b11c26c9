import json
import logging
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from discover.cli import batch_work, main

PLAN = ["--frequencies", "2", "--amplitudes", "10", "--noise", "0.5%"]
MODEL = ["--model", "ioim-laminar"]


@pytest.fixture(scope="module")
def fleet(tmp_path_factory):
    """Three campaigns of one test, and one that can't be read."""
    folder = tmp_path_factory.mktemp("fleet")
    for seed in (1, 2, 3):
        arguments = ["--device", "device-12", "--model", "ioim-laminar", "--seed", str(seed)]
        assert main(["synth", str(folder / f"d{seed}"), *arguments, *PLAN]) == 0
    broken = folder / "broken"
    broken.mkdir()
    (broken / "campaign.toml").write_text('[[records]]\nfile = "gone.csv"\n')
    return folder


def content(folder):
    """Return all files by name but the marks of what they are results of."""
    return {
        p.relative_to(folder).as_posix(): p.read_bytes()
        for p in folder.rglob("*")
        if p.is_file() and not p.name.startswith(".") and p.name != batch_work.STAMP
    }


@pytest.fixture(scope="module")
def whole(fleet, tmp_path_factory):
    """The folder of a batch that ran to its end in one process."""
    out = tmp_path_factory.mktemp("out") / "whole"
    assert main(["batch", str(fleet), "-o", str(out), *MODEL]) == 1
    return out


def test_all_but_the_broken_campaign_are_studied_and_its_fault_is_told(fleet, whole):
    document = json.loads((whole / "batch.json").read_text())
    states = {c["campaign"]: c["status"] for c in document["campaigns"]}
    assert states == {"broken": "failed", "d1": "done", "d2": "done", "d3": "done"}
    (broken,) = [c for c in document["campaigns"] if c["status"] == "failed"]
    assert "gone.csv" in broken["error"]
    assert "\n" not in broken["error"]
    names = {p.name for p in (whole / "d1").iterdir()}
    assert {"study.json", "report.html", "model.json", "figures", "gap"} <= names


def test_a_folder_is_the_one_that_discover_and_gap_write(fleet, whole, tmp_path):
    campaign = str(fleet / "d1")
    assert main(["discover", campaign, "-o", str(tmp_path / "s")]) == 0
    gap = ["gap", campaign, *MODEL, "-o", str(tmp_path / "g")]
    assert main(gap) == 0
    for alone, here in (("s", "d1"), ("g", "d1/gap")):
        name = "study.json" if alone == "s" else "gap.json"
        assert (tmp_path / alone / name).read_bytes() == (whole / here / name).read_bytes()


@pytest.mark.usefixtures("undrawn")
def test_what_is_done_stays_and_what_failed_is_tried_again(fleet, tmp_path):
    mine, out = tmp_path / "mine", tmp_path / "out"
    shutil.copytree(fleet / "d1", mine / "d1")
    shutil.copytree(fleet / "broken", mine / "broken")
    assert main(["batch", str(mine), "-o", str(out)]) == 1
    before = (out / "d1").stat()
    record = next((fleet / "d2").glob("*.csv"))
    shutil.copy(record, mine / "broken" / "gone.csv")
    assert main(["batch", str(mine), "-o", str(out)]) == 0
    assert (out / "broken" / "study.json").is_file()
    after = (out / "d1").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


def interrupted_after(folder, command):
    """Run a command that Ctrl-C interrupts as soon as a folder is there: exit code, last line."""
    process = subprocess.Popen(
        [sys.executable, "-m", "discover", *command],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while process.poll() is None and not folder.exists():
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    told = process.communicate(timeout=120)[1]
    return process.returncode, told.splitlines()[-1]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no signals for another process")
def test_an_interrupted_batch_goes_on_and_ends_in_the_same_table(fleet, whole, tmp_path):
    out = tmp_path / "out"
    command = ["batch", str(fleet), "-o", str(out), *MODEL]
    for done in ("d1", "d2"):
        assert interrupted_after(out / done, command) == (130, "inerter: interrupted")
        assert not (out / "table.csv").exists()
        assert not (out / "d3").exists()
    assert main(command) == 1
    ours, theirs = content(tmp_path / "out"), content(whole)
    assert ours.pop("report.html") != b""  # its last line is the command, with the folder
    theirs.pop("report.html")
    assert ours == theirs


@pytest.mark.slow
def test_results_are_the_same_to_the_byte_for_any_number_of_processes(fleet, whole, tmp_path):
    out = tmp_path / "out"
    command = ["batch", str(fleet), "-o", str(out), *MODEL, "--jobs", "2"]
    assert main(command) == 1
    ours, theirs = content(out), content(whole)
    assert ours.pop("report.html") != b""
    theirs.pop("report.html")
    assert ours == theirs


@pytest.mark.sweep
@pytest.mark.filterwarnings("ignore")  # of Dask's own
def test_results_are_the_same_to_the_byte_on_a_cluster(fleet, whole, tmp_path):
    distributed = pytest.importorskip("distributed")
    out = tmp_path / "out"
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
    ) as cluster:
        command = ["batch", str(fleet), "-o", str(out), *MODEL]
        assert main([*command, "--cluster", cluster.scheduler_address]) == 1
    ours, theirs = content(out), content(whole)
    assert ours.pop("report.html") != b""
    theirs.pop("report.html")
    assert ours == theirs


@pytest.mark.slow
def test_an_interrupt_ends_the_processes_too(fleet, tmp_path):
    out, many = tmp_path / "out", tmp_path / "many"
    for number in range(8):  # so that there is work when the first is done
        shutil.copytree(fleet / "d1", many / f"d{number}")
    command = [sys.executable, "-m", "discover", "batch", str(many), "-o", str(out), "--jobs", "2"]
    home = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    with subprocess.Popen(
        command, env=home, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as run:
        until = time.monotonic() + 300.0
        while not any(out.glob("d*")):
            assert time.monotonic() < until
            assert run.poll() is None
            time.sleep(0.01)
        os.killpg(run.pid, signal.SIGINT)  # as Ctrl-C does
        _, told = run.communicate(timeout=60.0)
    assert run.returncode == 130
    assert told.splitlines()[-1] == "inerter: interrupted"
    assert "Traceback" not in told


def test_a_folder_of_something_else_is_refused(fleet, tmp_path, capsys):
    (tmp_path / "mine.txt").write_text("mine")
    assert main(["batch", str(fleet), "-o", str(tmp_path)]) == 2
    assert "mine.txt" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]


def test_a_scheduler_that_is_not_there_ends_the_batch_before_any_work(fleet, tmp_path, capsys):
    pytest.importorskip("distributed")
    dask = pytest.importorskip("dask")
    out = tmp_path / "out"
    command = ["batch", str(fleet), "-o", str(out), "--cluster", "tcp://127.0.0.1:9"]
    with dask.config.set({"distributed.comm.timeouts.connect": "500ms"}):
        assert main(command) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("inerter: --cluster tcp://127.0.0.1:9: scheduler must be reachable")
    assert not out.exists()
