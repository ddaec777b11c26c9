"""Saturating damping: a loss that goes to a level within the tests' speeds, or falls beyond one."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return v / (1 + |v/v_k|^n)^(m/n), m/s: the Carreau-Yasuda law of a shear-thinning oil.

    With a `fall` m of 1 the force goes to a level beyond the knee v_k, as behind a valve that
    opens, the more suddenly the greater the `sharpness` n. With 2 it falls again, as an
    eddy-current brake's. Oil that thins by less follows a power of speed.
    """
    v, n = motion.velocity, shape["sharpness"]
    return np.asarray(v * (1.0 + np.abs(v / shape["knee_speed"]) ** n) ** (-shape["fall"] / n))


def starts(scales: Scales) -> list[Start]:
    """Return knees from a tenth of the greatest speed on: the force level or falling there."""
    knees = np.geomspace(0.1, 1.0, 4) * scales.speed
    return [
        Start.one(knee_speed=float(k), fall=m, sharpness=n)
        for n in (2.0, 1.0, 8.0) for k in knees for m in (1.0, 2.0)
    ]


def described(shape: Shape) -> str:
    """Return how the knee is, where it is not the plain one."""
    return {1.0: "with a wide knee", 8.0: "with a sharp knee"}.get(shape.get("sharpness", 2.0), "")


TERM = Term(
    "saturating-damping",
    "N s/m",
    "c v / (1 + |v/v_k|^n)^(m/n): goes to a level beyond a speed v_k, or falls",
    column,
    parameters=(
        Parameter("knee_speed", 0.03, 1.0, 0.3, "m/s", "speed", "log"),
        Parameter("fall", 1.0, 2.0, 1.0, ""),
        Parameter("sharpness", 1.0, 8.0, 2.0, "", fitted=False),
    ),
    nonnegative=True,
    mistaken_for=("viscous-damping", "power-law-damping", "coulomb-friction"),
    starts=starts,
    described=described,
)
