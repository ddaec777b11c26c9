"""The force's noise in a record that does not repeat: what no law of the motion explains.

A model of any structure makes the force from the motion. So a wide set of functions of the motion,
far more than a model has, is fitted to the force's spectrum, and what it leaves is the noise: the
sensor's own, and what of the device does not follow the motion (ripple of gears, valves that
flutter). The functions are chosen one by one as long as each explains more than chance would, and
what their number takes from the noise is given back.

None of them has a resonance. So what they make together, and the displacement, may each act through
any response that changes smoothly with frequency, where that explains more than chance would: in a
narrow range of lines these responses are polynomials (the local polynomial method: Pintelon,
Schoukens, Vandersteen, Barbe, *Mech. Syst. Signal Process.* 24 (2010) 573-595).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.fft import prev_fast_len

from discover.motion_fit.noise_spectrum import (
    NoiseSpectrum,
    slope_of_lines,
    smooth_spectrum,
    with_rise,
)
from discover.motion_fit.observation import Lines
from models.checks import Array
from models.motion import Motion
from models.terms.hysteresis import bristle_state

_PASSES = 3  # of fitting with the noise that the last pass found
_PRODUCTS = ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
"""Powers of displacement and velocity whose products stand for a static law."""
_ORDERS = (0.25, 0.5, 0.75, 1.25, 1.5, 1.75)
"""Of derivatives of displacement: any smooth linear response is nearly a sum of them."""
_SCALES = np.geomspace(3e-3, 1.0, 11)
"""Of the root mean square speed and displacement, over which friction may reverse."""
_SLOW = 3  # polynomials of time that follow a drift
_FEWEST_LINES = 12  # of the spectrum, from which noise can be told
_SPAN = 18  # lines at least over which a response is a polynomial
_SPANS = 500  # at most: of more lines each takes more
_DEGREE = 2  # of the polynomials
_AT_ONCE = 100_000  # lines whose windows are formed at a time
_NEXT = -0.5  # correlation of neighbouring lines of white noise, by the sine taper
_LEAST_KEPT = 0.1  # of a line's noise: less tells nothing
_SAME = 1e-11  # of the greatest square of a singular value: no column of its own
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
    functions = [column[inner] for column in _functions_of(motion)]
    lines = np.stack([_lines(column, taper)[:count].copy() for column in functions])
    target = _lines(force, taper)
    coefficients, left, kept = _explained(lines, target[:count], frequencies[:count])
    fitted = np.zeros(force.size)
    for place in np.flatnonzero(coefficients):
        fitted += coefficients[place] * functions[place]
    beyond = np.abs(_lines(force - fitted, taper)[count:]) ** 2
    left = np.concatenate([left, np.minimum(beyond, np.abs(target[count:]) ** 2)])
    kept = np.concatenate([kept, np.ones(beyond.size)])
    noise = smooth_spectrum(frequencies, left, width, 0.5 / step, kept)
    less, share = _unexplained(force - fitted, [measured[inner], fitted], frequencies, step)
    lower = smooth_spectrum(frequencies, less, width, 0.5 / step, share)
    inside = frequencies[:count]
    if _is_more_than_chance(noise.at(inside), lower.at(inside), share[:count]):
        left, kept, noise = less, share, lower
    slope = slope_of_lines(frequencies[:count], left[:count], kept[:count])
    noise = with_rise(noise, slope, 0.1 * width)
    return BandNoise(noise, _follows(lines, target[:count], frequencies[:count]))


def _lines(column: Array, taper: Array) -> Lines:
    """Return the lines of a column's spectrum under a taper, without that of its mean."""
    return np.asarray(np.fft.rfft((column - column.mean()) * taper)[1:])


def _unexplained(
    force: Array, inputs: Sequence[Array], frequencies: Array, step: float
) -> tuple[Array, Array]:
    """Return the power (B,) of a force's lines that no smooth response to inputs explains.

    And the share of a line's noise that is kept in it. Around each few lines the responses are
    polynomials of the frequency, by lines weighed for the same noise.
    """
    taper = np.sin(np.pi * (np.arange(force.size) + 0.5) / force.size)
    taper *= np.sqrt(4.0 * step / force.size)
    target, driving = _lines(force, taper), np.stack([_lines(i, taper) for i in inputs])
    whole = smooth_spectrum(frequencies, np.abs(target) ** 2, frequencies[0], 0.5 / step)
    level = whole.at(frequencies)
    target, driving = target / np.sqrt(level), driving / np.sqrt(level)
    size = target.size
    span = _span(size)
    hop = max(span // 3, 1)
    degree = min(_DEGREE, span // (2 * len(driving)) - 1)
    powers = np.linspace(-1.0, 1.0, span) ** np.arange(degree + 1)[:, None]
    middle = np.arange(0, size, hop)  # of a window the lines from here to the next
    left, kept = np.empty(size), np.empty(size)
    for some in np.array_split(middle, -(-middle.size * span // _AT_ONCE)):
        first = np.clip(some - hop, 0, size - span)
        at = first[:, None] + np.arange(span)
        columns = (driving[:, at][:, None] * powers[:, None]).reshape(-1, *at.shape)
        beside, share = _beside(target[at], columns.transpose(1, 2, 0))
        lines = np.arange(some[0], min(some[-1] + hop, size))
        own = (lines - some[0]) // hop, lines - first[(lines - some[0]) // hop]
        left[lines], kept[lines] = beside[own], share[own]
    return level * left, np.maximum(kept, _LEAST_KEPT)


def _span(size: int) -> int:
    """Return over how many of so many lines a response is a polynomial."""
    return min(max(_SPAN, -(-size // _SPANS)), size)


def _beside(target: Lines, columns: Lines) -> tuple[Array, Array]:
    """Return the power (W, S) of lines in windows that columns (W, S, P) do not explain.

    And the share of a line's noise that is kept in it, where neighbouring lines are correlated.
    """
    sizes = np.linalg.norm(columns, axis=1, keepdims=True)
    columns = columns / np.where(sizes > 0.0, sizes, 1.0)
    values, turn = np.linalg.eigh(columns.conj().transpose(0, 2, 1) @ columns)
    there = values > _SAME * values[:, -1:]
    turn *= (there / np.sqrt(np.where(there, values, 1.0)))[:, None]
    basis = columns @ turn
    turned = basis.conj()
    left = target - (basis @ (turned.transpose(0, 2, 1) @ target[..., None]))[..., 0]
    kept = 1.0 - np.sum(np.abs(basis) ** 2, axis=2)
    # The noise of a line beside a projection P is that of (1 - P) C (1 - P): of C its diagonal and
    # what is next to it.
    next_to = np.sum((basis[:, :-1] * turned[:, 1:]).real, axis=2)
    across = turned[:, 1:].transpose(0, 2, 1) @ basis[:, :-1]
    both = np.sum(((basis @ across) * turned).real, axis=2)
    both[:, :-1] -= next_to
    both[:, 1:] -= next_to
    return np.abs(left) ** 2, kept + 2.0 * _NEXT * both


def _is_more_than_chance(level: Array, less: Array, share: Array) -> bool:
    """Tell whether noise at a level `less` at each line is more likely than at `level`.

    By the Bayesian information criterion: what leaves it spends what it does not keep of the noise,
    and what it spends rests on the lines around alone.
    """
    gain = float(np.sum(np.log(level / less)))
    return gain > float(np.sum(1.0 - share)) * float(np.log(2.0 * _span(level.size)))


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


def _functions_of(motion: Motion) -> Iterator[Array]:
    """Yield functions of the motion (N,) that stand for whatever law a device may follow."""
    x = motion.displacement - motion.displacement.mean()
    v, a = motion.velocity, motion.acceleration
    place, speed, push = (_unit(c) for c in (x, v, a))
    ones = np.ones_like(place)
    places, speeds = ([ones, c, c * c, c * c * c] for c in (place, speed))
    for i, j in _PRODUCTS:
        yield places[i] * speeds[j]
    yield from (np.abs(place), np.abs(speed), place * np.abs(place), speed * np.abs(speed))
    for share in _SCALES:
        sign = np.tanh(speed / share)
        yield from (sign, sign * place, bristle_state(motion, share * float(np.std(x))))
    yield np.tanh(speed / _SCALES[0]) * np.abs(push)
    yield from (push, _unit(np.gradient(a)))
    yield from (_unit(c) for c in motion.differentiate(np.array(_ORDERS)))
    centred_time = np.linspace(-1.0, 1.0, x.size)
    yield from np.polynomial.legendre.legvander(centred_time, _SLOW).T[1:]


def _unit(column: Array) -> Array:
    size = float(np.sqrt(np.mean(column**2)))
    return np.asarray(column / size if size > 0.0 else column)


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
