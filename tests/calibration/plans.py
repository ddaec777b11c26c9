"""Plans of sine tests for the study on the virtual rig, and new tests among them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from models.rig import Limits, sine_point

PLANS = ("wide", "narrow", "single", "one amplitude")
NEW = 12
"""New tests in a band."""


def drawn_points(rng, plan: str, device) -> list[tuple[float, float]]:
    """Return frequencies (Hz) and amplitudes (m) of a plan, one of `PLANS`, in the rig's limits."""
    low, high = rng.uniform(0.1, 0.5), rng.uniform(5.0, 15.0)
    count, levels = int(rng.integers(5, 10)), int(rng.integers(2, 4))
    if plan == "narrow":
        low = float(np.exp(rng.uniform(np.log(0.3), np.log(6.0))))
        high, levels = low * rng.uniform(1.3, 2.0), 3
    elif plan == "single":
        low = high = float(np.exp(rng.uniform(np.log(0.5), np.log(5.0))))
        count, levels = 1, 6
    elif plan == "one amplitude":
        levels = 1
    amplitudes = rng.uniform(0.01, 0.02) * (0.75 if plan == "single" else 0.5) ** np.arange(levels)
    limits = Limits()
    return [
        (float(f), float(a))
        for a in amplitudes
        for f in np.geomspace(low, high, count)
        if limits.allows(device, sine_point(float(f), float(a)))
    ]


def new_points(rng, tested: Sequence[tuple[float, float]], device, inside) -> list:
    """Return new tests in the range of those in a band, inside it and the rig's limits."""
    f, a = np.array(tested).T
    limits, result = Limits(), []
    for _ in range(200 * NEW):
        point = tuple(
            float(np.exp(rng.uniform(np.log(v.min()), np.log(v.max())))) for v in (f, a)
        )
        if inside(*point) and limits.allows(device, sine_point(*point)):
            result.append(point)
        if len(result) == NEW:
            break
    return result
