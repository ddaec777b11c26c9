"""Sensor clipping: the force channel saturates, or a relief valve opens: both limit the force."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force less `coefficient` (1: all) of what exceeds the limit.

    `softness` (N) rounds the corner; `side` 0 clips both ways, 1 only above, -1 only below.
    """
    force = force_of(motion)
    return np.asarray(force - coefficient * excess(force, shape))


def excess(force: Array, shape: Shape) -> Array:
    """Return what of `force` lies beyond the limit, N, signed."""
    limit, soft = shape["limit"], shape["softness"]

    def beyond_limit(value: Array) -> Array:
        depth = value - limit
        if soft == 0.0:
            return np.asarray(np.maximum(depth, 0.0))
        return np.asarray(soft * np.logaddexp(0.0, depth / soft))

    upper = beyond_limit(force) if shape["side"] >= 0.0 else np.zeros_like(force)
    lower = beyond_limit(-force) if shape["side"] <= 0.0 else np.zeros_like(force)
    return np.asarray(upper - lower)


def starts(scales: Scales) -> list[Start]:
    """Return rails on both sides or one, hard or soft, or at two limits."""
    shares = (0.3, 0.4, 0.5, 0.6, 0.7, 0.78, 0.85, 0.9, 0.95, 0.98)

    def clipped_at(limit: float, soft: float, side: float) -> Shape:
        force = limit * scales.force
        return {"limit": force, "softness": soft * force, "side": side}

    even = [
        Start((clipped_at(c, soft, side),))
        for c in shares
        for soft in (0.0, 0.1)
        for side in (0.0, 1.0, -1.0)
    ]
    uneven = [
        Start((clipped_at(up, 0.0, 1.0), clipped_at(down, 0.0, -1.0)))
        for up in shares[1::2]
        for down in shares[1::2]
        if up != down
    ]
    return even + uneven


def described(shape: Shape) -> str:
    """Return on which side the limit is, where not on both."""
    return {1.0: "above only", -1.0: "below only"}.get(shape.get("side", 0.0), "")


TERM = Term(
    "sensor-clipping",
    "1",
    "the force channel saturates at the limit, or a valve opens there; the coefficient is the share"
    " lost of what is beyond",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("limit", 0.2, 1.0, 0.9, "N", "force"),
        Parameter("softness", 0.0, 0.5, 0.0, "N"),
        Parameter("side", -1.0, 1.0, 0.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("cavitation",),
    bounds=lambda shape: (0.0, 1.0),
    starts=starts,
    of_channel=True,
    described=described,
)
