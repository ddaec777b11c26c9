"""Shapes of friction that are tried."""

from __future__ import annotations

import numpy as np

from discover.naming.candidates.variant import Part, Variant, one
from discover.naming.scales import Scales


def coulomb(scales: Scales) -> list[Variant]:
    """Return a jump, a reversal over a speed, a deflection before sliding."""
    speeds = [0.0, *np.geomspace(0.002, 0.25, 7) * scales.speed]
    lengths = np.geomspace(1e-4, 0.02, 6) * scales.displacement
    jumps = [one("coulomb-friction", 1, transition_speed=float(s)) for s in speeds]
    return jumps + [one("coulomb-friction", 1, presliding=float(z)) for z in lengths]


def stribeck(scales: Scales) -> list[Variant]:
    """Return speeds over which friction falls, beside a jump or bristles."""
    bristles = [
        one(
            "stribeck-friction", 2, stribeck_velocity=float(s), form=float(form),
            presliding=float(z),
        )
        for s in np.geomspace(0.01, 0.5, 5) * scales.speed
        for z in np.geomspace(3e-4, 0.05, 5) * scales.displacement
        for form in (0, 1, 2)
    ]
    return bristles + [
        one(
            "stribeck-friction", 1, stribeck_velocity=float(s), form=float(form),
            transition_speed=scales.reversal,
        )
        for s in np.geomspace(0.004, 0.5, 9) * scales.speed
        for form in (0, 1, 2)
    ]


def along_the_stroke(scales: Scales) -> list[Variant]:
    """Return friction by powers of displacement, in a place, or periodic along the rod."""
    name, speed = "position-dependent-friction", scales.reversal
    first, second, fourth = (
        Part(name, {"power": p, "transition_speed": speed}) for p in (1.0, 2.0, 4.0)
    )
    sets = ((first,), (second,), (first, second), (second, fourth), (first, second, fourth))
    local = [
        one(
            name, 2, power=0.0, form=form, place=place * scales.displacement,
            width=width * scales.displacement, transition_speed=speed,
        )
        for form in (0.0, 2.0)
        for place in (-0.5, 0.05, 0.5)
        for width in (0.15, 0.4)
    ]
    periodic = [
        one(
            name, 2, power=0.0, form=3.0, place=phase * width, width=width, transition_speed=speed
        )
        for width in scales.displacement / np.arange(0.7, 4.0, 0.15)
        for phase in (1.0 / 12.0, 0.25, 5.0 / 12.0)  # the sign gives the others
    ]
    return [*(Variant(name, parts, 0) for parts in sets), *local, *periodic]
