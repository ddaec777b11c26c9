"""End stop: a spring that is met only beyond a gap from the middle."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the depth of contact to the power `exponent`, signed; `side` 0 for both ends."""
    x, gap, power = motion.displacement, shape["gap"], shape["exponent"]
    upper = np.maximum(x - gap, 0.0) ** power
    lower = np.maximum(-x - gap, 0.0) ** power
    if shape["side"] == 0.0:
        return np.asarray(upper - lower)
    return upper if shape["side"] > 0.0 else -lower


TERM = Term(
    "end-stop",
    "N/m^{exponent}",
    "k times the depth of contact beyond the gap, to a power (1 linear, 1.5 Hertz)",
    column,
    parameters=(
        Parameter("gap", 0.1, 0.99, 0.8, "m", "displacement"),
        Parameter("exponent", 1.0, 3.0, 1.0, ""),
        Parameter("side", -1.0, 1.0, 0.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("cubic-stiffness", "stiffness"),
)
