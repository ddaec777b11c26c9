"""Hysteresis: friction that yields elastically before it slips, and so remembers the path."""

import numpy as np

from models.checks import Array
from models.compiled import compiled
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

JENKINS, DAHL, IWAN = 0.0, 1.0, 2.0
_SLIDERS = 8
_LEAST_HELD = 1e-9


@compiled(cache=True)
def _stop(x: Array, limit: float, *, passes: int) -> Array:
    """Return an elastic slider's deflection over its limit, in [-1, 1]."""
    result = np.empty(x.size)
    state = 0.0
    last = x[0]
    for _ in range(passes):
        for i in range(x.size):
            state = min(max(state + (x[i] - last) / limit, -1.0), 1.0)
            last = x[i]
            result[i] = state
    return result


@compiled(cache=True)
def _dahl(x: Array, limit: float, holds: Array, *, passes: int) -> Array:
    """Return Dahl's state: dz = (1 - z sign dx / hold) dx / limit, exact for each step."""
    result = np.empty(x.size)
    state = 0.0
    last = x[0]
    for _ in range(passes):
        for i in range(x.size):
            step = x[i] - last
            goal = holds[i] if step > 0.0 else -holds[i]
            state = goal + (state - goal) * np.exp(-abs(step) / (limit * holds[i]))
            last = x[i]
            result[i] = state
    return result


def bristle_state(motion: Motion, length: float, holds: Array | None = None) -> Array:
    """Return Dahl's state, in [-1, 1]: the sign of v that follows over a presliding length, m.

    What the bristles hold may fall with speed to the shares `holds` (N,), above 0 (LuGre).
    """
    x = np.ascontiguousarray(motion.displacement)
    shares = np.ones_like(x) if holds is None else np.maximum(holds, _LEAST_HELD)
    return np.asarray(_dahl(x, length, shares, passes=2 if motion.periodic else 1))


def slider_state(motion: Motion, length: float) -> Array:
    """Return an elastic slider's deflection over its limit, in [-1, 1]; it slips after `length`."""
    x = np.ascontiguousarray(motion.displacement)
    return np.asarray(_stop(x, length, passes=2 if motion.periodic else 1))


def column(motion: Motion, shape: Shape) -> Array:
    """Return the friction force over its limit, in [-1, 1].

    `form` 0 is one elastic slider (Jenkins), 1 is Dahl's exponential, 2 is sliders whose limits
    are spread evenly up to twice the yield displacement (Iwan). A periodic motion is gone through
    twice, so that the memory is that of the steady state.
    """
    x, limit = np.ascontiguousarray(motion.displacement), shape["yield_displacement"]
    passes = 2 if motion.periodic else 1
    if shape["form"] == DAHL:
        return bristle_state(motion, limit)
    if shape["form"] == IWAN:
        limits = 2.0 * limit * (np.arange(_SLIDERS) + 0.5) / _SLIDERS
        parts = [_stop(x, each, passes=passes) * each for each in limits]
        return np.asarray(np.sum(parts, axis=0) / limits.sum())
    return np.asarray(_stop(x, limit, passes=passes))


def starts(scales: Scales) -> list[Start]:
    """Return yield displacements, in each form."""
    return [
        Start.one(yield_displacement=float(r), form=form)
        for r in np.geomspace(0.02, 1.5, 10) * scales.displacement
        for form in (JENKINS, DAHL, IWAN)
    ]


_FORMS = ("an elastic slider (Jenkins)", "an exponential approach (Dahl)", "many sliders (Iwan)")


def described(shape: Shape) -> str:
    """Return which kind of hysteresis it is."""
    return _FORMS[int(shape.get("form", JENKINS))]


TERM = Term(
    "hysteresis",
    "N",
    "f times an elastic slider's state, which yields over the yield displacement",
    column,
    parameters=(
        Parameter("yield_displacement", 0.003, 1.5, 0.1, "m", "displacement", "log"),
        Parameter("form", 0.0, 2.0, 0.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("coulomb-friction", "stiffness", "stribeck-friction"),
    follows="path",
    starts=starts,
    described=described,
)
