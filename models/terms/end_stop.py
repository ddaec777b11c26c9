"""End stop: a spring that is met only beyond a gap from the middle, with what it dissipates."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the depth of contact to the power `exponent`, signed; `side` 0 for both ends.

    A stop never pulls. With `loss` (s/m) its force is 1 + loss times the speed of approach of
    itself, as a bumper's (Hunt and Crossley, 1975); with `form` 1 also 1 + the square of that on
    approach, and itself on retreat, as a cushion's that closes an outlet. With `damping_time`
    (s) the depth counts with that many times its rate, a damper beside the spring. With `dry_loss`
    it pushes by that share harder on approach and more weakly on retreat, at any speed.
    """
    x, v, gap = motion.displacement, motion.velocity, shape["gap"]
    total = np.zeros_like(x)
    for end in (1.0, -1.0):
        if end * shape["side"] >= 0.0:
            total += end * _push(end * x - gap, end * v, shape)
    return total


def _push(depth: Array, approach: Array, shape: Shape) -> Array:
    """Return what one end's stop pushes with, (N,), at a depth (m) that grows at a rate (m/s)."""
    met = np.maximum(depth, 0.0)
    if shape["damping_time"] > 0.0:
        sprung = np.maximum(depth + shape["damping_time"] * approach, 0.0)
        met = np.where(depth > 0.0, sprung, 0.0)
    push = met ** shape["exponent"] * (1.0 + shape["dry_loss"] * np.sign(approach))
    faster = shape["loss"] * approach
    if shape["form"] > 0.0:
        return np.asarray(push * (1.0 + np.maximum(faster, 0.0) ** 2))
    return np.asarray(push * np.maximum(1.0 + faster, 0.0))


_GAPS = (0.3, 0.45, 0.55, 0.65, 0.72, 0.78, 0.84, 0.89, 0.93, 0.96)


def starts(scales: Scales) -> list[Start]:
    """Return stops on both sides or one, elastic, dissipating, or at two gaps."""
    gaps = [g * scales.displacement for g in _GAPS]
    springs = [
        Start.one(gap=gap, exponent=p, side=side)
        for gap in gaps
        for p in (1.0, 2.0)
        for side in (0.0, 1.0, -1.0)
    ]
    lossy: list[dict[str, float]] = [
        {"loss": 1.0 / scales.speed},
        {"loss": 1.0 / scales.speed, "form": 1.0},
        {"damping_time": 0.1 * scales.displacement / scales.speed},
        {"dry_loss": 0.3},
    ]
    dissipating = [
        Start.one(gap=gap, side=side, **more)
        for side in (0.0, 1.0, -1.0)
        for gap in gaps[1::2]
        for more in lossy
    ]
    uneven = [
        Start(({"gap": up, "side": 1.0}, {"gap": down, "side": -1.0}))
        for up in gaps[::2]
        for down in gaps[::2]
        if up != down
    ]
    return springs + dissipating + uneven


def described(shape: Shape) -> str:
    """Return at which end the stop is, and whether it is a cushion's."""
    end = {1.0: "at the extended end", -1.0: "at the compressed end"}.get(shape.get("side", 0.0))
    kind = "a hydraulic cushion" if shape.get("form", 0.0) else ""
    return ", ".join(part for part in (end, kind) if part)


TERM = Term(
    "end-stop",
    "N/m^{exponent}",
    "k times the depth of contact beyond the gap, to a power (1 linear, 1.5 Hertz)",
    column,
    parameters=(
        Parameter("gap", 0.1, 0.99, 0.8, "m", "displacement"),
        Parameter("exponent", 1.0, 3.0, 1.0, ""),
        Parameter("side", -1.0, 1.0, 0.0, "", fitted=False),
        Parameter("loss", 1e-4, 1e5, 0.0, "s/m", "", "log"),
        Parameter("damping_time", 1e-6, 1e3, 0.0, "s", "", "log"),
        Parameter("dry_loss", 0.01, 1.0, 0.0, ""),
        Parameter("form", 0.0, 1.0, 0.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("cubic-stiffness", "stiffness"),
    starts=starts,
    described=described,
)
