"""Shapes of what gives between displacement and force that are tried: mounts, play, torn oil."""

from __future__ import annotations

from itertools import product

import numpy as np

from discover.naming.candidates.variant import Variant, one
from discover.naming.scales import Scales

_SOFT = 0.1  # of a play's gap, over which flanks of rubber are met


def compliance(scales: Scales) -> list[Variant]:
    """Return springs at either end of the flow, straight or stiffening under load."""
    stiffest = scales.force / scales.displacement
    springs = np.geomspace(0.001, 0.3, 10) / stiffest
    plain = [
        one("series-compliance", 1, probe=float(c), loss=loss, inside=inside)
        for c in springs
        for loss in (0.03, 0.25)
        for inside in (0.0, 1.0)
    ]
    loaded = [
        one(
            "series-compliance", 2, probe=float(c), loss=0.1, inside=1.0,
            half_load=h * scales.force, load_share=share, side=side,
        )
        for c in springs[2::2]
        for h, share in ((0.1, 0.3), (0.1, 0.7), (0.5, 0.6), (2.0, 0.9), (0.3, -0.4))
        for side in (0.0, 1.0, -1.0)
    ]
    return plain + loaded


def backlash(scales: Scales) -> list[Variant]:
    """Return gaps with hard or soft flanks."""
    return [
        one(
            "backlash", 4 if soft else 3, gap=float(g * scales.displacement),
            contact=k * scales.omega, loss=loss, inside=0.0, softness=soft,
        )
        for g in np.geomspace(1e-4, 0.3, 11)
        for k, loss, soft in (
            *product((4.0, 12.0, 30.0), (0.15, 0.5), (0.0,)), (12.0, 0.5, _SOFT), (40.0, 0.5, _SOFT)
        )
    ]


def cavitation(scales: Scales) -> list[Variant]:
    """Return limits at which oil tears, either way, made up through a valve or not."""
    shares = np.linspace(0.1, 0.96, 12)
    return [
        one("cavitation", 3, limit=float(c * scales.force), contact=k * scales.omega, loss=0.3,
            refill=refill, lag=lag / scales.omega, side=s)
        for c in shares
        for k, refill, lag in (
            (6.0, 0.0, 0.0), (25.0, 0.0, 0.0), (25.0, 1.0, 0.0), (25.0, 1.0, 0.1),
        )
        for s in (1.0, -1.0)
    ]
