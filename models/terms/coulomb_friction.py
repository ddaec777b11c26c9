"""Coulomb friction of seals, reversing over a finite range of speed."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.hysteresis import bristle_state
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return sign v, or where the transition speed v_t is not zero a curve that reverses over it.

    That is tanh(v/v_t), or with `form` 1 the slower v/sqrt(v^2 + v_t^2).
    With a `presliding` length (m) it is the state of bristles that deflect before they slip.
    """
    if shape.get("presliding", 0.0) > 0.0:
        return bristle_state(motion, shape["presliding"])
    transition = shape.get("transition_speed", 0.0)
    if transition == 0.0:
        return np.sign(motion.velocity)
    if shape.get("form", 0.0) > 0.0:
        return motion.velocity / np.hypot(motion.velocity, transition)
    return np.tanh(motion.velocity / transition)


TERM = Term(
    "coulomb-friction",
    "N",
    "f0 times sign v; friction reverses over the transition speed, 0 for a jump",
    column,
    parameters=(
        Parameter("transition_speed", 0.001, 0.3, 0.0, "m/s", "speed", "log"),
        Parameter("presliding", 1e-5, 0.02, 0.0, "m", "displacement", "log"),
        Parameter("form", 0.0, 1.0, 0.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("stribeck-friction", "power-law-damping", "hysteresis"),
)
