"""A whole gap search on 16 sine tests: every effect of the catalogue, all rounds, all judging.

``python -m tests.benchmarks search`` prints the rows and keeps them; `rows` returns them.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import product

import numpy as np

from discover.gap import close_gap
from discover.records import Campaign
from models.checks import Array
from tests.benchmarks.bench_study import Row, sine_records

_AMPLITUDES = (0.003, 0.006, 0.012, 0.020)
_FREQUENCIES = (0.3, 0.8, 2.0, 5.0)
_CYCLES = 8.3
_SIZES = (2_500, 10_000)
_TERMS = "fit:inertia,viscous-damping,quadratic-damping,coulomb-friction"


def campaign(samples: int, hidden: str) -> Campaign:
    """Return 16 tests of a laminar device with something hidden, 1 % noise."""

    def law(omega: float, angle: Array, x: Array, v: Array) -> Array:
        force = -300.0 * omega**2 * x + 2e3 * v + 2e4 * v * np.abs(v) + 300.0 * np.tanh(v / 1e-3)
        if hidden == "stiffness":
            force += 4e4 * x
        elif hidden == "lag":  # friction late by one phase in every test: no entry is that
            force += 200.0 * np.clip(np.sin(angle - 0.6) / 0.4, -1.0, 1.0)
        return np.asarray(force)

    records = sine_records(
        law, product(_AMPLITUDES, _FREQUENCIES), samples, cycles=_CYCLES, noise=0.01,
        displacement_noise=1e-7, seed=1,
    )  # fmt: skip
    return Campaign("16 tests", records, content_hash="0")


def rows() -> Iterator[Row]:
    """Yield all rows."""
    close_gap(campaign(1_000, "stiffness"), _TERMS)  # compiles
    for hidden in ("nothing", "stiffness", "lag"):
        for samples in _SIZES:
            tests = campaign(samples, hidden)
            begin = time.perf_counter()
            found = close_gap(tests, _TERMS)
            seconds = time.perf_counter() - begin
            rounds = [f"{r.effect} at {r.probability:.2f}" for r in found.rounds]
            yield f"16 records of {samples:,} samples, hidden: {hidden}", seconds, "s", (
                f"{found.verdict}, named {', '.join(rounds) or 'nothing'}"
            )


if __name__ == "__main__":
    for what, value, unit, beside in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({beside})" if beside else ""))
