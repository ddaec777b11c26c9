"""Coulomb friction of seals, reversing over a finite range of speed."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.hysteresis import bristle_state, slider_state
from models.terms.scales import Scales, doubling
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return sign v, or where the transition speed v_t is not zero a curve that reverses over it.

    That is tanh(v/v_t), or with `form` 1 the slower v/sqrt(v^2 + v_t^2). A `sharpness` m other than
    0 changes its knee: tanh(u^m)^(1/m) and u/(1 + u^2m)^(1/2m) of u = |v|/v_t, with the sign of v;
    they are the plain curves for m = 1, and a straight line up to a limit for a large one.
    Where `other_share` is not 0, that share of the friction reverses over `other_speed` (m/s)
    instead, 0 for a jump, along the plain curve: seals differ, and a limit may be approached in
    two stages.
    With a `relative_speed` the transition speed is that share of the motion's greatest speed.
    With a `presliding` length (m) it is the state of bristles that deflect before they slip, or
    with `form` 1 of an elastic slider: the one slips more and more, the other at once.
    """
    length = shape.get("presliding", 0.0)
    if length > 0.0:
        sudden = shape.get("form", 0.0) > 0.0
        return slider_state(motion, length) if sudden else bristle_state(motion, length)
    transition = shape.get("transition_speed", 0.0)
    if shape.get("relative_speed", 0.0) > 0.0:
        transition = shape["relative_speed"] * float(np.abs(motion.velocity).max())
    if transition == 0.0:
        return np.sign(motion.velocity)
    form, share = shape.get("form", 0.0), shape.get("other_share", 0.0)
    curve = _reversing(motion.velocity / transition, form, shape.get("sharpness", 0.0))
    if share == 0.0:
        return curve
    speed = shape.get("other_speed", 0.0)
    jump = np.sign(motion.velocity)
    other = _reversing(motion.velocity / speed, form, 0.0) if speed > 0.0 else jump
    return (1.0 - share) * curve + share * other


def _reversing(speed: Array, form: float, sharpness: float) -> Array:
    """Return one curve over the speed in its transition speeds."""
    slow = form > 0.0
    if sharpness == 0.0:
        return speed / np.hypot(speed, 1.0) if slow else np.tanh(speed)
    size = np.abs(speed)
    if not slow:
        return np.sign(speed) * np.tanh(size**sharpness) ** (1.0 / sharpness)
    less, more = np.minimum(size, 1.0), np.maximum(size, 1.0)  # neither power overflows
    power = 2.0 * sharpness
    knee = (less**power + more**-power) ** (-1.0 / power)
    return np.sign(speed) * less * knee


def starts(scales: Scales) -> list[Start]:
    """Return a jump, a reversal over a speed, a deflection before sliding."""
    speeds = [0.0, *np.geomspace(0.002, 0.25, 7) * scales.speed]
    lengths = np.geomspace(1e-4, 0.02, 6) * scales.displacement
    reversing = [Start.one(transition_speed=float(s)) for s in speeds]
    return reversing + [Start.one(presliding=float(z)) for z in lengths]


def curves(scales: Scales) -> list[Shape]:
    """Return a jump, reversals over speeds and displacements, and at shares of a record's speed."""
    lengths = doubling(0.002 * scales.least_displacement, 0.1 * scales.displacement)
    return [
        {},
        *({"transition_speed": s} for s in scales.reversals()),
        *({"presliding": z} for z in lengths),
        *({"presliding": z, "form": 1.0} for z in lengths),
        *({"relative_speed": r} for r in doubling(0.003, 0.1)),
    ]


def described(shape: Shape) -> str:
    """Return which curve a shape has, where it is not the plain one."""
    if not shape.get("form", 0.0):
        return ""
    return "an elastic slider" if shape.get("presliding", 0.0) else "a slow approach, v/√(v²+v_t²)"


TERM = Term(
    "coulomb-friction",
    "N",
    "f0 times sign v; friction reverses over the transition speed, 0 for a jump",
    column,
    parameters=(
        Parameter("transition_speed", 1e-4, 0.3, 0.0, "m/s", "speed", "log"),
        Parameter("presliding", 1e-5, 0.02, 0.0, "m", "displacement", "log"),
        Parameter("relative_speed", 1e-3, 0.3, 0.0, "", "", "log"),
        Parameter("form", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("sharpness", 0.5, 20.0, 0.0, "", "", "log"),
        Parameter("other_speed", 1e-4, 0.03, 0.0, "m/s", "speed", "log"),
        Parameter("other_share", 0.02, 0.98, 0.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("stribeck-friction", "power-law-damping", "hysteresis"),
    follows=lambda shape: "path" if shape["presliding"] > 0.0 else "motion",
    starts=starts,
    curves=curves,
    described=described,
    departure=0.3,
)
