import tracemalloc

import numpy as np
import pytest

from models.fractional import derivative, fractional_derivative, stream_derivative
from models.fractional.streaming import advance, begin, stream_operator
from tests.models.fractional import oracles

ORDERS = [-1.0, -0.4, 0.0, 0.05, 0.3, 0.5, 0.7, 0.95, 1.0, 1.05, 1.3, 1.5, 1.8, 1.95, 2.0]


def signal(n, dt):
    t = dt * n
    return 0.3 + np.sin(7.0 * t) + 0.2 * np.cos(3.3 * t)


@pytest.mark.parametrize("kind", ["caputo", "riemann-liouville"])
@pytest.mark.parametrize("scheme", ["gl", "bdf4"])
def test_chunks_equal_the_whole(kind, scheme):
    x = signal(np.arange(60_000), 1e-3)
    whole = derivative(x, ORDERS, 1e-3, kind=kind, scheme=scheme)
    parts = stream_derivative(np.split(x, 60), ORDERS, 1e-3, kind=kind, scheme=scheme)
    found = np.concatenate(list(parts), axis=1)
    for k in range(len(ORDERS)):
        assert oracles.relative_rms(found[k, 1:], whole[k, 1:]) < 1e-9
        assert np.max(np.abs(found[k] - whole[k])) < 1e-8 * np.max(np.abs(whole[k, 1:]))


@pytest.mark.parametrize("kind", ["caputo", "riemann-liouville"])
@pytest.mark.parametrize("size", [377, 5000])
@pytest.mark.parametrize("top", [0.95, 1.95])
def test_auto_in_pieces_equals_the_whole(kind, size, top):
    # Fine sampling: the stride is longer than a chunk of 377 samples can hold.
    orders = [order for order in ORDERS if order <= top]
    x = signal(np.arange(30_000), 2e-5)
    whole = fractional_derivative(x, orders, 2e-5, kind=kind)
    assert whole.stride > 1
    chunks = np.split(x, np.arange(size, x.size, size))
    found = np.concatenate(list(stream_derivative(chunks, orders, 2e-5, kind=kind)), axis=1)
    for k in range(len(orders)):
        assert oracles.relative_rms(found[k, 1:], whole.values[k, 1:]) < 1e-9


@pytest.mark.parametrize("order", [0.05, 0.7, 1.3, 1.95])
def test_pieces_against_the_exact_derivative(order):
    t = 4e-5 * np.arange(100_000)
    chosen = np.linspace(1, t.size - 1, 60).astype(int)
    exact = oracles.sine(order, 2.0 * np.pi, 0.7, t[chosen], caputo=True)
    parts = stream_derivative(np.split(np.sin(2.0 * np.pi * t + 0.7), 40), [order], 4e-5)
    found = np.concatenate(list(parts), axis=1)[0]
    assert oracles.relative_rms(found[chosen], exact) < 1e-8


def test_any_split_gives_the_same():
    x = signal(np.arange(20_000), 1e-3)
    cuts = np.sort(np.random.default_rng(3).integers(0, 20_000, 25))
    pieces = [*np.split(x, cuts), np.empty(0)]
    parts = list(stream_derivative(pieces, [0.5, 1.5], 1e-3, scheme="bdf3"))
    assert [part.shape[1] for part in parts] == [piece.size for piece in pieces]
    whole = derivative(x, [0.5, 1.5], 1e-3, scheme="bdf3")
    np.testing.assert_allclose(
        np.concatenate(parts, axis=1), whole, atol=1e-9 * np.abs(whole).max()
    )


def test_a_million_samples_in_constant_memory():
    dt, size, chunks = 1e-3, 10_000, 100
    x = signal(np.arange(size * chunks), dt)
    whole = derivative(x, 1.5, dt, scheme="bdf4")

    def feed(count):
        for i in range(count):
            yield x[i * size : (i + 1) * size]

    def run(count):
        worst = 0.0
        for i, part in enumerate(stream_derivative(feed(count), [1.5], dt, scheme="bdf4")):
            rest = part[0] - whole[i * size : (i + 1) * size]
            worst = max(worst, float(np.sqrt(np.mean(rest**2))))
        return worst

    assert run(chunks) < 1e-8 * np.sqrt(np.mean(whole**2))
    peaks = []
    for count in (10, 40):
        tracemalloc.start()
        run(count)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.05 * peaks[0]


def test_auto_scheme_streams_and_states_are_not_changed():
    x = signal(np.arange(5000), 1e-3)
    found = np.concatenate(list(stream_derivative([x[:2500], x[2500:]], [1.0], 1e-3)), axis=1)[0]
    t = 1e-3 * np.arange(5000)
    assert oracles.relative_rms(found, 7.0 * np.cos(7.0 * t) - 0.66 * np.sin(3.3 * t)) < 1e-9
    operator = stream_operator([0.5], 1e-3)
    state = begin(operator, x)
    first = advance(operator, state, x[:100])[1]
    again = advance(operator, state, x[:100])[1]
    np.testing.assert_array_equal(first, again)


def test_nothing_in_nothing_out():
    assert list(stream_derivative([], [0.5], 1.0)) == []
    assert [part.shape for part in stream_derivative([[], []], [0.5], 1.0)] == [(1, 0), (1, 0)]
