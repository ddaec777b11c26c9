"""A whole gap search on 16 sine tests: every effect of the catalogue, all rounds, all judging.

``python -m tests.benchmarks search`` prints the rows and keeps them; `rows` returns them.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy.integrate import solve_ivp

from discover.gap import close_gap
from discover.records import Campaign
from models.checks import Array
from tests.benchmarks.bench_study import Row, sine_records

_AMPLITUDES = (0.003, 0.006, 0.012, 0.020)
_FREQUENCIES = (0.3, 0.8, 2.0, 5.0)
_CYCLES = 8.3
_SIZES = (2_500, 10_000)
_GAP, _FLANK, _LOSS = 4e-5, 3e8, 2e5
"""m of play on either side, N/m and N s/m of what it ends at."""
_PERIODS, _POINTS = 5, 65536
_TERMS = "fit:inertia,viscous-damping,quadratic-damping,coulomb-friction"


def campaign(samples: int, hidden: str) -> Campaign:
    """Return 16 tests of a laminar device with something hidden, 1 % noise."""

    def law(omega: float, angle: Array, x: Array, v: Array) -> Array:
        if hidden == "play":
            return _through_play(omega, angle, float(np.hypot(x, v / omega).max()))
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


def _through_play(omega: float, angle: Array, amplitude: float) -> Array:
    """Return the force (N,) of the same device, without its friction, behind play; by SciPy."""

    def carried(turned: Array, place: Array, speed: Array) -> Array:
        depth, pace = amplitude * np.sin(turned) - place, amplitude * omega * np.cos(turned) - speed
        beyond = depth - np.clip(depth, -_GAP, _GAP)
        force = _FLANK * beyond + _LOSS * pace * (beyond != 0.0)
        return np.where(beyond > 0.0, np.maximum(force, 0.0), np.minimum(force, 0.0))

    def slope(turned: float, state: Array) -> tuple[float, float]:
        place, speed = state
        resisted = 2e3 * speed + 2e4 * speed * abs(speed)
        pull = float(carried(np.float64(turned), place, speed)) - resisted
        return speed / omega, pull / 300.0 / omega

    turn = 2.0 * np.pi
    at = turn * (_PERIODS - 1 + np.arange(_POINTS + 1) / _POINTS)
    found = solve_ivp(
        slope, (0.0, at[-1]), (0.0, amplitude * omega), method="LSODA", t_eval=at, rtol=1e-6,
        atol=1e-10, max_step=turn / 1000.0,
    )  # fmt: skip
    cycle = carried(at, *found.y)
    return np.interp(np.mod(angle, turn), at - at[0], cycle)


def rows() -> Iterator[Row]:
    """Yield all rows."""
    close_gap(campaign(1_000, "stiffness"), _TERMS)  # compiles
    for hidden in ("nothing", "stiffness", "lag", "play"):
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
