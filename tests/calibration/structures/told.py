"""What a campaign can tell: nats by which the best rival misses the noise-free force.

A question that the records can't answer is not asked. The columns here are this study's own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy import fft, linalg

from tests.calibration.structures.devices import CORES
from tests.calibration.structures.friction import along
from tests.calibration.structures.memory import stops
from tests.calibration.structures.motion import Motion
from tests.calibration.structures.noise import Noise
from tests.calibration.structures.plans import Run

Array = np.ndarray

ORDERS = tuple(float(o) for o in np.round(np.arange(0.2, 1.99, 0.05), 2))
EXPONENTS = (1.6, 1.7, 1.75, 1.8, 1.9)
_LINES = 30.0  # multiple of the motion's frequency up to which lines are compared
_RIDGE = 1e-11


@dataclass(frozen=True)
class Library:
    """Columns by name, in one order for all records."""

    names: tuple[str, ...]
    """Of the columns."""

    def places(self, names: Sequence[str]) -> list[int]:
        """Return the columns' places."""
        return [self.names.index(name) for name in names]


FRICTION = ("jump", "tanh0", "tanh1", "tanh2", "stop0", "stop1", "stop2")
EXTRAS = (
    "stiffness", "cubic", "offset", "asymmetric", "asymmetric-quadratic", "rate", "rate-of-rate",
    "place", "place-linear", "place-even",
)
FLUID = (
    "a", "v", "v|v|", *(f"|v|^{p}" for p in EXPONENTS), *(f"D^{o}" for o in ORDERS),
)
LIBRARY = Library((*FLUID, *FRICTION, *EXTRAS))


def cores() -> dict[str, list[tuple[str, ...]]]:
    """Return each core's choices of columns; two neighbouring orders stand for all between."""
    return {
        "FOIM": [(f"D^{o}", f"D^{p}") for o, p in pairwise(ORDERS)],
        "IOIM-linear": [("a", "v")],
        "IOIM-laminar": [("a", "v", "v|v|")],
        "IOIM-turbulent": [("a", "v", "v|v|", f"|v|^{p}") for p in EXPONENTS],
    }


HOLDS = {
    "FOIM": ("FOIM",),
    "IOIM-linear": ("IOIM-linear", "IOIM-laminar", "IOIM-turbulent"),
    "IOIM-laminar": ("IOIM-laminar", "IOIM-turbulent"),
    "IOIM-turbulent": ("IOIM-turbulent",),
}
"""Cores that hold a core as a special case: no record tells against them."""


def columns(motion: Motion, fluid: Array, direction: Array, scales: tuple[float, float]) -> Array:
    """Return the columns (C, N) of a record; scales are a speed (m/s) and a displacement (m)."""
    v, x = motion.v, motion.x
    step = float(motion.time[1] - motion.time[0])
    speed, stroke = scales
    rate = np.gradient(fluid, step)
    rows = [motion.a, v, v * np.abs(v)]
    rows += [np.abs(v) ** p * np.sign(v) for p in EXPONENTS]
    rows += [motion.samples(o) for o in ORDERS]
    rows.append(np.sign(v))
    rows += [np.tanh(v / (speed * s)) for s in (0.003, 0.02, 0.08)]
    lengths = np.array([2e-5, 1e-4, 4e-4])
    rows += list(along(motion, lambda path: stops(path, lengths)))
    s = x / stroke
    rows += [x, x**3, np.ones(v.size), np.abs(v), v**2, rate, np.gradient(rate, step)]
    rows += [direction * s**2, direction * s, direction * np.abs(s)]
    return np.stack(rows)


def whitened(values: Array, run: Run, noise: Noise, level: float) -> Array:
    """Return real lines (..., L) in units of the noise, up to a multiple of the frequency."""
    size = values.shape[-1]
    frequency = fft.rfftfreq(size, 1.0 / run.sampling)
    kept = frequency <= _LINES * run.frequency
    spectrum = np.asarray(fft.rfft(values, norm="ortho"))[..., kept]
    weight = 1.0 / (level * np.sqrt(noise.power(frequency[kept], run.sampling)))
    double = np.full(weight.size, np.sqrt(2.0))
    double[0] = 1.0
    spectrum = spectrum * weight * double
    return np.concatenate([spectrum.real, spectrum.imag], axis=-1)


@dataclass(frozen=True, eq=False)
class Evidence:
    """Products of whitened columns and target, by record."""

    products: Array
    """(R, C + 1, C + 1); the last column is the target."""

    def best(
        self, records: Sequence[int], chosen: Sequence[str] = CORES, *, beside: Sequence[str] = ()
    ) -> float:
        """Return the least that any of some cores leaves, with friction's bank beside it."""
        total = self.products[list(records)].sum(axis=0)
        options = cores()
        return min(
            left(total, LIBRARY.places((*option, *FRICTION, *beside)), between=core == "FOIM")
            for core in chosen
            for option in options[core]
        )


def left(product: Array, places: Sequence[int], *, between: bool) -> float:
    """Return half of what columns leave of the last column's square.

    With `between`, the first two mix with equal signs only: an order between theirs.
    """
    own = np.asarray(places)
    square, cross = product[np.ix_(own, own)], product[own, -1]
    scale = np.sqrt(np.maximum(np.diag(square), 1e-300))
    scaled = square / np.outer(scale, scale)
    scaled[np.diag_indices_from(scaled)] += _RIDGE
    found = linalg.solve(scaled, cross / scale, assume_a="pos")
    if between and found[0] * found[1] < 0.0:
        # No order between the two: the better one of them alone.
        return min(left(product, [places[i], *places[2:]], between=False) for i in (0, 1))
    return 0.5 * float(max(product[-1, -1] - cross / scale @ found, 0.0))


def evidence(
    runs: Sequence[Run], targets: Sequence[Array], fluids: Sequence[Array],
    directions: Sequence[Array], noise: Noise, levels: Sequence[float],
) -> Evidence:
    """Return the products of a campaign.

    Parameters
    ----------
    runs : sequence of Run
        The motions.
    targets : sequence of array
        (N,) what is to be explained of each record, N.
    fluids, directions : sequence of array
        (N,) the fluid's force, N, and friction over its size.
    noise : Noise
        Its colour.
    levels : sequence of float
        Its rms in each record, N.
    """
    scales = (
        max(r.motion.top_speed for r in runs), max(r.motion.stroke for r in runs),
    )
    found = []
    for run, target, fluid, direction, level in zip(
        runs, targets, fluids, directions, levels, strict=True
    ):
        rows = np.vstack([columns(run.motion, fluid, direction, scales), target])
        lines = whitened(rows, run, noise, level)
        found.append(lines @ lines.T)
    return Evidence(np.stack(found))


def rivals(core: str) -> tuple[str, ...]:
    """Return the cores that don't hold a core as a special case."""
    return tuple(c for c in CORES if c not in HOLDS[core])


def nearest_core(
    found: Evidence, core: str, records: Sequence[int], beside: Sequence[str] = ()
) -> float:
    """Return what the nearest rival core leaves of some records, alone or with one extra."""
    tried: list[tuple[str, ...]] = [()] + [(e,) for e in EXTRAS if e not in beside]
    return min(found.best(records, rivals(core), beside=(*beside, *e)) for e in tried)


def nearest_extra(found: Evidence, own: Sequence[str]) -> float:
    """Return what is left by any core with the best extra that isn't one's own, or with none."""
    records = range(found.products.shape[0])
    tried: list[tuple[str, ...]] = [()] + [(e,) for e in EXTRAS if e not in own]
    return min(found.best(records, beside=e) for e in tried)


def without_boundary(found: Evidence, beside: Sequence[str] = ()) -> float:
    """Return what the best single band leaves, alone or with one extra."""
    records = range(found.products.shape[0])
    tried: list[tuple[str, ...]] = [()] + [(e,) for e in EXTRAS if e not in beside]
    return min(found.best(records, beside=(*beside, *e)) for e in tried)


def pieces(found: Evidence, order: Sequence[int], cuts: Sequence[int]) -> float:
    """Return what bands between given cuts of the records in an order leave."""
    edges = [0, *cuts, len(order)]
    return sum(found.best(order[a:b]) for a, b in pairwise(edges))


def best_cuts(found: Evidence, order: Sequence[int], count: int, least: int = 3) -> float:
    """Return the least that bands between any such number of cuts leave."""
    size = len(order)
    ends = range(least, size - least + 1)
    first = {b: found.best(order[:b]) for b in ends}
    last = {a: found.best(order[a:]) for a in ends}
    if count == 1:
        return min(first[c] + last[c] for c in ends)
    best = np.inf
    for a in ends:
        for b in range(a + least, size - least + 1):
            if first[a] + last[b] < best:
                best = min(best, first[a] + found.best(order[a:b]) + last[b])
    return float(best)
