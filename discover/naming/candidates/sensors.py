"""Shapes of what channels do to the force that are tried."""

from __future__ import annotations

import numpy as np

from discover.naming.candidates.variant import (
    Part,
    Variant,
    between_tests,
    each_its_own,
    numbered,
    one,
)
from discover.naming.scales import COARSE, Scales

_TESTS = 32  # of a campaign, from which a gain may have changed
_IN_BAND = 0.1  # rad of the fastest test, from which a filter's own time constant shows


def delay(scales: Scales) -> list[Variant]:
    """Return a later sample, samples aligned by lines or splines, a low-pass, one value a test."""
    made = ((0, 0.0), (1, 1.0), (1, 3.0))  # sampled later, or aligned from samples
    rates = (0.0, scales.sampling) if scales.sampling else (0.0,)
    probe = 0.02 / scales.omega
    sampled = [
        one("time-delay", shapes + (rate > 0.0), probe, resampled=degree, sampling=rate)
        for rate in rates
        for shapes, degree in made
    ]
    filtered = [
        one("time-delay", 1, probe, filter_order=order, digital=digital)
        for order in (1.0, 2.0, 4.0)
        for digital in ((0.0, 1.0) if probe < COARSE * scales.step else (0.0,))
    ]
    own = [[Part("time-delay", {"only": n}, probe) for n in numbered(scales)]]
    return sampled + filtered + each_its_own(own)


def drift(scales: Scales) -> list[Variant]:
    """Return a zero that settles, wanders, moves from test to test, or is another one in each."""
    settling = [
        one("sensor-drift", 1, settling_time=float(t))
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
    ]
    powers = [Part("sensor-drift", {"settling_time": 0.0, "power": p}) for p in (1.0, 2.0, 3.0)]
    wandering = [Variant("sensor-drift", tuple(powers[:n]), 0) for n in (2, 3)]
    numbers = numbered(scales)
    zeros = [Part("sensor-drift", {"over": 1.0, "only": n}) for n in numbers]
    slopes = [Part("sensor-drift", {"power": 1.0, "only": n}) for n in numbers]
    bends = [Part("sensor-drift", {"power": 2.0, "only": n}) for n in numbers]
    own = each_its_own([zeros, zeros + slopes, zeros + slopes + bends])
    return settling + wandering + between_tests("sensor-drift", scales) + own


def gain(scales: Scales) -> list[Variant]:
    """Return a gain throughout or of a range, a side, later tests, a filter, a droop, a load."""
    peaks = np.array(scales.peaks)
    between = np.sqrt(peaks[1:] * peaks[:-1])[peaks[1:] > 1.05 * peaks[:-1]]
    chosen = between[:: max(between.size // 16, 1)]
    uniform = [one("sensor-gain", 0, 1e-3, threshold=0.0, side=1.0)]
    ranges = [
        one("sensor-gain", 1, probe, threshold=float(t / np.sqrt(1.0 + probe)), side=1.0)
        for t in chosen for probe in (0.1, -0.1)  # as measured, peaks in the range have the gain
    ]
    one_way = [one("sensor-gain", 1, 1e-3, side=1.0, one_way=1.0)]
    later = range(2, scales.tests + 1, max(scales.tests // _TESTS, 1))
    changed = [one("sensor-gain", 1, 1e-3, side=1.0, from_test=float(test)) for test in later]
    settling = [
        one("sensor-gain", 1, 1e-3, side=1.0, settling_time=float(t * scales.duration))
        for t in (0.03, 0.1, 0.3, 1.0, 10.0)
    ]
    filtered = [  # above the band only the product of gain and time constant shows
        one("sensor-gain", int(t > _IN_BAND), 1e-3, side=1.0,
            filter_time=float(t / scales.omega), digital=digital)
        for t in np.geomspace(0.01, 1.0, 8)
        for digital in ((0.0, 1.0) if t / scales.omega < COARSE * scales.step else (0.0,))
    ]
    drooping = [
        one("sensor-gain", 1, -1e-3, side=1.0, droop_time=float(t / scales.slowest))
        for t in np.geomspace(0.3, 12.0, 10)
        if scales.slowest > 0.0
    ]
    loaded = [
        one("sensor-gain", 0, 1e-3, side=1.0, load=scales.force, load_power=p) for p in (1.0, 2.0)
    ]
    between = between_tests("sensor-gain", scales)
    return uniform + ranges + one_way + filtered + drooping + loaded + changed + settling + between


def clipping(scales: Scales) -> list[Variant]:
    """Return rails on both sides or one, hard or soft, or at two limits."""
    shares = (0.3, 0.4, 0.5, 0.6, 0.7, 0.78, 0.85, 0.9, 0.95, 0.98)

    def rail(limit: float, soft: float, side: float) -> Part:
        force = float(limit * scales.force)
        return Part("sensor-clipping", {"limit": force, "softness": soft * force, "side": side})

    even = [
        Variant("sensor-clipping", (rail(c, soft, side),), 1)
        for c in shares
        for soft in (0.0, 0.05, 0.15)
        for side in (0.0, 1.0, -1.0)
    ]
    uneven = [
        Variant("sensor-clipping", (rail(up, 0.0, 1.0), rail(down, 0.0, -1.0)), 2)
        for up in shares
        for down in shares
        if up != down
    ]
    return even + uneven
