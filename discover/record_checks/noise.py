"""Noise floor of a channel: what does not repeat, or what lies above the motion's band."""

from __future__ import annotations

import numpy as np

from discover.record_kind import RecordKind
from models.checks import Array


def noise_floor(x: Array, step: float, kind: RecordKind) -> float | None:
    """Return the noise's standard deviation, or None where the record can't tell.

    In a sine test of two cycles or more, and in a periodic record, noise is what differs from one
    period to the next (in other records, and in shorter sine tests, the density above the band,
    taken as white).

    Parameters
    ----------
    x : ndarray, shape (N,)
        The channel, whole.
    step : float
        Sampling interval, s.
    kind : RecordKind
        What the record is.

    Returns
    -------
    float or None

    Examples
    --------
    >>> from discover.record_kind import classify
    >>> from discover.records import Record
    >>> t = np.arange(4000) / 200.0
    >>> x = np.sin(7.0 * t)
    >>> force = x + 0.03 * np.random.default_rng(0).standard_normal(4000)
    >>> round(noise_floor(force, 0.005, classify(Record("r", t, force, x))), 3)
    0.03
    """
    used = x[kind.usable]
    if kind.period is not None and kind.cycles is not None and kind.cycles >= 2.0:
        return repeat_noise(used, kind.period / step)
    return band_noise(used)


def repeat_noise(x: Array, period: float) -> float:
    """Return the noise from the differences of each period to the next.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Signal.
    period : float
        In samples, whole or not: the next period is interpolated by a cubic through four samples,
        and what that does to white noise is allowed for.

    Returns
    -------
    float
        Standard deviation. Differences beyond four standard deviations are left out: a jump of
        the force that falls between two samples repeats, but not on the same sample.
    """
    whole = int(np.floor(period))
    part = period - whole
    weights = np.array([1.0]) if part < 1e-6 else _cubic(part)
    lead = 0 if weights.size == 1 else 1
    count = x.size - whole - (weights.size - 1 - lead)
    first = max(0, lead - whole)
    if count - first < 8:
        return band_noise(x)
    later = np.zeros(count - first)
    for offset, weight in enumerate(weights):
        begin = first + whole - lead + offset
        later += weight * x[begin : begin + count - first]
    change = later - x[first:count]
    change = change - np.median(change)  # drift from cycle to cycle is not noise
    for _ in range(3):
        spread = float(np.sqrt(np.mean(change**2)))
        kept = np.abs(change) <= 4.0 * spread
        if kept.all():
            break
        change = change[kept]
    return spread / float(np.sqrt(1.0 + weights @ weights))


def _cubic(part: float) -> Array:
    """Return the weights of samples -1, 0, 1, 2 for the value at `part` between 0 and 1."""
    p = part
    return np.array(
        [
            -p * (p - 1.0) * (p - 2.0) / 6.0,
            (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0,
            -(p + 1.0) * p * (p - 2.0) / 2.0,
            (p + 1.0) * p * (p - 1.0) / 6.0,
        ]
    )


def band_noise(x: Array) -> float:
    """Return the standard deviation of white noise with the density found above the band.

    The band ends where all but a thousandth of the power is below; the median density from twice
    that on (the top quarter of the spectrum where there is less) is the noise's.
    """
    window = np.hanning(x.size)
    ramp = np.linspace(-1.0, 1.0, x.size)
    plain = x - x.mean() - ramp * (ramp @ x) / (ramp @ ramp)
    density = np.abs(np.fft.rfft(plain * window)) ** 2 / float(window @ window)
    power = np.cumsum(density)
    if power[-1] == 0.0:
        return 0.0
    end = 2 * int(np.searchsorted(power, 0.999 * power[-1]))
    start = min(end, (3 * density.size) // 4)
    return float(np.sqrt(np.median(density[start:]) / np.log(2.0)))
