"""Friction that differs along the stroke: a tapered or worn bore, a bent rod."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

_STEP, _WAVE = 2.0, 3.0


def column(motion: Motion, shape: Shape) -> Array:
    """Return sign v times x to a whole `power`, reversing as friction does.

    With a `width` (m) it is only near a `place` (m), by a Gaussian bump, or (`form` 2) beyond it,
    by a smooth step, or (`form` 3) a cosine of that period about it, as of a thread or of marks
    that a tool left.
    """
    speed = shape["transition_speed"]
    v, x = motion.velocity, motion.displacement
    direction = np.sign(v) if speed == 0.0 else np.tanh(v / speed)
    along = direction
    for _ in range(int(shape["power"])):  # numpy's power takes twenty times as long
        along = along * x
    if shape["width"] == 0.0:
        return np.asarray(along)
    beyond = (x - shape["place"]) / shape["width"]
    if shape["form"] == _WAVE:
        return np.asarray(along * np.cos(2.0 * np.pi * beyond))
    local = 0.5 + 0.5 * np.tanh(beyond) if shape["form"] == _STEP else np.exp(-(beyond**2))
    return np.asarray(along * local)


def starts(scales: Scales) -> list[Start]:
    """Return friction by powers of displacement, in a place, or periodic along the rod."""
    speed, size = scales.reversal, scales.displacement
    first, second, fourth = (
        {"power": p, "transition_speed": speed} for p in (1.0, 2.0, 4.0)
    )
    sets = ((first,), (second,), (first, second), (second, fourth), (first, second, fourth))
    local = [
        Start.one(
            power=0.0, form=form, place=place * size, width=width * size, transition_speed=speed
        )
        for form in (0.0, _STEP)
        for place in (-0.5, 0.05, 0.5)
        for width in (0.15, 0.4)
    ]
    periodic = [
        Start.one(
            power=0.0, form=_WAVE, place=phase * width, width=width, transition_speed=speed
        )
        for width in size / np.arange(0.7, 4.0, 0.15)
        for phase in (1.0 / 12.0, 0.25, 5.0 / 12.0)  # the sign gives the others
    ]
    return [*(Start(parts) for parts in sets), *local, *periodic]


def described(shape: Shape) -> str:
    """Return how friction goes along the stroke."""
    if not shape.get("width", 0.0):
        return f"as displacement to the power {shape.get('power', 1.0):g}"
    return {_STEP: "beyond a place", _WAVE: "periodic along the stroke"}.get(
        shape.get("form", 0.0), "near a place"
    )


TERM = Term(
    "position-dependent-friction",
    "N/m^{power}",
    "f times sign v times x, its square, or what is near a place",
    column,
    parameters=(
        Parameter("power", 0.0, 4.0, 1.0, "", fitted=False),
        Parameter("form", 0.0, 3.0, 0.0, "", fitted=False),
        Parameter("place", -1.0, 1.0, 0.0, "m", "displacement"),
        Parameter("width", 0.05, 1.0, 0.0, "m", "displacement", "log"),
        Parameter("transition_speed", 0.001, 0.3, 0.0, "m/s", "speed", "log"),
    ),
    mistaken_for=("hysteresis", "coulomb-friction"),
    needs=("coulomb-friction",),
    starts=starts,
    described=described,
)
