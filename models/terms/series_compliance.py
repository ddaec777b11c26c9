"""Series compliance: a mount, a joint or the oil yields, so the device moves less than the ends."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.joint import Joint, through_joint
from models.terms.joint_device import device_of
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force through a spring of this compliance, stepped in time.

    With `inside` 1 the spring is that of the fluid, and dry friction is beside it. Under load, on
    one `side` or (0) on both, the spring loses the share `load_share` of its compliance, as gas in
    it is squeezed, or (below 0) gains it, as rubber and joints that open do: half of it at the
    force `half_load` (N).
    """
    force = force_of(motion)
    if coefficient <= 0.0:
        return force
    joint = Joint(
        1.0 / coefficient,
        shape["loss"],
        half_load=shape["half_load"],
        load_share=shape["load_share"],
        load_side=shape["side"],
        fluid_only=shape["inside"] > 0.0,
    )
    device = device_of(force, motion, force_of, deflects=True)
    return through_joint(force, motion, joint, device)


def starts(scales: Scales) -> list[Start]:
    """Return springs at either end of the flow, straight or stiffening under load."""
    springs = np.geomspace(0.001, 0.3, 10) * scales.displacement / scales.force
    plain = [
        Start.one(float(c), loss=loss, inside=inside)
        for c in springs
        for loss in (0.03, 0.25)
        for inside in (0.0, 1.0)
    ]
    loaded = [
        Start.one(
            float(c), loss=0.1, inside=1.0, half_load=h * scales.force, load_share=share, side=side
        )
        for c in springs[2::2]
        for h, share in ((0.1, 0.3), (0.1, 0.7), (0.5, 0.6), (2.0, 0.9), (0.3, -0.4))
        for side in (0.0, 1.0, -1.0)
    ]
    return plain + loaded


def described(shape: Shape) -> str:
    """Return whose spring it is and which way it changes under load."""
    where = "in the fluid, beside dry friction" if shape.get("inside", 0.0) else ""
    side = {1.0: "under tension only", -1.0: "under compression only"}.get(shape.get("side", 0.0))
    return ", ".join(part for part in (where, side) if part)


TERM = Term(
    "series-compliance",
    "m/N",
    "a spring of this compliance in series: the device sees x - c F",
    transform=transform,
    acts="input",
    parameters=(
        Parameter("loss", 0.0, 1.0, 0.05, ""),
        Parameter("inside", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("half_load", 0.0, 1e9, 0.0, "N"),
        Parameter("load_share", -3.0, 0.95, 0.0, ""),
        Parameter("side", -1.0, 1.0, 0.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("inertia", "time-delay", "fractional-derivative"),
    starts=starts,
    described=described,
)
