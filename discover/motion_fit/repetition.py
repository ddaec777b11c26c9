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

from discover.motion_fit.harmonic_lines import harmonic_lines
from discover.motion_fit.noise import power_density
from discover.motion_fit.same_phase import SamePhase, same_phase
from discover.sine_fit import ComplexArray, harmonic_design, moments
from models.checks import Array, Indices
from models.fractional.lowest_lines import lowest_lines

_FEWEST_CYCLES = 1.5  # that can be compared
_ENOUGH_CYCLES = 6.0  # of a long record, that are compared
_FEWEST_SAMPLES, _MOST_SAMPLES = 32, 60_000  # that are compared
_FEWEST_BINS = 5  # from which a level of noise can be told
_HALF_WIDTH = 0.75  # of a sample's share of the cycle, to either side
_FEWEST_NEIGHBOURS = 4.0  # in phase, itself among them: fewer leave nothing beside a line
_HARMONICS = 31  # lowest of the force, taken out before cycles are compared
_RESOLVED = 0.12  # of the sampling rate: what is slower is smooth over one sample
_SLOW = 3  # orders of slow change at most
_CYCLES_EACH = 3.0  # for every order of slow change
_ROUNDED = 1e-6  # of the distance between lines, that a frequency may be off
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
    same = same_phase(phase[order], order, half)
    own = same.own
    steady = _without_lowest(time, force, frequency, step)
    left = same.left(steady[:, None])[:, 0]
    kept = _smooth_phases(left, own, order, cycles)
    if np.count_nonzero(kept) < _FEWEST_SAMPLES:
        return None
    changes = _changes(same, time, steady - left, frequency, cycles)
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
        # The line at the very end is not among them, whichever way its frequency is rounded.
        end = (_changing(time.size, cycles) + _BESIDE) * frequency - _ROUNDED * width
        bins = np.searchsorted(frequencies, end)
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


@dataclass(frozen=True)
class _Changes:
    """What slow changes make of the difference between cycles: that is no noise."""

    columns: Array
    """(N, C)."""
    norms: Array
    """(C,) of the columns."""

    def inside(self, kept: Kept) -> Array:
        """Return the columns, zero at samples that are not kept: what changes is not known."""
        return np.asarray(self.columns * kept[:, None])

    def turn(self, inside: Array) -> Array:
        """Return what makes columns (N, C) orthonormal ones that span the same, (C, R)."""
        values, turn = np.linalg.eigh(inside.T @ inside / np.outer(self.norms, self.norms))
        if values[0] < _SQUARED * values[-1]:  # squares have lost what is nearly the same
            triangle = np.linalg.qr(inside / self.norms, mode="r")
            _, sizes, turned = np.linalg.svd(triangle, full_matrices=False)
            there = sizes > _SAME * sizes[0]
            turn, values = turned[there].T, sizes[there] ** 2
        return np.asarray(turn / np.sqrt(values) / self.norms[:, None])


def _changes(
    same: SamePhase, time: Array, repeated: Array, frequency: float, cycles: float
) -> _Changes:
    """Return what may change slowly.

    The mean, and the size of what repeats and of its lowest harmonics: by no more than a straight
    line where the cycles are few, as they would take in the noise.
    """
    centred_time = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    order = int(np.clip(cycles // _CYCLES_EACH, 1, _SLOW))
    slow = np.polynomial.legendre.legvander(centred_time, order)[:, 1:]
    lowest = harmonic_design(time, frequency, _changing(time.size, cycles))
    carriers = np.column_stack([lowest, repeated])
    changes = np.empty((time.size, order, carriers.shape[1]))
    np.multiply(slow[:, :, None], carriers[:, None, :], out=changes)
    moved = same.left(changes.reshape(time.size, -1))
    return _Changes(moved, np.maximum(np.linalg.norm(moved, axis=0), 1e-300))


def _without(left: Array, changes: _Changes, kept: Kept) -> Array:
    """Return what cycles differ by without slow changes; samples that are not kept stay."""
    inside = changes.inside(kept)
    turn = changes.turn(inside)
    return np.asarray(left - inside @ (turn @ (turn.T @ (inside.T @ left))))


def _left_by(changes: _Changes, same: SamePhase, at: Indices, kept: Kept, bins: int) -> Array:
    """Return the share of a wave's power that slow changes leave, at the lowest `bins` (F,).

    A wave's power after the comparison depends on lags between samples alone, and its part along
    slow changes on what these are before it: both are spectra, so that no wave is formed.
    """
    size = int(at[-1]) + 1
    lowest, inside = lowest_lines(size, bins), changes.inside(kept)
    power = lowest.of(same.lag_products(at, np.flatnonzero(kept), size)).real
    spread = np.zeros((inside.shape[1], size))
    spread[:, at] = same.spread(inside).T
    lines = changes.turn(inside).T @ lowest.of(spread)
    # A harmonic has no power, but for rounding.
    taken = np.sum(np.abs(lines) ** 2, axis=0) / np.maximum(power, 1e-300)
    return np.asarray(np.clip(1.0 - taken, 0.0, 1.0))


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


def _response(same: SamePhase, time: Array, counts: Array, width: float, size: int) -> Array:
    """Return the power that the comparison leaves of a wave, mean over samples, (F,).

    Of the samples each `counts` (N,) so much. At `size` multiples of `width` (Hz): each wave is a
    product of a coarse and a fine one.
    """
    kept = np.flatnonzero(counts)
    chosen = kept[np.unique(np.linspace(0, kept.size - 1, _PROBED).astype(int))]
    block = int(np.ceil(np.sqrt(size)))
    total = np.zeros(block * block)
    for i in chosen:
        part = slice(same.begin[i], same.begin[i + 1])
        turns = 2j * np.pi * width * (time[same.places[part]] - time[i])
        fine = _powers(np.exp(turns), block)
        coarse = same.weights[part, None] * _powers(np.exp(block * turns), block)
        compared = (coarse.T @ fine).ravel()
        total += counts[i] * ((1.0 - compared.real) ** 2 + compared.imag**2)
    return np.asarray(total[:size] / np.sum(counts[chosen]))


def _powers(waves: ComplexArray, count: int) -> ComplexArray:
    """Return powers 0 to `count` - 1 of unit phasors (E,), (E, count)."""
    found = np.ones((waves.size, count), dtype=np.complex128)
    known, last = 1, waves[:, None]
    while known < count:  # each time twice as many
        more = min(known, count - known)
        found[:, known : known + more] = found[:, :more] * last
        known, last = known + more, last * last
    return found
