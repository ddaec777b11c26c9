"""Series compliance: a mount, a joint or the oil yields, so the device moves less than the ends."""

from models.checks import Array
from models.motion import Motion
from models.terms.joint import Joint, device_of, through_joint
from models.terms.term import ForceOf, Parameter, Shape, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force through a spring of this compliance, stepped in time.

    With `inside` 1 the spring is that of the fluid, and dry friction is beside it. Gas in it makes
    a share `gas` of the unloaded compliance; `hardening` (N) squeezes it to half its volume, on
    one `side` or (0) on both.
    """
    force = force_of(motion)
    if coefficient <= 0.0:
        return force
    joint = Joint(
        1.0 / coefficient,
        shape["loss"],
        hardening=shape["hardening"],
        gas=shape["gas"],
        hardens=shape["side"],
        fluid_only=shape["inside"] > 0.0,
    )
    return through_joint(force, motion, joint, device_of(force, motion))


TERM = Term(
    "series-compliance",
    "m/N",
    "a spring of this compliance in series: the device sees x - c F",
    transform=transform,
    acts="input",
    parameters=(
        Parameter("loss", 0.0, 1.0, 0.05, ""),
        Parameter("inside", 0.0, 1.0, 0.0, ""),
        Parameter("hardening", 0.0, 1e9, 0.0, "N"),
        Parameter("gas", 0.0, 0.95, 0.0, ""),
        Parameter("side", -1.0, 1.0, 0.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("inertia", "time-delay", "fractional-derivative"),
)
