"""Bands along a coordinate: how many, where they end, and how surely, by exact search.

Windows are sorted by the coordinate. For every contiguous run the best named structure's evidence
is computed from its triangle (runs grow by one window at a time, so triangles are merged and not
made again), and dynamic programming finds the best division into any number of bands. A boundary
costs what coding its place takes, log(W - 1) nats, and prior odds of one to twenty, besides the
parameters of one more model, so that noise alone does not make one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support
from discover.selection.evidence import Scored, score
from discover.triangle import Triangle, WindowRows, merge, triangle_of
from models.checks import Array, Indices

MIN_WINDOWS = 2
MAX_BANDS = 5
_SAME = 1.005  # ratio of coordinates up to which tests count as at the same place
_AGAINST = 3.0  # nats: a boundary is one to twenty before the data


@dataclass(frozen=True)
class Boundary:
    """Where one band ends and the next begins."""

    position: int
    """Number of windows below it, in the order of the coordinate."""
    bracket: tuple[float, float]
    """Coordinate of the windows on either side."""
    interval: tuple[float, float]
    """Of 95 % posterior probability; never tighter than the bracket."""
    value: float
    """Geometric middle of the bracket."""
    positions: Indices
    """(P,) positions of the posterior."""
    probabilities: Array
    """(P,) their posterior, the other boundaries held."""


@dataclass(frozen=True)
class Segmentation:
    """The best division into bands."""

    order: Indices
    """(W,) windows in rising coordinate."""
    coordinate: Array
    """(W,) sorted values."""
    starts: tuple[int, ...]
    """First position of each band; the first is 0."""
    boundaries: tuple[Boundary, ...]
    """One fewer than bands."""
    best: tuple[Scored, ...]
    """Best named structure of each band."""
    log_evidence: Array
    """(B,) of the best division into 1, 2, ... bands, boundaries' cost included."""

    @property
    def bands(self) -> int:
        """Number of bands."""
        return len(self.starts)

    def members(self, band: int) -> Indices:
        """Return the indices of the windows in a band."""
        ends = (*self.starts[1:], self.order.size)
        return self.order[self.starts[band] : ends[band]]


def boundary_cost(windows: int) -> float:
    """Return what a boundary costs among so many windows, nats."""
    return float(np.log(max(windows - 1, 2))) + _AGAINST


def _run_scores(
    triangles: Sequence[Triangle],
    coordinate: Array,
    dictionary: Dictionary,
    supports: Sequence[Support],
    shortest: int,
) -> dict[tuple[int, int], Scored]:
    """Return the best named structure of each run [i, j) of at least `shortest` windows.

    Runs end only where the coordinate changes: tests that share it can't lie in two bands.
    """
    best = {}
    size = len(triangles)
    rows = sum(t.rows for t in triangles)
    changes = np.r_[True, coordinate[1:] > _SAME * coordinate[:-1], True]
    for start in np.flatnonzero(changes[:-1]).tolist():
        merged: Triangle | None = None
        for stop in range(start + 1, size + 1):
            part = triangles[stop - 1]
            merged = part if merged is None else merge((merged, part))
            first = start == 0 or start >= shortest
            last = stop == size or stop <= size - shortest
            if stop - start < min(shortest, size) or not (first and last and changes[stop]):
                continue
            best[start, stop] = score(ProfiledFit(merged, dictionary), supports, rows=rows)[0]
    return best


def _divide(
    runs: dict[tuple[int, int], Scored], size: int, bands: int, cost: float
) -> tuple[float, tuple[int, ...]]:
    """Return the best total and starts of a division into exactly `bands` bands."""
    table: list[dict[int, tuple[float, tuple[int, ...]]]] = [{0: (0.0, ())}]
    for _ in range(bands):
        new: dict[int, tuple[float, tuple[int, ...]]] = {}
        for (start, stop), run in runs.items():
            if start not in table[-1]:
                continue
            before, starts = table[-1][start]
            value = before + run.log_evidence - (cost if start else 0.0)
            if stop not in new or value > new[stop][0]:
                new[stop] = (value, (*starts, start))
        table.append(new)
    return table[-1].get(size, (-np.inf, ()))


def _interval(
    coordinate: Array, positions: Indices, probabilities: Array
) -> tuple[float, float]:
    """Return the highest-probability brackets that hold 95 %, as one interval."""
    order = np.argsort(-probabilities)
    count = int(np.searchsorted(np.cumsum(probabilities[order]), 0.95)) + 1
    kept = positions[order[:count]]
    return float(coordinate[kept.min() - 1]), float(coordinate[kept.max()])


def _boundary(
    runs: dict[tuple[int, int], Scored], coordinate: Array, left: int, middle: int, right: int
) -> Boundary:
    positions = np.array(
        [p for p in range(left + 1, right) if (left, p) in runs and (p, right) in runs]
    )
    logs = np.array([runs[left, p].log_evidence + runs[p, right].log_evidence for p in positions])
    gaps = np.log(np.maximum(coordinate[positions] / coordinate[positions - 1], 1.0 + 1e-12))
    logs = logs + np.log(gaps)  # uniform in the log of the coordinate, not over tests
    probabilities = np.exp(logs - logsumexp(logs))
    bracket = (float(coordinate[middle - 1]), float(coordinate[middle]))
    low, high = _interval(coordinate, positions, probabilities)
    return Boundary(
        middle,
        bracket,
        (min(low, bracket[0]), max(high, bracket[1])),
        float(np.sqrt(bracket[0] * bracket[1])),
        positions,
        probabilities,
    )


def segment(
    windows: Sequence[WindowRows],
    coordinate: Array,
    dictionary: Dictionary,
    supports: Sequence[Support],
    *,
    bands: int | None = None,
    shortest: int = MIN_WINDOWS,
) -> Segmentation:
    """Return the best division of windows into bands.

    Parameters
    ----------
    windows : sequence of WindowRows
        Fitted windows, with their model error.
    coordinate : ndarray, shape (W,)
        Positive; Dean number, speed amplitude or frequency of each.
    dictionary : Dictionary
        Of their columns.
    supports : sequence of Support
        What a band may hold.
    bands : int, optional
        Fixes the number; otherwise the evidence does, up to five.
    shortest : int
        Fewest windows in a band.

    Returns
    -------
    Segmentation
    """
    order = np.argsort(coordinate, kind="stable")
    sorted_coordinate = coordinate[order]
    triangles = [triangle_of([windows[i]]) for i in order]
    runs = _run_scores(triangles, sorted_coordinate, dictionary, supports, shortest)
    size = order.size
    most = max(1, min(MAX_BANDS, size // shortest))
    cost = boundary_cost(size)
    counts = range(1, most + 1) if bands is None else range(1, max(bands, 1) + 1)
    divisions = [_divide(runs, size, count, cost) for count in counts]
    values = np.array([d[0] for d in divisions])
    chosen = int(values.argmax()) if bands is None else len(divisions) - 1
    while chosen > 0 and not np.isfinite(values[chosen]):
        chosen -= 1
    starts = divisions[chosen][1] or (0,)
    ends = (*starts[1:], size)
    boundaries = tuple(
        _boundary(runs, sorted_coordinate, starts[b], starts[b + 1], ends[b + 1])
        for b in range(len(starts) - 1)
    )
    return Segmentation(
        order=order,
        coordinate=sorted_coordinate,
        starts=starts,
        boundaries=boundaries,
        best=tuple(runs[a, b] for a, b in zip(starts, ends, strict=True)),
        log_evidence=values,
    )
