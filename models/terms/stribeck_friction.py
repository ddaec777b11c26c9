"""Stribeck friction: the fall of seal friction from its static to its sliding value."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.hysteresis import bristle_state
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return exp(-(v/v_s)^2) sign v.

    `form` 1 is exp(-|v|/v_s) sign v, 2 the rational fall sign v / (1 + (v/v_s)^2). With a
    transition speed, tanh stands for the sign; with a `presliding` length (m) the state of
    bristles that deflect before they slip, and hold less the faster they do (LuGre).
    """
    v, speed = motion.velocity, shape["transition_speed"]
    ratio = np.abs(v) / shape["stribeck_velocity"]
    falls = (np.exp(-(ratio**2)), np.exp(-ratio), 1.0 / (1.0 + ratio**2))
    if shape["presliding"] > 0.0:
        return bristle_state(motion, shape["presliding"], falls[int(shape["form"])])
    direction = np.sign(v) if speed == 0.0 else np.tanh(v / speed)
    return np.asarray(falls[int(shape["form"])] * direction)


def _forms(scales: Scales) -> list[tuple[float, float]]:
    return [
        (float(s), form)
        for s in np.geomspace(0.004, 0.5, 9) * scales.speed
        for form in (0.0, 1.0, 2.0)
    ]


def starts(scales: Scales) -> list[Start]:
    """Return speeds over which friction falls, beside a reversal or bristles."""
    plain = [
        Start.one(stribeck_velocity=s, form=form, transition_speed=scales.reversal)
        for s, form in _forms(scales)
    ]
    bristles = [
        Start.one(stribeck_velocity=s, form=form, presliding=float(z))
        for s, form in _forms(scales)[3::6]
        for z in np.geomspace(3e-4, 0.05, 5) * scales.displacement
    ]
    return plain + bristles


def curves(scales: Scales) -> list[Shape]:
    """Return falls over the speeds over which friction may reverse, beside one at once."""
    return [{"stribeck_velocity": s} for s in scales.reversals()]


_FALLS = ("", "falling as exp(−|v|/v_s)", "falling as 1/(1 + (v/v_s)²)")


def described(shape: Shape) -> str:
    """Return the law of the fall, where it is not the plain one."""
    return _FALLS[int(shape.get("form", 0.0))]


TERM = Term(
    "stribeck-friction",
    "N",
    "f_s times a fall with speed over v_s, times sign v, beside Coulomb friction",
    column,
    parameters=(
        Parameter("stribeck_velocity", 0.01, 0.5, 0.1, "m/s", "speed", "log"),
        Parameter("form", 0.0, 2.0, 0.0, "", fitted=False),
        Parameter("transition_speed", 0.001, 0.3, 0.0, "m/s", "speed", "log"),
        Parameter("presliding", 1e-5, 0.05, 0.0, "m", "displacement", "log"),
    ),
    nonnegative=True,
    mistaken_for=("coulomb-friction", "hysteresis"),
    follows=lambda shape: "path" if shape["presliding"] > 0.0 else "motion",
    needs=("coulomb-friction",),
    starts=starts,
    curves=curves,
    described=described,
)
