"""A long sine test through the whole of `inerter discover`: its memory is that of a short one."""

import pytest

from tests.benchmarks.bench_long import SMALL, discovered


@pytest.mark.sweep
def test_memory_does_not_grow_with_the_record():
    _, small = discovered(SMALL)
    _, first = discovered(6_000_000)
    _, second = discovered(12_000_000)
    assert first - small < 700.0  # MiB: what is held of a long record, whatever its length
    assert second - first < 100.0  # three columns more would take 144
