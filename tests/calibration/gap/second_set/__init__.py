"""A second set of effects, devices, seals, plans and noise: run only at the end, never tuned on.

Nothing that names effects may be written or changed with sight of this package. An effect whose
physics leaves no choice of form keeps the rig's own.
"""

from models.rig.effects import CATALOGUE, FORMS
from models.rig.effects.effect import Effect
from tests.calibration.gap.second_set import behind, damping, dry, elastic, outside, sensors
from tests.calibration.gap.second_set.bench import second_device, second_noise, second_plan
from tests.calibration.gap.second_set.reversal import SECOND_LAWS, second_seal

SECOND: dict[str, tuple[Effect, ...]] = {}
"""Forms by id of the catalogue; "outside" for what it has no name for."""

for _module in (elastic, damping, dry, behind, sensors, outside):
    for _effect in _module.EFFECTS:
        _key = _effect.id.partition(":")[0]
        SECOND[_key] = (*SECOND.get(_key, ()), _effect)

ONLY_FORM: tuple[str, ...] = tuple(key for key in CATALOGUE if key not in SECOND)
"""Ids that have one form."""

for _key in ONLY_FORM:
    SECOND[_key] = tuple(FORMS[_key].values())

__all__ = [
    "ONLY_FORM",
    "SECOND",
    "SECOND_LAWS",
    "second_device",
    "second_noise",
    "second_plan",
    "second_seal",
]
