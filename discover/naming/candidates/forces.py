"""Shapes of added forces that are tried."""

from __future__ import annotations

import numpy as np

from discover.naming.candidates.variant import Part, Variant, between_tests, one
from discover.naming.scales import Scales


def power_law(scales: Scales) -> list[Variant]:
    """Return powers of speed between and beyond the whole ones."""
    grid = [0.25, 0.35, 0.5, 0.65, 0.8, 1.2, 1.35, 1.5, 1.65, 1.75, 2.3, 2.6, 3.0]
    return [one("power-law-damping", 1, exponent=p) for p in grid]


def asymmetric(scales: Scales) -> list[Variant]:
    """Return a loss that differs by direction, at several powers of speed; else of one way only."""
    name = "asymmetric-damping"
    others = [
        one(name, 2, power=power, side=side) for power in (0.5, 1.5, 2.0, 3.0)
        for side in (1.0, -1.0)
    ]
    return [one(name, 0, power=1.0, side=0.0), *others]


def fractional(scales: Scales) -> list[Variant]:
    """Return orders between the whole ones."""
    grid = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9]
    return [one("fractional-derivative", 1, order=a) for a in grid]


def cubic(scales: Scales) -> list[Variant]:
    """Return a cube, a spring that closes up, one that levels off."""
    closing = [
        one("cubic-stiffness", 1, closure=float(c * scales.displacement))
        for c in (1.05, 1.2, 1.5, 2.5)
    ]
    levelling = [
        one("cubic-stiffness", 1, span=float(s * scales.displacement))
        for s in (0.2, 0.5, 1.0, 2.5)
    ]
    return [one("cubic-stiffness"), *closing, *levelling]


def end_stop(scales: Scales) -> list[Variant]:
    """Return stops on both sides or one, elastic, dissipating, or at two gaps."""
    gaps = [g * scales.displacement for g in (0.3, 0.45, 0.55, 0.65, 0.72, 0.78, 0.84, 0.89,
                                              0.93, 0.96)]
    springs = [
        one("end-stop", 1, gap=gap, exponent=p, side=s)
        for gap in gaps
        for p in (1.0, 1.5, 2.0, 3.0)
        for s in (0.0, 1.0, -1.0)
    ]
    lossy = [
        {"loss": loss / scales.speed, "form": form, "exponent": p}
        for p in (1.0, 2.0)
        for loss, form in ((0.5, 0.0), (3.0, 0.0), (1.0, 1.0), (10.0, 1.0))
    ]
    times = (0.03, 0.1, 0.3)  # of the time in which the stroke is passed
    damped = [{"damping_time": t * scales.displacement / scales.speed} for t in times]
    dissipating = [
        one("end-stop", 2, gap=gap, side=s, **{"exponent": 1.0, **more})
        for s, some in ((0.0, gaps), (1.0, gaps[::2]), (-1.0, gaps[::2]))
        for gap in some
        for more in (*lossy, *damped, {"dry_loss": 0.3})
    ]
    uneven = [
        Variant(
            "end-stop",
            (
                Part("end-stop", {"gap": up, "exponent": 1.0, "side": 1.0}),
                Part("end-stop", {"gap": down, "exponent": 1.0, "side": -1.0}),
            ),
            2,
        )
        for up in gaps[::2]
        for down in gaps[::2]
        if up != down
    ]
    return springs + dissipating + uneven


def hysteresis(scales: Scales) -> list[Variant]:
    """Return yield displacements, in each form."""
    return [
        one("hysteresis", 1, yield_displacement=float(r), form=float(form))
        for r in np.geomspace(0.02, 1.5, 10) * scales.displacement
        for form in (0, 1, 2)
    ]


def thermal(scales: Scales) -> list[Variant]:
    """Return oil or seals that warm, with time or with the loss, within tests or between."""
    straight = [
        one("thermal-drift", 1, warming_time=float(t), heating=heating)
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
        for heating in (0.0, 1.0)
    ]
    most = 0.5 * scales.speed**2
    saturated = [
        one("thermal-drift", 2, warming_time=float(t), heating=1.0, saturation=k / (most * whole))
        for t, whole in ((0.0, scales.duration), (0.3 * scales.duration, 1.0))
        for k in (2.0, 8.0, 30.0)
    ]
    seals = [
        one("thermal-drift", 2, warming_time=float(t), power=0.0, transition_speed=scales.reversal)
        for t in (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
    ]
    between = between_tests("thermal-drift", scales)
    between += [
        one(
            "thermal-drift", 2,
            **{**v.parts[0].shape, "power": 0.0, "transition_speed": scales.reversal},
        )
        for v in between
    ]
    return straight + saturated + seals + between
