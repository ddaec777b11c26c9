"""What of a sine test's force does not repeat from cycle to cycle: the spectrum of its noise.

The force is compared with what other cycles measured at the same phase, by a straight line over
one sample's width of phase. So impacts and the jumps of friction, whose harmonics go on beyond
the Nyquist frequency and fold back between the lines, do not count as noise: they repeat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import orth
from scipy.sparse import csr_array

from discover.motion_fit.noise import power_density
from discover.sine_fit import harmonic_design
from models.checks import Array

FEWEST_CYCLES = 2.5
_ENOUGH_CYCLES = 6.0
_FEWEST_SAMPLES, _MOST_SAMPLES = 32, 60_000
_FEWEST_BINS = 5
_HALF_WIDTH = 0.75  # of a sample's share of the cycle, to either side
_LEAST_WEIGHT = 1e-3
_SLOPED = 1e-3  # of the weights' square, by which their phases have to differ for a slope
_HARMONICS = 31
_RESOLVED = 0.12  # of the sampling rate: what is slower is smooth over one sample
_SLOW = 3
_CYCLES_EACH = 3.0  # for every order of slow change
_BESIDE = 2.0  # harmonics beyond those that change, that see it
_MANY_CYCLES = 20.0  # of which slow changes take next to nothing
_AT_ONCE = 16  # waves
_SAME = 1e-9  # of the greatest singular value: no change of its own
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
_ENOUGH_BINS = 30
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
        None with fewer than two and a half cycles, or samples too few to compare. Of a long
        record the first part is used.
    """
    most = max(_MOST_SAMPLES, round(_ENOUGH_CYCLES / (step * frequency)))
    time, force = time[:most], force[:most]
    if float(time[-1] - time[0]) * frequency < FEWEST_CYCLES or time.size < _FEWEST_SAMPLES:
        return None
    phase = np.mod((time - time[0]) * frequency, 1.0)
    order = np.argsort(phase, kind="stable")
    same = _same_phase(phase[order], order, _HALF_WIDTH * step * frequency)
    cycles = time.size * step * frequency
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
    share = np.zeros(whole.size)
    share[at] = kept
    taper = np.hanning(whole.size + 2)[1:-1] ** 2
    width = float(frequencies[1])
    gain = _response(same, time, np.flatnonzero(kept), width, frequencies.size)
    if cycles < _MANY_CYCLES:
        low = frequencies[frequencies < (_changing(time.size) + _BESIDE) * frequency]
        gain[: low.size] *= _left_by(orth(changes[kept], rcond=_SAME), same, time, kept, low)
    gain *= float(taper @ share) / float(np.sum(taper))
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
    design = harmonic_design(time, frequency, count)
    found = np.linalg.solve(design.T @ design, design.T @ force)
    periodic = 2 * count + 1
    return np.asarray(force - design[:, :periodic] @ found[:periodic])


def _changing(samples: int) -> int:
    """Return the number of harmonics whose size may change."""
    return int(np.clip(samples // _SAMPLES_EACH, 1, _CHANGING))


def _changes(
    same: csr_array, time: Array, repeated: Array, frequency: float, cycles: float
) -> Array:
    """Return what slow changes make of the difference between cycles, (N, C): that is no noise.

    The mean may change, and the size of what repeats and of its lowest harmonics: by no more
    than a straight line where the cycles are few, as they would take in the noise.
    """
    late = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    order = int(np.clip(cycles // _CYCLES_EACH, 1, _SLOW))
    slow = np.polynomial.legendre.legvander(late, order)[:, 1:]
    lowest = harmonic_design(time, frequency, _changing(time.size))
    carriers = np.column_stack([lowest, repeated])
    changes = (slow[:, :, None] * carriers[:, None, :]).reshape(time.size, -1)
    moved = changes - same @ changes
    return np.asarray(moved / np.maximum(np.linalg.norm(moved, axis=0), 1e-300))


def _without(left: Array, changes: Array, kept: Kept) -> Array:
    """Return what cycles differ by without changes (N, C); samples that are not kept stay.

    What changes is not known there.
    """
    basis = orth(changes[kept], rcond=_SAME)
    result = left.copy()
    result[kept] -= basis @ (basis.T @ left[kept])
    return result


def _left_by(
    basis: Array, same: csr_array, time: Array, kept: Kept, frequencies: Array
) -> Array:
    """Return the share of a wave's power that slow changes leave, at each frequency (F,)."""
    shares = []
    for begin in range(0, frequencies.size, _AT_ONCE):
        waves = np.exp(2j * np.pi * np.outer(time, frequencies[begin : begin + _AT_ONCE]))
        waves = (waves - same @ waves)[kept]
        power = np.maximum(np.sum(np.abs(waves) ** 2, axis=0), 1e-300)
        shares.append(1.0 - np.sum(np.abs(basis.T @ waves) ** 2, axis=0) / power)
    return np.concatenate(shares)


def _same_phase(phase: Array, order: NDArray[np.intp], half: float) -> csr_array:
    """Return what maps a force (N,) to the line through it around each sample's phase.

    `phase` rises; `order` says which sample each belongs to.
    """
    size = phase.size
    around = np.concatenate([phase - 1.0, phase, phase + 1.0])
    here = np.arange(size, 2 * size)
    first = np.maximum(np.searchsorted(around, phase - half, side="left"), here - _NEAREST)
    last = np.minimum(np.searchsorted(around, phase + half, side="right"), here + _NEAREST + 1)
    count = last - first
    row = np.repeat(np.arange(size), count)
    begin = np.cumsum(count) - count
    column = np.arange(row.size) + np.repeat(first - begin, count)
    away = (around[column] - phase[row]) / half
    weight = np.maximum(1.0 - away**2, _LEAST_WEIGHT)
    zeroth, one, two = (np.bincount(row, weight * away**k, size) for k in range(3))
    spread = zeroth * two - one**2
    sloped = spread > _SLOPED * zeroth**2
    line = weight * (two[row] - one[row] * away) / np.where(sloped, spread, 1.0)[row]
    weight = np.where(sloped[row], line, weight / zeroth[row])
    return csr_array((weight, (order[row], order[column % size])), shape=(size, size))


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


def _response(
    same: csr_array, time: Array, kept: NDArray[np.intp], width: float, size: int
) -> Array:
    """Return the power that the comparison leaves of a wave, mean over samples, (F,).

    At `size` multiples of `width` (Hz): each wave is a product of a coarse and a fine one.
    """
    chosen = kept[np.unique(np.linspace(0, kept.size - 1, _PROBED).astype(int))]
    block = int(np.ceil(np.sqrt(size)))
    steps = np.arange(block)
    total = np.zeros(block * block)
    for i in chosen:
        part = slice(same.indptr[i], same.indptr[i + 1])
        turns = 2j * np.pi * width * (time[same.indices[part]] - time[i])
        fine = np.exp(np.outer(turns, steps))
        coarse = same.data[part, None] * np.exp(np.outer(turns, block * steps))
        total += np.abs(1.0 - (coarse.T @ fine).ravel()) ** 2
    return np.asarray(total[:size] / chosen.size)
