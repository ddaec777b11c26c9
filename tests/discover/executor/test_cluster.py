import logging
import subprocess
import sys
import time

import pytest

from discover.executor import Lost, executor
from models.checks import InputError
from tests.discover.executor import tasks

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("ignore")  # of Dask's own, when workers die


@pytest.fixture(scope="module")
def address():
    """A cluster of two processes on this machine."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
    ) as cluster:
        yield cluster.scheduler_address


def done(address, function, items):
    with executor(cluster=address) as where:
        return dict(where.finished(function, items))


def test_every_item_is_done_and_knows_its_place(address):
    assert done(address, tasks.squared, [3, 1, 2, 5]) == {0: 9, 1: 1, 2: 4, 3: 25}


def test_equal_items_are_each_done(address):
    assert done(address, tasks.squared, [2, 2]) == {0: 4, 1: 4}


def test_an_error_of_the_work_is_the_callers(address):
    with pytest.raises(ValueError, match="three is refused"):
        done(address, tasks.fails, [1, 3, 2])


def test_a_killed_worker_loses_nothing(address, tmp_path):
    items = ["", str(tmp_path / "once"), "", ""]
    assert done(address, tasks.dies_once, items) == dict(enumerate(items))


@pytest.mark.slow
def test_an_item_that_kills_every_worker_is_given_up(address):
    found = done(address, tasks.dies, [1, -1, 2])
    assert isinstance(found.pop(1), Lost)
    assert found == {0: 1, 2: 2}


@pytest.fixture
def last_worker():
    """The scheduler of one worker that nothing starts again."""
    with distributed.LocalCluster(
        n_workers=0, protocol="tcp", dashboard_address=None, silence_logs=logging.CRITICAL
    ) as cluster:
        address = cluster.scheduler_address
        command = [sys.executable, "-m", "distributed.cli.dask_worker", address]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen([*command, "--no-nanny", "--nthreads", "1"], **quiet) as worker:
            yield address
            worker.kill()


def test_a_cluster_that_loses_all_workers_ends_the_work_with_what_is_done(last_worker, tmp_path):
    told, found = [], {}
    now = tmp_path / "now"
    soon = dask.config.set({"distributed.scheduler.no-workers-timeout": "2s"})
    with soon, executor(cluster=last_worker, tell=told.append) as where:
        with pytest.raises(InputError, match="workers must be at least one .*, got none for 2 s"):
            for place, result in where.finished(tasks.dies_when_told, ["", str(now), ""]):
                found[place] = result
                now.touch()
    assert found == {0: ""}
    (line,) = told
    assert last_worker in line
    assert "waiting up to 2 s" in line


def test_leaving_early_cancels_what_is_queued(address, tmp_path):
    items = [str(tmp_path / str(i)) for i in range(8)]
    with executor(cluster=address) as where:
        results = where.finished(tasks.marked, items)
        next(results)
        results.close()
        time.sleep(1.0)  # in which what is not cancelled would go on
    assert len(list(tmp_path.iterdir())) <= 4  # the two that ran, and at most one more each


def test_a_scheduler_that_is_not_there_is_told_in_one_line():
    soon = dask.config.set({"distributed.comm.timeouts.connect": "500ms"})
    with soon, pytest.raises(InputError, match="scheduler must be reachable") as told:
        done("tcp://127.0.0.1:9", tasks.squared, [1])
    assert "\n" not in str(told.value)
