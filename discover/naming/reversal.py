"""How friction reverses: what its curve may differ by, and widths that a wrong model hid.

Where something like a resistance is missing, friction that reverses over a wider range of speed
makes up for it. A straight line from there does not lead back, so each candidate is also weighed
beside friction that reverses over other ranges.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.naming.fit import ModelFit, Parameter, fit_model, with_values
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import ForceModel
from models.terms.coulomb_friction import column

_CURVES = (0.4, 2.5)
_OTHER_WIDTHS = (0.03, 0.1, 0.3)


def reversing_friction(model: ForceModel) -> int | None:
    """Return the place of friction that reverses over a range of speed; None without one."""
    for place, t in enumerate(model.terms):
        if t.id == "coulomb-friction" and t.shape["transition_speed"] > 0.0:
            return place
    return None


def reversal_doubt(rows: Sequence[RecordRows], model: ForceModel) -> Array:
    """Return rows by which the curve along which friction reverses may differ from its own."""
    place = reversing_friction(model)
    if place is None:
        return np.zeros((0, sum(r.target.size for r in rows)))
    friction = model.terms[place]
    speed = friction.shape["transition_speed"]
    blocks = []
    for r in rows:
        v = r.observation.motion.velocity
        other = np.tanh(v / speed) if friction.shape["form"] else v / np.hypot(v, speed)
        own = column(r.observation.motion, friction.shape)
        curves = [*(np.tanh(v / (s * speed)) - own for s in _CURVES), other - own]
        blocks.append(r.project(friction.coefficient * np.stack(curves)))
    return np.concatenate(blocks, axis=1)


def with_reversal(model: ForceModel, speed: float) -> ForceModel:
    """Return the model with friction that reverses over another range of speed, m/s."""
    place = reversing_friction(model)
    if place is None:
        return model
    return with_values(model, [Parameter(place, "transition_speed")], np.array([speed]))


def other_reversals(rows: Sequence[RecordRows], fit: ModelFit) -> list[tuple[float, ModelFit]]:
    """Return speeds over which friction may reverse instead, m/s, and the model fitted so.

    None where friction is not fitted, or where the model is not a sum of forces.
    """
    place = reversing_friction(fit.model)
    if place is None or Parameter(place, "transition_speed") not in fit.parameters:
        return []
    if any(t.term.acts != "force" for r in rows for t in (*r.held, *fit.model.terms)):
        return []
    speed = fit.model.terms[place].shape["transition_speed"]
    return [
        (s * speed, fit_model(rows, with_reversal(fit.model, s * speed), fit.parameters,
                              iterations=0))
        for s in _OTHER_WIDTHS
    ]
