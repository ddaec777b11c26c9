import math
import threading

from models.compiled import compiled


@compiled()
def _inner(value: float) -> float:
    """Add one."""
    return value + 1.0


@compiled(error_model="numpy")
def _outer(value: float) -> float:
    return _inner(value) / (value - 1.0)


def test_a_function_that_calls_another_is_compiled_with_it():
    assert _outer(3.0) == 2.0


def test_the_options_reach_the_compiler():
    assert math.isinf(_outer(1.0))  # Python would raise


def test_threads_that_call_first_share_one_compilation():
    calls = []

    @compiled()
    def tripled(value):
        return 3.0 * value

    threads = [threading.Thread(target=lambda: calls.append(tripled.dispatcher())) for _ in "abcd"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert tripled(2.0) == 6.0
    assert len({id(c) for c in calls}) == 1


def test_it_keeps_what_the_function_says_of_itself():
    assert _inner.__wrapped__(1.0) == 2.0
    assert "Add one" in _inner.__doc__
