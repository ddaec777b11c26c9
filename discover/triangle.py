"""Rows of a campaign for regression, and their reduction to triangles by QR.

Every window's spectral lines become real rows. Rows of equal variance (a block: a harmonic, or a
part of the band) are reduced once by QR to at most K + 1 rows, whatever the number of samples.
Blocks stack, whiten and reduce again: any set of windows costs K^3.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from discover.library.dictionary import Dictionary
from discover.motion_fit.observation import Observation, Window, real_rows
from models.checks import Array, Indices

_SUB_BANDS = 6
_REDUCE_ABOVE = 1.5  # rows per column from which a block is worth reducing


@dataclass(frozen=True)
class WindowRows:
    """A window's rows: columns and force, with the variance of each block of rows."""

    matrix: Array
    """(R, K + 1) columns and, last, the force, N."""
    block: Indices
    """(R,) the block of each row."""
    count: Array
    """(B,) number of rows that each block had before it was reduced."""
    variance: Array
    """(B,) noise variance of a block's rows, N^2."""
    discrepancy: Array
    """(B,) variance of the model's error in a block's rows, N^2; none until it is found."""
    record: int
    """Index of the record among the observations."""
    frequency: float
    """Hz."""
    amplitude: float
    """m."""
    speed: float
    """m/s."""
    power: float
    """Mean square of the measured force, N^2."""
    rest: float
    """Part of it in none of the rows, N^2."""
    noise_power: float
    """Mean square of the force's noise, N^2."""
    share: float
    """Part of the record's duration."""

    @property
    def total_variance(self) -> Array:
        """(B,) noise and model error, N^2."""
        return self.variance + self.discrepancy

    @property
    def whitened(self) -> Array:
        """(R, K + 1) rows over their standard deviation."""
        return self.matrix / np.sqrt(self.total_variance)[self.block][:, None]

    @property
    def log_determinant(self) -> float:
        """Sum of log variances over all rows, reduced ones included."""
        return float(self.count @ np.log(self.total_variance))


@dataclass(frozen=True)
class Triangle:
    """Least squares in small: R (m, K + 1) with ||R[:, S] c - R[:, -1]||^2 as on all rows."""

    matrix: Array
    """(m, K + 1), whitened; the force is the last column."""
    rows: int
    """Number of rows that it stands for."""
    log_determinant: float
    """Sum of the rows' log variances."""
    unit: float = 1.0
    """Standard deviation of a row's error: 1 where whitened."""

    @property
    def columns(self) -> Array:
        """(m, K)."""
        return self.matrix[:, :-1]

    @property
    def target(self) -> Array:
        """(m,)."""
        return self.matrix[:, -1]


def reduce_rows(matrix: Array) -> Array:
    """Return the triangle of a matrix that is taller than wide; others as they are."""
    if matrix.shape[0] <= _REDUCE_ABOVE * matrix.shape[1]:
        return matrix
    return np.asarray(np.linalg.qr(matrix, mode="r"))


def merge(triangles: Iterable[Triangle]) -> Triangle:
    """Return the triangle of all rows together."""
    parts = list(triangles)
    return Triangle(
        reduce_rows(np.concatenate([t.matrix for t in parts])),
        sum(t.rows for t in parts),
        float(sum(t.log_determinant for t in parts)),
    )


def triangle_of(windows: Sequence[WindowRows]) -> Triangle:
    """Return the triangle of `windows`, whitened by noise and model error."""
    return Triangle(
        reduce_rows(np.concatenate([w.whitened for w in windows])),
        int(sum(w.count.sum() for w in windows)),
        float(sum(w.log_determinant for w in windows)),
    )


def _blocks(window: Window, *, sine: bool) -> Indices:
    """Return the block of each line: its harmonic, or a part of the band."""
    size = window.omega.size
    if sine:
        return np.arange(size)
    edges = np.unique(np.geomspace(2, size, _SUB_BANDS + 1).astype(np.int_))
    return np.asarray(np.searchsorted(edges[:-1], np.arange(size), side="right"))


def window_rows(
    window: Window,
    columns: Array,
    dictionary: Dictionary,
    record: int,
    *,
    sine: bool,
    delay: float = 0.0,
) -> WindowRows:
    """Return the rows of one window for columns (K, N) on its motion's grid.

    The force's lines are advanced by `delay`, s.
    """
    force = window.force * np.exp(1j * window.omega * delay)
    stacked = [window.project(columns)]
    if dictionary.delay:
        stacked.append((-1j * window.omega * force)[None])
    stacked.append(force[None])
    rows = real_rows(np.concatenate(stacked)).T
    block = _blocks(window, sine=sine)
    of_row = np.concatenate((block, block))
    present = np.unique(block)
    reduced, kept_block = [], []
    for b in present:
        part = rows[of_row == b]
        small = reduce_rows(part) if not sine else part
        reduced.append(small)
        kept_block.append(np.full(small.shape[0], np.searchsorted(present, b)))
    count = np.array([np.sum(of_row == b) for b in present], dtype=np.float64)
    if sine:
        count[0] = 1.0  # the mean has no imaginary part
    return WindowRows(
        matrix=np.concatenate(reduced),
        block=np.concatenate(kept_block),
        count=count,
        variance=np.array([window.variance[block == b].mean() for b in present]),
        discrepancy=np.zeros(present.size),
        record=record,
        frequency=window.frequency,
        amplitude=window.amplitude,
        speed=window.speed,
        power=window.power,
        rest=window.rest,
        noise_power=window.noise_power,
        share=window.share,
    )


def rows_of(
    observation: Observation, dictionary: Dictionary, record: int, *, delay: float = 0.0
) -> list[WindowRows]:
    """Return the rows of every window of an observation; its columns are evaluated once.

    A delay (s) of the force channel is taken out: the motion is taken that much earlier, or where
    it can't be, the force's lines are advanced.
    """
    motion = observation.motion
    if delay and observation.at is not None:
        motion, delay = observation.at(observation.time - delay), 0.0
    columns = dictionary.evaluate(motion)
    sine = observation.kind == "sine"
    return [
        window_rows(w, columns, dictionary, record, sine=sine, delay=delay)
        for w in observation.windows
    ]
