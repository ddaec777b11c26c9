import time

import pytest

from discover.executor import Lost, executor
from tests.discover.executor import tasks


def done(jobs, function, items):
    with executor(jobs) as where:
        return dict(where.finished(function, items))


@pytest.mark.parametrize("jobs", [1, 2])
def test_every_item_is_done_and_knows_its_place(jobs):
    assert done(jobs, tasks.squared, [3, 1, 2, 5, 4]) == {0: 9, 1: 1, 2: 4, 3: 25, 4: 16}


def test_nothing_to_do_is_nothing_done():
    assert done(2, tasks.squared, []) == {}


def test_results_come_as_they_are_done():
    with executor(2) as where:
        first, _ = next(where.finished(tasks.slow, [3.0, 0.01]))
    assert first == 1


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_of_the_work_is_the_callers(jobs):
    with pytest.raises(ValueError, match="three is refused"):
        done(jobs, tasks.fails, [1, 2, 3, 4])


def test_an_item_whose_process_died_is_done_again(tmp_path):
    items = ["", str(tmp_path / "once"), "", ""]
    assert done(2, tasks.dies_once, items) == dict(enumerate(items))


def test_an_item_that_kills_every_process_is_given_up_and_the_others_are_done():
    found = done(2, tasks.dies, [1, -1, 2, 3])
    assert isinstance(found.pop(1), Lost)
    assert found == {0: 1, 2: 2, 3: 3}


def test_leaving_early_cancels_what_is_queued(tmp_path):
    items = [str(tmp_path / str(i)) for i in range(8)]
    with executor(2) as where:
        results = where.finished(tasks.marked, items)
        next(results)
        results.close()
        time.sleep(1.0)  # in which what is not cancelled would go on
    assert len(list(tmp_path.iterdir())) <= 4  # the two that ran, and at most one more each
