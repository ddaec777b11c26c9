"""What is remembered of a motion: the last value, for what it was made, as long as it lives."""

import gc
from weakref import ref

from discover.naming.last import Last
from models.motion import sine_motion


def test_a_value_is_made_once_for_a_key_and_anew_for_another():
    last, motion, made = Last(), sine_motion(0.01, 1.0), []

    def value(key):
        return last.of(motion, key, lambda: made.append(key) or len(made))

    assert [value("a"), value("a"), value("b"), value("a")] == [1, 1, 2, 3]
    assert last.of(sine_motion(0.01, 1.0), "a", lambda: -1) == -1
    assert value("a") == 3


def test_it_is_forgotten_with_its_motion():
    class Value:
        pass

    last, motion = Last(), sine_motion(0.01, 1.0)
    kept = ref(last.of(motion, "a", Value))
    assert kept() is not None
    del motion
    gc.collect()
    assert kept() is None
