"""What is tried for each effect: a few shapes of each, scaled by what the campaign covers."""

from __future__ import annotations

import numpy as np

from discover.naming.candidates import forces, friction, joints, sensors
from discover.naming.candidates.variant import Part, Variant
from discover.naming.scales import Scales
from models.motion import sine_motion
from models.terms import TERMS
from models.terms.trials import chosen_parameters, trial_shapes, trial_size

__all__ = ["Part", "Variant", "variants"]

_MAKERS = {
    "asymmetric-damping": forces.asymmetric,
    "power-law-damping": forces.power_law,
    "coulomb-friction": friction.coulomb,
    "fractional-derivative": forces.fractional,
    "stribeck-friction": friction.stribeck,
    "time-delay": sensors.delay,
    "series-compliance": joints.compliance,
    "end-stop": forces.end_stop,
    "backlash": joints.backlash,
    "cavitation": joints.cavitation,
    "hysteresis": forces.hysteresis,
    "position-dependent-friction": friction.along_the_stroke,
    "thermal-drift": forces.thermal,
    "sensor-drift": sensors.drift,
    "sensor-gain": sensors.gain,
    "sensor-clipping": sensors.clipping,
    "cubic-stiffness": forces.cubic,
}


def variants(effect: str, scales: Scales) -> list[Variant]:
    """Return the shapes that are tried for an effect.

    Raises
    ------
    KeyError
        For an effect that is not in the catalogue.
    """
    maker = _MAKERS.get(effect)
    return _spread(effect, scales) if maker is None else maker(scales)


def _spread(effect: str, scales: Scales) -> list[Variant]:
    """Return the shapes that a term's own parameters give."""
    term = TERMS[effect]
    sizes = {"displacement": scales.displacement, "speed": scales.speed, "force": scales.force}
    number, shapes = chosen_parameters(term), trial_shapes(term, sizes)
    if term.transform is None:
        return [Variant(effect, (Part(effect, s),), number) for s in shapes]
    frequency = scales.speed / scales.displacement / (2.0 * np.pi)
    motion = sine_motion(scales.displacement, frequency)
    carried = motion.acceleration * (2.0 * np.pi * frequency) ** -1 + motion.velocity
    force = carried * scales.force / float(np.abs(carried).max())
    return [
        Variant(effect, (Part(effect, s, trial_size(term, s, motion, force)),), number)
        for s in shapes
    ]
