"""A sine fit of a signal that is too long to be held: its normal equations, piece by piece."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from discover.sine_fit.basis import frequency_column
from discover.sine_fit.design import ComplexArray, harmonic_design
from discover.sine_fit.fit import allowed_harmonics
from discover.sine_fit.moments import moments
from discover.sine_fit.solution import SineFit, Solution, significant
from models.checks import Array, InputError

_BLOCK = 4096  # samples: with their columns they stay in the processor's cache
_STRETCHES = 64  # of at least two cycles each, whose amplitude and phase are compared
_MOST_PASSES = 6  # through the record
_SETTLED = 1e-7  # rad over the record, by which a linear step in frequency is exact
_SAME = 0.05  # of the amplitude, and rad: what a steady sine may differ by from stretch to stretch
_HARMONICS = 7  # of the displacement

Pieces = Callable[[], Iterator[tuple[Array, Array]]]


@dataclass(frozen=True)
class LongFit:
    """A sine fit of all samples of a long record."""

    frequency: float
    """Hz, of the fundamental."""
    coefficients: ComplexArray
    """(H + 1,) as of `SineFit`."""
    std_errors: Array
    """(H + 1,) likewise, by the noise of the record's first part."""
    noise_rms: float
    """Root mean square of what the fit leaves."""
    first: float
    """s, of the first sample."""
    last: Array
    """(B,) s, of the last samples."""
    passes: int
    """Times that the samples were read."""

    @property
    def cycles(self) -> float:
        """Duration times frequency."""
        return self.frequency * float(self.last[-1] - self.first)


@dataclass(frozen=True)
class _Sums:
    """Products of columns and signal over stretches of a record, and what was met."""

    products: Array
    """(S, C + 1, C + 1): of the mean, the harmonics, the trend, the frequency, and the signal."""
    counts: Array
    """(S,) samples."""
    times: Array
    """(S,) s, of the first sample of each stretch."""
    last: Array
    """(B,) s, of the last samples."""


def fit_long_sine(
    pieces: Pieces, samples: int, head: SineFit, time: Array, x: Array, *, where: str = ""
) -> LongFit:
    """Fit frequency, mean, trend and significant harmonics to all samples of a long record.

    The least squares are those of `discover.sine_fit.fit_sine`; which harmonics stand out of the
    noise is judged by the noise of the record's first part. Gauss-Newton steps begin at that
    part's frequency, and each takes one pass: two are enough, as a rule.

    Parameters
    ----------
    pieces : callable
        Yields times (B,), s, and the signal (B,), from the first sample on, at each call.
    samples : int
        Of all pieces together, N.
    head : SineFit
        Of the first part.
    time, x : ndarray, shape (M,)
        The samples of the first part, s and the signal's unit.
    where : str
        Name of the record for messages.

    Raises
    ------
    InputError
        Where amplitude or phase are not the same throughout.

    Examples
    --------
    >>> from discover.sine_fit import fit_sine
    >>> t = np.arange(4000) / 100.0
    >>> x = 0.02 * np.sin(2 * np.pi * 1.3 * t)
    >>> parts = lambda: ((t[i : i + 500], x[i : i + 500]) for i in range(0, 4000, 500))
    >>> found = fit_long_sine(parts, 4000, fit_sine(t[:1000], x[:1000]), t[:1000], x[:1000])
    >>> round(found.frequency, 9), round(float(abs(found.coefficients[1])), 9)
    (1.3, 0.02)
    """
    step = float(time[-1] - time[0]) / (time.size - 1)
    duration = step * (samples - 1)
    middle = float(time[0]) + 0.5 * duration
    offset = float(head.coefficients[0].real)
    frequency = head.frequency
    orders = allowed_harmonics(_HARMONICS, frequency, samples, duration)
    local = _local_noise(head, time, x, orders)
    beta = _beta(head, orders, middle)
    stretches = int(np.clip(duration * frequency // 2.0, 1, _STRETCHES))
    passes, turn = 0, np.inf
    while abs(turn) * duration >= _SETTLED and passes < _MOST_PASSES:
        passes += 1
        sums = _sums_of_pass(
            pieces, frequency, orders, beta, (middle, duration, offset), samples, stretches
        )
        total = sums.products.sum(axis=0)
        linear = _solved(total, list(range(2 + 2 * len(orders))))
        kept, trend = significant(*linear, local, orders, 1.0)
        chosen = [0, *(1 + 2 * i + j for i, k in enumerate(orders) if k in kept for j in (0, 1))]
        chosen += [1 + 2 * len(orders)] * int(trend) + [2 + 2 * len(orders)]
        solution, _ = _solved(total, chosen)
        turn = float(solution[-1])
        frequency += turn / (2.0 * np.pi)
        beta = np.zeros_like(beta)
        beta[chosen[:-1]] = solution[:-1]
    _check_steady(sums, orders, duration, where)
    square = float(total[-1, -1] - solution @ total[chosen, -1])
    coefficients = np.zeros(max(orders) + 1, dtype=np.complex128)
    coefficients[0] = beta[0] + offset
    errors = np.zeros(coefficients.size)
    for i, k in enumerate(orders):
        pair = slice(1 + 2 * i, 3 + 2 * i)
        coefficients[k] = complex(*beta[pair]) * np.exp(-2j * np.pi * k * frequency * middle)
        errors[k] = np.sqrt(0.5 * float(linear[1][pair].sum()) * local[k]) * (k in kept)
    return LongFit(
        frequency=frequency,
        coefficients=coefficients[: max(kept) + 1],
        std_errors=errors[: max(kept) + 1],
        noise_rms=float(np.sqrt(max(square, 0.0) / max(samples - len(chosen), 1))),
        first=float(time[0]),
        last=sums.last,
        passes=passes,
    )


def _local_noise(
    head: SineFit, time: Array, x: Array, orders: tuple[int, ...]
) -> dict[int, float]:
    """Return the noise beside each harmonic in the first part, as a white variance."""
    tried = allowed_harmonics(
        max(orders), head.frequency, time.size, float(time[-1] - time[0])
    )
    solution = Solution(
        moments(time).since(float(time.mean())), x - x.mean(), head.frequency, tried,
        with_frequency=False,
    )  # fmt: skip
    return {k: solution.local.get(k, solution.total) for k in (0, *orders)}


def _beta(head: SineFit, orders: Sequence[int], middle: float) -> Array:
    """Return the first part's coefficients about another time: mean, harmonics, trend."""
    beta = np.zeros(2 + 2 * len(orders))
    for i, k in enumerate(orders):
        if k < head.coefficients.size:
            phasor = head.coefficients[k] * np.exp(2j * np.pi * k * head.frequency * middle)
            beta[1 + 2 * i : 3 + 2 * i] = phasor.real, phasor.imag
    return beta


def _sums_of_pass(
    pieces: Pieces,
    frequency: float,
    orders: Sequence[int],
    beta: Array,
    scale: tuple[float, float, float],
    samples: int,
    stretches: int,
) -> _Sums:
    """Return the sums of one pass; `scale` is the middle, the duration and what x is less."""
    middle, duration, offset = scale
    size = 4 + 2 * len(orders)
    products = np.zeros((stretches, size, size))
    counts, times = np.zeros(stretches), np.full(stretches, np.inf)
    begin = 0
    last = np.empty(0)
    for time, x in pieces():
        for first in range(0, time.size, _BLOCK):
            inside = slice(first, first + _BLOCK)
            tau = time[inside] - middle
            design = harmonic_design(tau, frequency, orders)
            table = np.empty((tau.size, size), order="F")
            table[:, : size - 3] = design
            table[:, size - 3] = tau / duration
            table[:, size - 2] = frequency_column(tau, design, beta, orders)
            table[:, size - 1] = x[inside] - offset
            stretch = min((begin + first) * stretches // samples, stretches - 1)
            products[stretch] += table.T @ table
            counts[stretch] += tau.size
            times[stretch] = min(times[stretch], float(time[first]))
        begin += time.size
        last = time
    return _Sums(products, counts, times, last)


def _solved(products: Array, chosen: list[int]) -> tuple[Array, Array]:
    """Return least-squares coefficients of some columns and the inverse's diagonal."""
    gram = products[np.ix_(chosen, chosen)]
    norms = np.sqrt(np.diagonal(gram))
    factor = cho_factor(gram / np.outer(norms, norms))
    solution = cho_solve(factor, products[chosen, -1] / norms) / norms
    inverse = cho_solve(factor, np.eye(norms.size))
    return solution, np.diagonal(inverse) / norms**2


def _check_steady(sums: _Sums, orders: Sequence[int], duration: float, where: str) -> None:
    """Raise where a stretch has another amplitude or phase than all together."""
    whole, _ = _solved(sums.products.sum(axis=0), list(range(1 + 2 * len(orders))))
    reference = complex(whole[1], whole[2])
    for products, begin, count in zip(sums.products, sums.times, sums.counts, strict=True):
        if not count:
            continue
        own, _ = _solved(products, [0, 1, 2])
        relative = complex(own[1], own[2]) / reference
        if abs(relative - 1.0) > _SAME:
            raise InputError(
                "displacement",
                expected="a steady sine throughout, in a record that is read in pieces; [[records]]"
                " range tells the steady part",
                found=f"{abs(relative):.3g} times the amplitude and {np.angle(relative):.2g} rad"
                f" of phase over the {duration / sums.times.size:.4g} s from {begin:.6g} s on",
                where=where,
            )
