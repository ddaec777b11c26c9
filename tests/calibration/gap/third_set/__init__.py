"""A third set of effects, devices, seals, plans and noise: written last, looked at only in total.

Nothing that names effects may be written or changed with sight of this package, nor of single
answers on it.
"""

from models.rig.effects import CATALOGUE
from models.rig.effects.effect import Effect
from tests.calibration.gap.third_set import behind, damping, dry, elastic, outside, sensors
from tests.calibration.gap.third_set.bench import third_device, third_noise, third_plan
from tests.calibration.gap.third_set.reversal import THIRD_LAWS, third_seal

THIRD: dict[str, tuple[Effect, ...]] = {}
"""Forms by id of the catalogue; "outside" for what it has no name for."""

for _module in (elastic, damping, dry, behind, sensors, outside):
    for _effect in _module.EFFECTS:
        _key = _effect.id.partition(":")[0]
        THIRD[_key] = (*THIRD.get(_key, ()), _effect)

if missing := set(CATALOGUE) - set(THIRD):
    raise RuntimeError(f"no form of {', '.join(sorted(missing))}")

__all__ = ["THIRD", "THIRD_LAWS", "third_device", "third_noise", "third_plan", "third_seal"]
