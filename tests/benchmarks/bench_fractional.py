"""Fractional derivatives side by side, in one run: bare FFT, pycaputo, differint.

``python -m tests.benchmarks fractional`` prints the rows and keeps them; `rows` returns them.
Times are medians of interleaved runs with two FFT threads.
"""

from __future__ import annotations

import importlib.util
import statistics
import time
import tracemalloc
import warnings
from collections.abc import Callable, Iterator

import numpy as np
import scipy.fft
from pycaputo.differentiation import diff
from pycaputo.differentiation.grunwald_letnikov import GrunwaldLetnikov
from pycaputo.grid import make_uniform_points

from models.fractional import derivative, fractional_derivative, stream_derivative
from models.fractional.convolution import clear_cache, padded_length
from models.fractional.correction import head_corrections
from tests.benchmarks.results import Row
from tests.models.fractional import oracles

OMEGA = 2.0 * np.pi
CYCLES = 20.0
THREADS = 2


def medians(*works: Callable[[], object], repeats: int = 15) -> list[float]:
    """Return the median time of each, s; the runs take turns, after one to warm up."""
    times: list[list[float]] = [[] for _ in works]
    for run in range(repeats + 1):
        for work, kept in zip(works, times, strict=True):
            begin = time.perf_counter()
            work()
            if run:
                kept.append(time.perf_counter() - begin)
    return [statistics.median(kept) for kept in times]


def tapered(count: int, name: str = "quintic", length: float = 2.0) -> tuple[np.ndarray, float]:
    """Return a sine of 20 cycles that grows by a smoothstep, and its sampling interval."""
    dt = CYCLES / count
    return oracles.tapered(name, length, OMEGA, dt * np.arange(count)), dt


def error_of(values: np.ndarray, order: float, name: str = "quintic", length: float = 2.0) -> float:
    """Return the relative rms error against mpmath at 160 samples.

    A quarter each at the start and round the end of the taper, where errors are largest.
    """
    count = values.size
    near = int(length / CYCLES * count) + np.arange(-10, 30)
    spread = np.linspace(1, count - 1, 80).astype(int)
    chosen = np.unique(np.concatenate([np.arange(1, 41), near[near < count], spread]))
    t = CYCLES / count * chosen
    exact = oracles.tapered_derivative(name, length, order, OMEGA, t)
    return oracles.relative_rms(values[chosen], exact)


def one_order() -> Iterator[Row]:
    """Yield error and time of single derivatives beside one padded rfft and irfft."""
    for count, bar in ((10_000, "1e-7"), (100_000, "1e-8")):
        length = padded_length(count)
        for order in (0.5, 1.5):
            for name, ramp in (("quintic", 2.0), ("cubic", 2.3), ("cubic", 20.0)):
                x, dt = tapered(count, name, ramp)
                result = fractional_derivative(x, order, dt)
                what = f"{name} smoothstep over {ramp:g} cycles, order {order}, N = {count:,}"
                yield (
                    f"{what}: relative rms error ({result.scheme})",
                    error_of(result.values, order, name, ramp),
                    "",
                    f"<= {bar}",
                )
            ours, floor = medians(
                lambda x=x, order=order, dt=dt: derivative(x, order, dt),
                lambda x=x, length=length: scipy.fft.irfft(scipy.fft.rfft(x, length), length),
                repeats=41,
            )
            what = f"order {order}, N = {count:,}"
            yield f"{what}: time, scheme auto", 1e3 * ours, "ms", ""
            yield f"{what}: one padded rfft + irfft", 1e3 * floor, "ms", ""
            yield f"{what}: ratio", ours / floor, "times", "<= 2 at N = 100,000"


def every_order() -> Iterator[Row]:
    """Yield error and time for sin(2 pi t + phase) over 4 s, orders from 0.05 to 1.95."""
    count = 100_000
    dt = 4.0 / count
    t = dt * np.arange(count)
    spread = np.geomspace(30, count - 1, 60), np.linspace(30, count - 1, 80)
    chosen = np.unique(np.concatenate([np.arange(1, 30), *spread]).astype(int))
    orders = np.round(np.arange(0.05, 1.951, 0.05), 2)
    starts = {"velocity": 0.0, "position and acceleration": np.pi / 2, "all three": 0.7}
    for name, phase in starts.items():
        x = np.sin(OMEGA * t + phase)
        typical, largest = 0.0, 0.0
        for order in orders:
            exact = oracles.sine(order, OMEGA, phase, t[chosen], caputo=True)
            apart = derivative(x, order, dt)[chosen] - exact
            typical = max(typical, float(np.sqrt(np.mean(apart**2) / np.mean(exact**2))))
            largest = max(largest, float(np.max(np.abs(apart)) / np.max(np.abs(exact))))
        what = f"sine of 4 cycles, starts with {name}, worst of 39 orders, N = {count:,}"
        yield f"{what}: relative rms error", typical, "", "<= 1e-8"
        yield f"{what}: largest error over largest value", largest, "", "<= 1e-8"
    x, length = np.sin(OMEGA * t), padded_length(count)

    def floor() -> None:
        scipy.fft.irfft(scipy.fft.rfft(x, length), length)

    def new_order() -> None:
        clear_cache()
        head_corrections.cache_clear()
        derivative(x, 0.7, dt)

    chosen_orders = (0.05, 0.7, 1.5, 1.95)
    works = [lambda order=order: derivative(x, order, dt) for order in chosen_orders]
    bare, *times = medians(floor, *works, repeats=41)
    for order, seconds in zip(chosen_orders, times, strict=True):
        what = f"sine of 4 cycles, order {order}, N = {count:,}"
        yield f"{what}: time over one padded rfft + irfft", seconds / bare, "times", "<= 2"
    bare, seconds = medians(floor, new_order, repeats=21)
    what = f"sine of 4 cycles, an order met for the first time, N = {count:,}"
    yield f"{what}: time over one padded rfft + irfft", seconds / bare, "times", ""


def many_orders() -> Iterator[Row]:
    """Yield the time of 64 orders at once beside one rfft and 64 irfft in one batch."""
    count = 100_000
    x, dt = tapered(count)
    orders = np.linspace(0.0, 2.0, 64)
    length = padded_length(count)
    rows = np.tile(scipy.fft.rfft(x, length), (64, 1))

    def cold() -> None:
        clear_cache()
        head_corrections.cache_clear()
        derivative(x, orders, dt)

    def floor() -> None:
        scipy.fft.rfft(x, length)
        scipy.fft.irfft(rows, length, axis=-1)

    warm_time, floor_time = medians(lambda: derivative(x, orders, dt), floor, repeats=15)
    cold_time, again = medians(cold, floor, repeats=9)
    moving = np.sin(OMEGA * dt * np.arange(count))
    start_time, third = medians(lambda: derivative(moving, orders, dt), floor, repeats=9)
    what = f"64 orders, N = {count:,}"
    yield f"{what}: one rfft + one batched irfft of 64 rows", 1e3 * floor_time, "ms", ""
    yield f"{what}: time, spectra cached", 1e3 * warm_time, "ms", ""
    yield f"{what}: time, cold", 1e3 * cold_time, "ms", ""
    yield f"{what}: ratio, cached", warm_time / floor_time, "times", "<= 1.5"
    yield f"{what}: ratio, cached, with initial velocity", start_time / third, "times", ""
    yield f"{what}: ratio, cold", cold_time / again, "times", "<= 4"


def initial_velocity() -> Iterator[Row]:
    """Yield the error for a sine that starts moving."""
    for count in (10_000, 100_000, 1_000_000):
        dt = CYCLES / count
        x = np.sin(OMEGA * dt * np.arange(count))
        near, far = np.arange(1, 20), np.linspace(20, count - 1, 80).astype(int)
        chosen = np.concatenate([near, far])
        exact = oracles.sine(1.5, OMEGA, 0.0, dt * chosen, caputo=True)
        result = fractional_derivative(x, 1.5, dt)
        error = oracles.relative_rms(result.values[chosen], exact)
        what = f"sine with initial velocity, Caputo 1.5, N = {count:,}"
        yield f"{what}: relative rms error ({result.scheme})", error, "", "<= 1e-6"


def other_packages() -> Iterator[Row]:
    """Yield errors and times of pycaputo's and differint's Gruenwald-Letnikov."""
    count, order = 100_000, 0.5
    x, dt = tapered(count)
    points = make_uniform_points(count, 0.0, dt * (count - 1))
    begin = time.perf_counter()
    theirs = diff(GrunwaldLetnikov(order), x, points)
    slow = time.perf_counter() - begin
    ours, bare = medians(
        lambda: derivative(x, order, dt),
        lambda: derivative(x, order, dt, kind="grunwald-letnikov"),
        repeats=21,
    )
    what = f"order {order}, N = {count:,}"
    yield f"{what}: pycaputo GrunwaldLetnikov, one run", slow, "s", ""
    yield f"{what}: pycaputo, relative rms error", error_of(theirs, order), "", ""
    yield f"{what}: this package (auto), relative rms error", (
        error_of(derivative(x, order, dt), order)
    ), "", "no more than pycaputo's"
    yield f"{what}: this package (auto), speed", slow / ours, "times", "pycaputo; >= 200"
    plain = derivative(x, order, dt, kind="grunwald-letnikov")
    yield f"{what}: bare sum, relative rms error", error_of(plain, order), "", ""
    yield f"{what}: bare sum, speed", slow / bare, "times", "pycaputo; >= 200"
    if importlib.util.find_spec("differint") is None:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from differint.differint import GL
    begin = time.perf_counter()
    wrapped = GL(order, x, 0.0, dt * (count - 1), count)
    yield f"{what}: differint GL, one run", time.perf_counter() - begin, "s", ""
    yield f"{what}: differint GL, relative rms error", error_of(wrapped, order), "", ""


def streaming() -> Iterator[Row]:
    """Yield difference, time and memory of one pass over a million samples."""
    count, size, dt = 1_000_000, 10_000, 1e-3
    t = dt * np.arange(count)
    x = 0.3 + np.sin(7.0 * t) + 0.2 * np.cos(3.3 * t)
    orders = [0.5, 1.5]
    whole = derivative(x, orders, dt, scheme="bdf4")

    def run(samples: int) -> float:
        chunks = (x[i : i + size] for i in range(0, samples, size))
        apart, total = np.zeros(2), np.zeros(2)
        parts = stream_derivative(chunks, orders, dt, scheme="bdf4")
        for i, part in enumerate(parts):
            expected = whole[:, i * size : (i + 1) * size]
            apart += np.sum((part - expected) ** 2, axis=1)
            total += np.sum(expected**2, axis=1)
        return float(np.max(np.sqrt(apart / total)))

    what = "2 orders, 1e6 samples in chunks of 1e4"
    yield f"{what}: streaming against whole, relative rms", run(count), "", "<= 1e-8"
    streamed, at_once = medians(
        lambda: run(count), lambda: derivative(x, orders, dt, scheme="bdf4"), repeats=3
    )
    yield f"{what}: streaming", streamed, "s", ""
    yield f"{what}: whole", at_once, "s", ""
    for samples in (100_000, 1_000_000):
        tracemalloc.start()
        run(samples)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        yield f"streaming {samples:,} samples: peak memory", peak / 2**20, "MiB", "the same"


def noisy() -> Iterator[Row]:
    """Yield what noise leaves: auto beside plain GL on the raw samples."""
    rate, frequency, order = 1000.0, 5.0, 1.89
    t = np.arange(10_000) / rate
    omega = 2.0 * np.pi * frequency
    noise = 1e-4 * np.random.default_rng(0).standard_normal(t.size)
    chosen = np.arange(27, t.size, 53)
    cases = {
        "sine": (
            np.sin(omega * t + 0.4),
            oracles.sine(order, omega, 0.4, t[chosen], caputo=True),
        ),
        "sine that grows over 2 s": (
            oracles.tapered("quintic", 2.0, omega, t),
            oracles.tapered_derivative("quintic", 2.0, order, omega, t[chosen]),
        ),
    }
    for name, (clean, exact) in cases.items():
        result = fractional_derivative(clean + noise, order, 1.0 / rate)
        plain = derivative(clean + noise, order, 1.0 / rate, scheme="gl")
        error = oracles.relative_rms(result.values[chosen], exact)
        other = oracles.relative_rms(plain[chosen], exact)
        what = f"{name}, 5 Hz, 1 kHz, noise 1e-4, order {order}"
        yield f"{what}: auto ({result.scheme}), relative rms error", error, "", ""
        yield f"{what}: error that auto expects", float(result.error), "", ""
        yield f"{what}: plain GL, relative rms error", other, "", ""
        yield f"{what}: closer", other / error, "times", ">= 20"


def rows() -> list[Row]:
    """Return all rows of this file."""
    causal = (one_order, every_order, many_orders, initial_velocity)
    parts = (*causal, other_packages, streaming, noisy)
    with scipy.fft.set_workers(THREADS):
        return [row for part in parts for row in part()]
