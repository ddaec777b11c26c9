"""A whole study of 40 sine tests: compression of the samples, and all that comes after it.

``python -m tests.benchmarks study`` prints the rows and keeps them; `rows` returns them.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from itertools import product

import numpy as np

from discover.bands.ways import found
from discover.records import Campaign, Record
from discover.study import StudyOptions, run_study
from discover.study.prepare import prepare
from models.checks import Array
from models.device import Device

Law = Callable[[float, Array, Array, Array], Array]
"""Force (N,) from omega (rad/s), the angle, displacement and velocity, each (N,)."""
Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_AMPLITUDES = (0.005, 0.010, 0.020, 0.030)
_FREQUENCIES = np.geomspace(0.1, 6.0, 10)
_CYCLES = 10.3
_SIZES = (5_000, 20_000)
_REPEATS = 3


def sine_records(
    law: Law, plan: Iterable[tuple[float, float]], samples: int, *, cycles: float, noise: float,
    displacement_noise: float, seed: int,
) -> tuple[Record, ...]:  # fmt: skip
    """Return a sine test for each (amplitude, frequency), m and Hz, with white noise.

    The law gives the force (N,) from omega, the angle (N,), x and v; `noise` is a share of it.
    """
    rng = np.random.default_rng(seed)
    records = []
    for amplitude, frequency in plan:
        omega = 2.0 * np.pi * frequency
        seconds = np.arange(samples) * (cycles / frequency / samples)
        angle = omega * seconds + rng.uniform(0.0, 2.0 * np.pi)
        x, v = amplitude * np.sin(angle), amplitude * omega * np.cos(angle)
        force = law(omega, angle, x, v)
        force = force + noise * np.sqrt(np.mean(force**2)) * rng.standard_normal(samples)
        x = x + displacement_noise * rng.standard_normal(samples)
        records.append(Record(f"{frequency:.3g}hz-{1e3 * amplitude:g}mm", seconds, force, x))
    return tuple(records)


def campaign(samples: int) -> Campaign:
    """Return 40 tests of a laminar device, each of so many samples, 2 % noise."""

    def law(omega: float, angle: Array, x: Array, v: Array) -> Array:
        return np.asarray(
            -370.38 * omega**2 * x + 3e3 * v + 3e4 * v * np.abs(v) + 400.0 * np.sign(v)
        )

    records = sine_records(
        law, product(_AMPLITUDES, _FREQUENCIES), samples, cycles=_CYCLES, noise=0.02,
        displacement_noise=1e-6, seed=0,
    )  # fmt: skip
    return Campaign("40 tests", records, Device.preset("device-12"), content_hash="0")


def measured(samples: int) -> tuple[float, float, float]:
    """Return the least times of compression, of the search on rows and of the whole, s.

    Of the processor, as others may share it. What is found in a record is kept with it, so the
    whole study gets records of its own.
    """
    options = StudyOptions()
    times = np.empty((_REPEATS, 3))
    for row in times:
        first, other = campaign(samples), campaign(samples)
        begin = time.process_time()
        prepared = prepare(first, options)
        compressed = time.process_time()
        found(prepared.device)
        searched = time.process_time()
        run_study(other, options)
        row[:] = compressed - begin, searched - compressed, time.process_time() - searched
    return tuple(times.min(axis=0).tolist())


def rows() -> Iterator[Row]:
    """Yield all rows."""
    run_study(Campaign("warm", campaign(1_000).records[::4], content_hash="0"))
    search = {}
    for samples in _SIZES:
        compression, search[samples], whole = measured(samples)
        name = f"40 records of {samples:,} samples"
        rate = 1e-6 * 40 * samples / compression
        yield f"{name}: compression to rows", compression, "s", f"{rate:.2g} million samples/s"
        yield f"{name}: search for bands and structures, after it", search[samples], "s", ""
        rest = whole - compression - search[samples]
        yield f"{name}: intervals, accuracy, next test", rest, "s", ""
        yield f"{name}: run_study in all", whole, "s", "one process"
    few, many = _SIZES
    ratio = search[many] / search[few]
    yield f"search at {many:,} over that at {few:,} samples a record", ratio, "times", "1"


if __name__ == "__main__":
    for what, value, unit, beside in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({beside})" if beside else ""))
