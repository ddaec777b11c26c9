"""What of a sine test's force does not repeat from cycle to cycle: the spectrum of its noise.

The force is compared with what other cycles measured at the same phase, by a straight line over
one sample's width of phase. So impacts and the jumps of friction, whose harmonics go on beyond
the Nyquist frequency and fold back between the lines, do not count as noise: they repeat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d
from scipy.sparse import csr_array

from discover.motion_fit.harmonic_lines import harmonic_lines
from discover.motion_fit.noise import power_density
from discover.sine_fit import harmonic_design, moments
from models.checks import Array
from models.compiled import compiled

_FEWEST_CYCLES = 1.5  # that can be compared
_ENOUGH_CYCLES = 6.0  # of a long record, that are compared
_FEWEST_SAMPLES, _MOST_SAMPLES = 32, 60_000  # that are compared
_FEWEST_BINS = 5  # from which a level of noise can be told
_HALF_WIDTH = 0.75  # of a sample's share of the cycle, to either side
_FEWEST_NEIGHBOURS = 4.0  # in phase, itself among them: fewer leave nothing beside a line
_LEAST_WEIGHT = 1e-3  # of a neighbour in phase, against one at the same phase
_SLOPED = 1e-3  # of the weights' square, by which their phases have to differ for a slope
_HARMONICS = 31  # lowest of the force, taken out before cycles are compared
_RESOLVED = 0.12  # of the sampling rate: what is slower is smooth over one sample
_SLOW = 3  # orders of slow change at most
_CYCLES_EACH = 3.0  # for every order of slow change
_BESIDE = 2.0  # harmonics beyond those that change, that see it
_MANY_CYCLES = 20.0  # of which slow changes take next to nothing
_SAME = 1e-9  # of the greatest singular value: no change of its own
_SQUARED = 1e-8  # of the greatest square of one, from which squares tell changes apart
_CHANGING = 5  # harmonics whose size may change slowly
_ALONE = 0.95  # of a sample in its own comparison: no other cycle was near
_ROUGH = 3.0  # times the median of what phases leave, above which a phase is left out
_AROUND = 4.0  # samples to either side of a phase that are judged with it
_LEAST_KEPT = 0.25  # of the samples; with fewer, none is left out
_SAMPLES_EACH = 120  # for every harmonic that may change
_PROBED = 48  # samples at which the comparison's response is evaluated
_NEAREST = 8  # samples in phase, to either side, that one is compared with at most
_LEAST_GAIN = 0.35  # of the noise's power, that has to be left beside a harmonic
_CLEAR = 1.5  # bins from a harmonic: nearer ones also see what changes it slowly
_ENOUGH_BINS = 30  # clear of harmonics, with which those beside them are not needed
_SPREAD = np.array([1.0, 16.0, 36.0, 16.0, 1.0]) / 70.0  # of a wave's power over bins, by the taper
Kept = NDArray[np.bool_]


@dataclass(frozen=True)
class Unrepeated:
    """The periodogram of what does not repeat."""

    frequencies: Array
    """(B,) Hz: away from harmonics, where the noise is left."""
    density: Array
    """(B,) one-sided, N^2/Hz, corrected for what the comparison takes away."""
    width: float
    """Hz between neighbouring bins of the whole spectrum."""


def unrepeated(time: Array, force: Array, frequency: float, step: float) -> Unrepeated | None:
    """Return the noise of a sine test's force from what differs between its cycles.

    Parameters
    ----------
    time, force : ndarray, shape (N,)
        s and N, on a grid of `step` of which samples may be missing.
    frequency : float
        Of the test, Hz.
    step : float
        Sampling interval, s.

    Returns
    -------
    Unrepeated or None
        None with fewer than one and a half cycles, or samples too few to compare. Of a long
        record the first part is used.
    """
    most = max(_MOST_SAMPLES, round(_ENOUGH_CYCLES / (step * frequency)))
    time, force = time[:most], force[:most]
    if float(time[-1] - time[0]) * frequency < _FEWEST_CYCLES or time.size < _FEWEST_SAMPLES:
        return None
    phase = np.mod((time - time[0]) * frequency, 1.0)
    order = np.argsort(phase, kind="stable")
    cycles = time.size * step * frequency
    half = max(_HALF_WIDTH, _FEWEST_NEIGHBOURS / (2.0 * cycles)) * step * frequency
    same = _same_phase(phase[order], order, half)
    own = same.diagonal()
    steady = _without_lowest(time, force, frequency, step)
    repeated = same @ steady
    left = steady - repeated
    kept = _smooth_phases(left, own, order, cycles)
    if np.count_nonzero(kept) < _FEWEST_SAMPLES:
        return None
    changes = _changes(same, time, repeated, frequency, cycles)
    left = _without(left, changes, kept)
    kept = _smooth_phases(left, own, order, cycles)
    at = np.rint((time - time[0]) / step).astype(int)
    whole = np.zeros(at[-1] + 1)
    whole[at] = np.where(kept, left, 0.0)
    frequencies, density = power_density(whole, step)
    taper = np.hanning(whole.size + 2)[1:-1] ** 2
    width = float(frequencies[1])
    gain = _response(same, time, taper[at] * kept, width, frequencies.size)
    if cycles < _MANY_CYCLES:
        bins = np.searchsorted(frequencies, (_changing(time.size, cycles) + _BESIDE) * frequency)
        gain[:bins] *= _left_by(changes, same, at, kept, int(bins))
    gain = convolve1d(gain, _SPREAD, mode="nearest")
    gain *= float(taper[at] @ kept) / float(np.sum(taper))
    spacing = frequency / width
    apart = np.abs(np.mod(frequencies / frequency + 0.5, 1.0) - 0.5) * spacing
    seen = gain > _LEAST_GAIN * float(np.max(gain))
    seen[:2] = False
    clear = seen & (apart > _CLEAR)
    if np.count_nonzero(clear) < _ENOUGH_BINS:
        clear = seen
    if np.count_nonzero(clear) < _FEWEST_BINS:
        return None
    return Unrepeated(frequencies[clear], density[clear] / gain[clear], width)


def _without_lowest(time: Array, force: Array, frequency: float, step: float) -> Array:
    """Return a force without its lowest harmonics.

    A straight line over one sample's width does not miss the curvature of what is left.
    """
    count = int(np.clip(_RESOLVED / (step * frequency), 1, min(_HARMONICS, time.size // 8)))
    fit = harmonic_lines(moments(time), frequency, count, middle=None)
    return np.asarray(force - fit.fitted(fit.solve(force[None])[0]))


def _changing(samples: int, cycles: float) -> int:
    """Return the number of harmonics whose size may change: changes of few cycles are noise too."""
    most = _CHANGING if cycles >= _CYCLES_EACH else 1
    return int(np.clip(samples // _SAMPLES_EACH, 1, most))


def _changes(
    same: csr_array, time: Array, repeated: Array, frequency: float, cycles: float
) -> Array:
    """Return what slow changes make of the difference between cycles, (N, C): that is no noise.

    The mean may change, and the size of what repeats and of its lowest harmonics: by no more
    than a straight line where the cycles are few, as they would take in the noise.
    """
    centred_time = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    order = int(np.clip(cycles // _CYCLES_EACH, 1, _SLOW))
    slow = np.polynomial.legendre.legvander(centred_time, order)[:, 1:]
    lowest = harmonic_design(time, frequency, _changing(time.size, cycles))
    carriers = np.column_stack([lowest, repeated])
    changes = (slow[:, :, None] * carriers[:, None, :]).reshape(time.size, -1)
    moved = changes - same @ changes
    return np.asarray(moved / np.maximum(np.linalg.norm(moved, axis=0), 1e-300))


def _without(left: Array, changes: Array, kept: Kept) -> Array:
    """Return what cycles differ by without changes (N, C); samples that are not kept stay.

    What changes is not known there.
    """
    inside = changes[kept]
    turn = _orthonormal(inside)
    result = left.copy()
    result[kept] -= inside @ (turn @ (turn.T @ (inside.T @ left[kept])))
    return result


def _orthonormal(columns: Array) -> Array:
    """Return what makes columns (N, C) orthonormal ones that span the same, (C, R)."""
    values, turn = np.linalg.eigh(columns.T @ columns)
    if values[0] < _SQUARED * values[-1]:  # squares have lost what is nearly the same
        _, sizes, turned = np.linalg.svd(np.linalg.qr(columns, mode="r"), full_matrices=False)
        there = sizes > _SAME * sizes[0]
        return np.asarray(turned[there].T / sizes[there])
    return np.asarray(turn / np.sqrt(values))


def _left_by(
    changes: Array, same: csr_array, at: NDArray[np.intp], kept: Kept, bins: int
) -> Array:
    """Return the share of a wave's power that slow changes leave, at the lowest `bins` (F,).

    A wave's power after the comparison depends on lags between samples alone, and its part along
    slow changes on what these are before it: both are spectra, so that no wave is formed.
    """
    size = int(at[-1]) + 1
    inside = changes[kept]
    lags = _lag_products(same.indptr, same.indices, same.data, at, np.flatnonzero(kept), size)
    power = np.maximum(np.fft.rfft(lags)[:bins].real, 1e-300)
    whole = np.zeros_like(changes)
    whole[kept] = inside
    before = (whole - same.T @ whole) @ _orthonormal(inside)
    spread = np.zeros((before.shape[1], size))
    spread[:, at] = before.T
    lines = np.fft.rfft(spread, axis=1)[:, :bins]
    # A harmonic has no power, but for rounding.
    return np.asarray(np.clip(1.0 - np.sum(np.abs(lines) ** 2, axis=0) / power, 0.0, 1.0))


@compiled(cache=True)
def _lag_products(
    begin: NDArray[np.int32], places: NDArray[np.int32], weights: Array, at: NDArray[np.intp],
    rows: NDArray[np.intp], size: int,
) -> Array:
    """Return products of a sample's and its comparison's weights, summed by lag, (size,).

    Over some `rows` of the comparison; lags count in steps, in a circle of `size`.
    """
    found = np.zeros(size)
    for i in rows:
        found[0] += 1.0
        for j in range(begin[i], begin[i + 1]):
            found[abs(at[places[j]] - at[i])] -= 2.0 * weights[j]
            found[0] += weights[j] * weights[j]
            for k in range(begin[i], j):
                lag = abs(at[places[j]] - at[places[k]])
                found[lag] += 2.0 * weights[j] * weights[k]
    return found


def _same_phase(phase: Array, order: NDArray[np.intp], half: float) -> csr_array:
    """Return what maps a force (N,) to the line through it around each sample's phase.

    `phase` rises; `order` says which sample each belongs to.
    """
    size = phase.size
    around = np.concatenate([phase - 1.0, phase, phase + 1.0])
    here = np.arange(size, 2 * size)
    first = np.maximum(np.searchsorted(around, phase - half, side="left"), here - _NEAREST)
    last = np.minimum(np.searchsorted(around, phase + half, side="right"), here + _NEAREST + 1)
    count = np.empty(size, dtype=np.intp)
    count[order] = last - first
    begin = np.concatenate(([0], np.cumsum(count)))
    places, weights = _lines_through(around, order, first, last, begin, half)
    return csr_array((weights, places, begin), shape=(size, size))


@compiled(cache=True)
def _lines_through(
    around: Array, order: NDArray[np.intp], first: NDArray[np.intp], last: NDArray[np.intp],
    begin: NDArray[np.intp], half: float,
) -> tuple[NDArray[np.intp], Array]:
    """Return samples (E,) and weights (E,) of the line at each sample's phase, in their order."""
    size = order.size
    places, weights = np.empty(begin[-1], dtype=np.intp), np.empty(begin[-1])
    for i in range(size):
        own, at = around[size + i], begin[order[i]]
        zeroth = one = two = 0.0
        for k in range(first[i], last[i]):
            away = (around[k] - own) / half
            weight = max(1.0 - away * away, _LEAST_WEIGHT)
            zeroth += weight
            one += weight * away
            two += weight * away * away
        spread = zeroth * two - one * one
        sloped = spread > _SLOPED * zeroth * zeroth
        for k in range(first[i], last[i]):
            away = (around[k] - own) / half
            weight = max(1.0 - away * away, _LEAST_WEIGHT)
            if sloped:
                weights[at] = weight * (two - one * away) / spread
            else:
                weights[at] = weight / zeroth
            places[at] = order[k % size]
            at += 1
    return places, weights


def _smooth_phases(
    left: Array, own: Array, order: NDArray[np.intp], cycles: float
) -> Kept:
    """Return which samples lie at phases where neighbours in phase agree but for noise."""
    known = own < _ALONE
    square = np.where(known, left**2 / np.where(known, 1.0 - own, 1.0), 0.0)[order]
    number = known[order].astype(np.float64)
    reach = min(int(np.ceil(_AROUND * cycles)), (left.size - 1) // 2)

    def around(values: Array) -> Array:
        closed = np.concatenate([values[-reach:], values, values[:reach]])
        total = np.concatenate(([0.0], np.cumsum(closed)))
        return np.asarray(total[2 * reach + 1 :] - total[: -2 * reach - 1])

    mean = around(square) / np.maximum(around(number), 1.0)
    smooth = np.zeros(left.size, dtype=np.bool_)
    smooth[order] = mean < _ROUGH * float(np.median(mean))
    kept = np.asarray(known & smooth)
    return kept if np.mean(kept) > _LEAST_KEPT else known


def _response(same: csr_array, time: Array, counts: Array, width: float, size: int) -> Array:
    """Return the power that the comparison leaves of a wave, mean over samples, (F,).

    Of the samples each `counts` (N,) so much. At `size` multiples of `width` (Hz): each wave is a
    product of a coarse and a fine one.
    """
    kept = np.flatnonzero(counts)
    chosen = kept[np.unique(np.linspace(0, kept.size - 1, _PROBED).astype(int))]
    block = int(np.ceil(np.sqrt(size)))
    steps = np.arange(block)
    total = np.zeros(block * block)
    for i in chosen:
        part = slice(same.indptr[i], same.indptr[i + 1])
        turns = 2j * np.pi * width * (time[same.indices[part]] - time[i])
        fine = np.exp(np.outer(turns, steps))
        coarse = same.data[part, None] * np.exp(np.outer(turns, block * steps))
        total += counts[i] * np.abs(1.0 - (coarse.T @ fine).ravel()) ** 2
    return np.asarray(total[:size] / np.sum(counts[chosen]))
