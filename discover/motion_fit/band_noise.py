"""The force's noise in a record that does not repeat: what no law of the motion explains.

A model of any structure makes the force from the motion. So a wide set of functions of the motion,
far more than a model has, is fitted to the force's spectrum, and what it leaves is the noise: the
sensor's own, and what of the device does not follow the motion (ripple of gears, valves that
flutter). The functions are chosen one by one as long as each explains more than chance would, and
what their number takes from the noise is given back.

None of them has a resonance. So what they make together, and the displacement, may each act through
any response that changes smoothly with frequency, where that explains more than chance would.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.fft import prev_fast_len

from discover.motion_fit.law_functions import Family, law_functions
from discover.motion_fit.noise_spectrum import (
    NoiseSpectrum,
    slope_of_lines,
    smooth_spectrum,
    with_rise,
)
from discover.motion_fit.observation import Lines
from discover.motion_fit.smooth_response import lines_of, span_of, unexplained
from models.checks import Array
from models.fractional.lowest_lines import LowestLines, lowest_lines
from models.motion import Motion

_PASSES = 3  # of fitting with the noise that the last pass found
_FEWEST_LINES = 12  # of the spectrum, from which noise can be told
_LONG = 200_000  # samples, from which it matters how fast a length transforms
_HALF_OCTAVE = float(np.sqrt(2.0))  # ratio of frequencies


@dataclass(frozen=True)
class BandNoise:
    """What a wide set of functions of the motion leaves of the force."""

    spectrum: NoiseSpectrum
    """The noise."""
    follows: float
    """Hz up to which the force follows the motion; a dozen lines are left where it nowhere does."""


def band_noise(
    motion: Motion, measured: Array, force: Array, step: float, cutoff: float, inner: slice
) -> BandNoise:
    """Return the force's noise, and up to which frequency the force follows the motion.

    A law holds at every frequency. So the force follows as far as what is found below explains
    half of it or more in the next half of an octave: beyond, the motion is mostly noise itself.
    Where the most of the force is in that half, too little is below it to find a law from.

    Parameters
    ----------
    motion : Motion
        Of N samples, band-limited.
    measured : ndarray, shape (N,)
        The displacement as it was measured, m.
    force : ndarray, shape (N,)
        N.
    step : float
        Sampling interval, s.
    cutoff : float
        Hz, end of the band in which the motion is known. Above it the force's own spectrum counts
        where the motion explains none of it.
    inner : slice
        Samples that count: derivatives at a record's ends rest on what is not there.
    """
    size = inner.stop - inner.start
    if size > _LONG:  # a few samples less make many transforms several times as fast
        inner = slice(inner.start, inner.start + prev_fast_len(size, real=True))
    force = force[inner]
    taper = np.hanning(force.size + 2)[1:-1]
    scale = np.sqrt(2.0 * step / np.sum(taper**2))
    taper *= scale
    frequencies = np.asarray(np.fft.rfftfreq(force.size, step))[1:]
    width = float(frequencies[0])
    count = max(int(np.floor(cutoff / width)), min(_FEWEST_LINES, frequencies.size))
    functions = law_functions(motion)
    wanted = lowest_lines(force.size, count + 1)
    of_families = [_lowest(family, inner, taper, wanted) for family in functions]
    lines = np.concatenate(of_families)
    target = lines_of(force, taper)
    coefficients, left, kept = _explained(lines, target[:count], frequencies[:count])
    places = np.cumsum([len(own) for own in of_families])[:-1]
    fitted = _sum(functions, inner, np.split(coefficients, places))
    beyond = np.abs(lines_of(force - fitted, taper)[count:]) ** 2
    left = np.concatenate([left, np.minimum(beyond, np.abs(target[count:]) ** 2)])
    kept = np.concatenate([kept, np.ones(beyond.size)])
    noise = smooth_spectrum(frequencies, left, width, 0.5 / step, kept)
    less, share = unexplained(force - fitted, [measured[inner], fitted], frequencies, step)
    lower = smooth_spectrum(frequencies, less, width, 0.5 / step, share)
    inside = frequencies[:count]
    if _is_more_than_chance(noise.at(inside), lower.at(inside), share[:count]):
        left, kept, noise = less, share, lower
    slope = slope_of_lines(frequencies[:count], left[:count], kept[:count])
    noise = with_rise(noise, slope, 0.1 * width)
    return BandNoise(noise, _follows(lines, target[:count], frequencies[:count]))


def _lowest(family: Family, inner: slice, taper: Array, wanted: LowestLines) -> Lines:
    """Return the lowest lines (F, L) of a family's functions, as of `lines_of`."""
    mean = wanted.of(taper)
    found = [wanted.of(f[inner] * taper) - float(f[inner].mean()) * mean for f in family()]
    return np.stack(found)[:, 1:]


def _sum(families: Sequence[Family], inner: slice, coefficients: Sequence[Array]) -> Array:
    """Return the sum of families' functions with coefficients (F,) of each."""
    total = np.zeros(inner.stop - inner.start)
    for family, own in zip(families, coefficients, strict=True):
        if not np.any(own):
            continue
        for factor, function in zip(own, family(), strict=True):
            if factor != 0.0:
                total += factor * function[inner]
    return total


def _is_more_than_chance(level: Array, less: Array, share: Array) -> bool:
    """Tell whether noise at a level `less` at each line is more likely than at `level`.

    By the Bayesian information criterion: what leaves it spends what it does not keep of the noise,
    and what it spends rests on the lines around alone.
    """
    gain = float(np.sum(np.log(level / less)))
    return gain > float(np.sum(1.0 - share)) * float(np.log(2.0 * span_of(level.size)))


def _explained(lines: Lines, target: Lines, frequencies: Array) -> tuple[Array, Array, Array]:
    """Return coefficients (K,), what they leave of each line's power, and the share it kept."""
    width, end = float(frequencies[0]), float(frequencies[-1])
    left = np.abs(target) ** 2
    level = smooth_spectrum(frequencies, left, width, end)
    for _ in range(_PASSES):
        weight = 1.0 / np.sqrt(level.at(frequencies))
        coefficients, kept = _selected(lines * weight, target * weight)
        left = np.abs(target - coefficients @ lines) ** 2
        level = smooth_spectrum(frequencies, left, width, end, kept)
    return coefficients, left, kept


def _follows(lines: Lines, target: Lines, frequencies: Array) -> float:
    """Return the frequency up to which the force follows the motion, Hz."""
    end = frequencies.size
    while True:
        below = int(end / _HALF_OCTAVE)
        if below < _FEWEST_LINES:
            return float(frequencies[end - 1])
        whole = np.abs(target[:end]) ** 2
        if np.sum(whole[below:]) > np.sum(whole[:below]):
            return float(frequencies[end - 1])
        coefficients, _, _ = _explained(lines[:, :below], target[:below], frequencies[:below])
        left = target[below:end] - coefficients @ lines[:, below:end]
        if np.sum(np.abs(left) ** 2) < 0.5 * np.sum(whole[below:]):
            return float(frequencies[end - 1])
        end = below


def _selected(lines: Lines, target: Lines) -> tuple[Array, Array]:
    """Return coefficients (K,) of the functions that matter, and what they leave of each line.

    Orthogonal least squares: the next is the one that explains most of what is left, until it is
    less than the logarithm of the number of rows, as in the Bayesian information criterion. No
    more than a quarter of the rows are spent.
    """
    rows = np.concatenate([lines.real, lines.imag], axis=1)
    goal = np.concatenate([target.real, target.imag])
    size = np.linalg.norm(rows, axis=1)
    rows = rows / np.where(size > 0.0, size, 1.0)[:, None]
    count = goal.size
    remaining, left = rows.copy(), goal.copy()
    chosen, basis = list[int](), list[Array]()
    while len(chosen) < min(count // 4, rows.shape[0]):
        norms = np.sum(remaining**2, axis=1)
        gains = np.where(norms > 1e-8, (remaining @ left) ** 2 / np.maximum(norms, 1e-8), 0.0)
        best = int(np.argmax(gains))
        spread = float(left @ left - gains[best]) / max(count - len(chosen) - 1, 1)
        if gains[best] <= np.log(count) * spread:
            break
        direction = remaining[best] / np.sqrt(norms[best])
        chosen.append(best)
        basis.append(direction)
        left = left - (direction @ left) * direction
        remaining -= np.outer(remaining @ direction, direction)
    coefficients = np.zeros(rows.shape[0])
    if not chosen:
        return coefficients, np.ones(lines.shape[1])
    solved = np.linalg.lstsq(rows[chosen].T, goal, rcond=1e-10)[0]
    coefficients[chosen] = solved / size[chosen]
    spent = np.sum(np.stack(basis) ** 2, axis=0).reshape(2, -1).mean(axis=0)
    return coefficients, 1.0 - spent
