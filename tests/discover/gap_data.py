"""Sine tests from closed formulas, with white noise: data of the gap search's tests."""

import numpy as np

from discover.records import Campaign, Record

PLAN = [(f, a) for f in (0.5, 1.0, 2.0, 4.0) for a in (0.004, 0.012)]


def record(frequency, amplitude, law, rng, *, noise=0.01, held_out=False, cycles=8):
    rate = 250.0 * frequency
    time = np.arange(int(cycles * rate / frequency)) / rate
    omega = 2.0 * np.pi * frequency
    x = amplitude * np.sin(omega * time)
    v, a = amplitude * omega * np.cos(omega * time), -(omega**2) * x
    force = law(time, x, v, a)
    force = force + noise * np.sqrt(np.mean(force**2)) * rng.standard_normal(time.size)
    return Record(
        f"{frequency:g}hz-{1e3 * amplitude:g}mm.csv", time, force, x,
        frequency=frequency, amplitude=amplitude, held_out=held_out,
    )


def campaign(law, *, seed=0, noise=0.01, held_out=()):
    rng = np.random.default_rng(seed)
    records = tuple(
        record(f, a, law, rng, noise=noise, held_out=i in held_out)
        for i, (f, a) in enumerate(PLAN)
    )
    return Campaign("closed formulas", records)


def device(time, x, v, a):
    return 120.0 * a + 800.0 * v
