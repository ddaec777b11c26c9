"""Cavitation: suction can't fall below vapour pressure, so force in one direction is limited."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.joint import Joint, through_joint
from models.terms.joint_device import device_of
from models.terms.scales import Scales
from models.terms.sensor_clipping import excess
from models.terms.term import ForceOf, Parameter, Shape, Start, Term

_REACHED = (0.1, 0.96)
"""Of the greatest force, where a limit lies that is reached: else all that is left is a spring."""


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the device's force, the fluid's part of which is limited on one side.

    With `contact` (rad/s) above 0 the oil column tears: a void grows while the limit holds, the
    fluid lags behind, and force returns when the void is filled, or where a valve makes up what
    is lost (`refill` 1), with a slam `lag` (s) after the flow has turned. The limit deepens by
    the resistance of such a valve (`valve`, N s/m) to what it makes up. With `contact` 0 the force
    is only cut.
    `coefficient` 1 is all of what it changes.
    """
    force = force_of(motion)
    limit, side = shape["limit"], 1.0 if shape["side"] >= 0.0 else -1.0
    if shape["contact"] == 0.0:
        cut = {"limit": limit, "softness": shape["softness"], "side": side}
        return np.asarray(force - coefficient * excess(force, cut))
    device = device_of(force, motion, force_of)
    stiffness = device.mass * shape["contact"] ** 2
    if stiffness <= 0.0:
        return force
    lower, upper = (-np.inf, limit) if side > 0.0 else (-limit, np.inf)
    joint = Joint(
        stiffness,
        shape["loss"],
        lower=lower,
        upper=upper,
        refilled=shape["refill"] > 0.0,
        lag=shape["lag"],
        valve=shape["valve"],
        fluid_only=True,
    )
    return np.asarray(force + coefficient * (through_joint(force, motion, joint, device) - force))


def starts(scales: Scales) -> list[Start]:
    """Return limits at which oil tears, either way, made up through a valve or not."""
    return [
        Start.one(
            limit=float(c * scales.force), contact=k * scales.omega, loss=0.3, refill=refill,
            lag=lag / scales.omega, side=side,
        )
        for c in np.linspace(*_REACHED, 12)
        for k, refill, lag in (
            (6.0, 0.0, 0.0), (25.0, 0.0, 0.0), (25.0, 1.0, 0.0), (25.0, 1.0, 0.1),
        )
        for side in (1.0, -1.0)
    ]


def described(shape: Shape) -> str:
    """Return which way the oil tears, and whether a valve makes up what is lost."""
    side = "in tension" if shape.get("side", -1.0) >= 0.0 else "in compression"
    return f"{side}, made up through a valve" if shape.get("refill", 0.0) else side


TERM = Term(
    "cavitation",
    "1",
    "the fluid's force in one direction is limited; a void grows and fills",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("limit", *_REACHED, 0.7, "N", "force"),
        Parameter("softness", 0.0, 0.5, 0.0, "N"),
        Parameter("contact", 0.0, 1e4, 0.0, "rad/s"),
        Parameter("loss", 0.0, 1.0, 0.2, ""),
        Parameter("refill", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("lag", 0.0, 0.1, 0.0, "s"),
        Parameter("valve", 0.0, 1e7, 0.0, "N s/m", "", "log"),
        Parameter("side", -1.0, 1.0, -1.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("asymmetric-damping", "sensor-clipping"),
    bounds=lambda shape: (0.0, 1.0),
    impacts=lambda shape: shape["contact"] > 0.0,
    starts=starts,
    described=described,
)
