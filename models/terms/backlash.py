"""Backlash: play in a joint, in which the device coasts until the other flank is met."""

from itertools import product

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.joint import Joint, through_joint
from models.terms.joint_device import device_of
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force through a joint with play; `coefficient` 1 is all of what it changes.

    The flanks' contact has the natural frequency `contact` (rad/s) with the device's mass. With
    `softness` they are met gradually, over that share of the gap, as those of a rubber bushing.
    """
    force = force_of(motion)
    device = device_of(force, motion, force_of)
    stiffness = device.mass * shape["contact"] ** 2
    if stiffness <= 0.0:
        return force
    gap = shape["gap"]
    soft, inside = gap * shape["softness"], shape["inside"] > 0.0
    joint = Joint(stiffness, shape["loss"], gap=gap, soft=soft, fluid_only=inside)
    return np.asarray(force + coefficient * (through_joint(force, motion, joint, device) - force))


def starts(scales: Scales) -> list[Start]:
    """Return gaps with hard or soft flanks."""
    flanks = (
        *product((4.0, 12.0, 30.0), (0.15, 0.5), (0.0,)), (12.0, 0.5, 0.1), (40.0, 0.5, 0.1)
    )
    return [
        Start.one(
            gap=float(g * scales.displacement), contact=k * scales.omega, loss=loss, softness=soft
        )
        for g in np.geomspace(1e-4, 0.3, 11)
        for k, loss, soft in flanks
    ]


def described(shape: Shape) -> str:
    """Return where the play is, where dry friction is beside it."""
    return "in the fluid, beside dry friction" if shape.get("inside", 0.0) else ""


TERM = Term(
    "backlash",
    "1",
    "play of width gap in a joint: the device coasts in it",
    transform=transform,
    acts="input",
    parameters=(
        Parameter("gap", 0.001, 1.0, 0.05, "m", "displacement", "log"),
        Parameter("contact", 10.0, 1e4, 600.0, "rad/s", "", "log"),
        Parameter("loss", 0.0, 1.0, 0.2, ""),
        Parameter("inside", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("softness", 0.0, 1.0, 0.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("hysteresis", "coulomb-friction", "series-compliance"),
    bounds=lambda shape: (0.0, 1.0),
    impacts=lambda shape: True,
    starts=starts,
    described=described,
)
