"""Simulation in time: cost a step, memory, and pycaputo's solver on the same problem.

``python -m tests.benchmarks.bench_simulation`` prints the rows; `rows` returns them.
"""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Callable, Iterator

import numpy as np
from pycaputo.controller import make_fixed_controller
from pycaputo.derivatives import CaputoDerivative
from pycaputo.events import StepAccepted
from pycaputo.fode import caputo
from pycaputo.stepping import evolve
from pymittagleffler import mittag_leffler

from models.constitutive import FittedTerm, ForceModel
from models.simulation import simulate, sine_load
from models.structure import Structure, oscillator

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_DAMPING = 0.4
_DURATION = 4.0 * np.pi


def timed(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the least time of a few runs, s."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def rubbing() -> Structure:
    """Return one degree of freedom with friction and one fractional term."""
    terms = (
        FittedTerm("fractional-derivative", 0.2, {"order": 1.5}),
        FittedTerm("coulomb-friction", 0.1),
    )
    return oscillator(1.0, 1.0, ForceModel(terms))


def cost_a_step() -> Iterator[Row]:
    """Yield the time of 10^5 steps, and how it grows to 10^7."""
    structure, load = rubbing(), sine_load(1.0, 0.1)

    def run(steps: int) -> None:
        simulate(
            structure, load, step=0.01, duration=0.01 * steps, keep_every=max(steps // 10**4, 1),
            estimate_error=False,
        )  # fmt: skip

    run(1000)
    times = {}
    for steps, repeats in ((10**5, 20), (10**6, 3), (10**7, 1)):
        times[steps] = timed(lambda n=steps: run(n), repeats)
    yield "friction and one fractional term, 1e5 steps", 1e3 * times[10**5], "ms", "<= 15 ms"
    for steps in (10**6, 10**7):
        ratio = times[steps] / times[10**5] / (steps / 10**5)
        yield f"the same, {steps:.0e} steps: time a step over that at 1e5", ratio, "times", "1"
    for steps in (10**5, 10**7):
        tracemalloc.start()
        run(steps)
        peak = tracemalloc.get_traced_memory()[1] / 2**20
        tracemalloc.stop()
        yield f"the same, {steps:.0e} steps: peak memory, 1e4 outputs", peak, "MiB", ""


def exact(t: np.ndarray) -> np.ndarray:
    """Return x'' + c D^1.5 x + x = 0 from x = 1 at rest, by partial fractions in s^(1/2)."""
    polynomial = np.array([1.0, _DAMPING, 0.0, 0.0, 1.0])
    roots = np.roots(polynomial)
    residues = 1.0 / np.polyval(np.polyder(polynomial), roots)
    total = sum(
        r * mittag_leffler(w * np.sqrt(t), 0.5, 1.5) for w, r in zip(roots, residues, strict=True)
    )
    return 1.0 - np.real(np.sqrt(t) * total)


def by_pycaputo(steps: int) -> tuple[float, float]:
    """Return time and error of pycaputo's PECE on the equation as four of order one half."""

    def source(t: float, y: np.ndarray) -> np.ndarray:
        return np.array([y[1], y[2], y[3], -y[0] - _DAMPING * y[3]])

    method = caputo.PECE(
        ds=tuple(CaputoDerivative(0.5) for _ in range(4)),
        control=make_fixed_controller(_DURATION / steps, tfinal=_DURATION, nsteps=steps),
        source=source,
        y0=(np.array([1.0, 0.0, 0.0, 0.0]),),
        corrector_iterations=1,
    )
    begin = time.perf_counter()
    states = [(e.t, e.y[0]) for e in evolve(method) if isinstance(e, StepAccepted)]
    spent = time.perf_counter() - begin
    t, x = np.array([s for s in states if s[0] > 0.0]).T
    return spent, float(np.abs(x - exact(t)).max())


def beside_pycaputo() -> Iterator[Row]:
    """Yield both solvers on the Bagley-Torvik equation, free vibration over two cycles."""
    law = ForceModel((FittedTerm("fractional-derivative", _DAMPING, {"order": 1.5}),))
    structure = oscillator(1.0, 1.0, law)
    steps = 10**4

    def run() -> np.ndarray:
        response = simulate(
            structure, step=_DURATION / steps, duration=_DURATION, displacement=1.0,
            estimate_error=False,
        )  # fmt: skip
        return response.displacement[1:, 0] - exact(response.time[1:])

    error = float(np.abs(run()).max())
    ours = timed(
        lambda: simulate(
            structure, step=_DURATION / steps, duration=_DURATION, displacement=1.0,
            estimate_error=False,
        )
    )  # fmt: skip
    other, other_error = by_pycaputo(steps)
    name = "x'' + 0.4 D^1.5 x + x = 0, 1e4 steps over 2 cycles"
    yield f"{name}: time", 1e3 * ours, "ms", ""
    yield f"{name}: greatest error (of 1)", error, "", "<= 1e-6"
    yield f"{name}, pycaputo PECE: time", 1e3 * other, "ms", ""
    yield f"{name}, pycaputo PECE: greatest error", other_error, "", ""
    yield f"{name}: speed", other / ours, "times", "pycaputo, > 1000"


def rows() -> Iterator[Row]:
    """Yield all rows."""
    yield from cost_a_step()
    yield from beside_pycaputo()


if __name__ == "__main__":
    for what, value, unit, beside in rows():
        print(f"{what}: {value:.3g} {unit}" + (f" ({beside})" if beside else ""))
