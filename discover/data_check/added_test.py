"""The one test more that would best tell apart what a plan leaves open.

Each admissible sine test is added to the plan in thought: the structures' nominal forces are held,
its noise is that of the plan's tests relative to the force, and the expected gaps are taken again.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.data_check.nominal import structures
from discover.data_check.plan import Plan
from discover.data_check.result import AddedTest, Pair
from discover.next_test import admissible_tests
from discover.records import RigLimits
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.motion import sine_motion

_GAIN = 1.1  # a test that adds less than a tenth to the gap is not worth running


def added_test(pairs: Sequence[Pair], plan: Plan, limits: RigLimits | None) -> AddedTest | None:
    """Return the test that raises the least gap among inseparable pairs most.

    Parameters
    ----------
    pairs : sequence of Pair
        From `expected_pairs`.
    plan : Plan
        The same.
    limits : RigLimits or None
        The rig's; what is not stated is what the tests so far have reached.

    Returns
    -------
    AddedTest or None
        None where nothing is inseparable, or no admissible test helps.
    """
    unsettled = [p for p in pairs if not p.separable]
    if not unsettled:
        return None
    known = {s.name: s for s in structures()}
    nominal = {name: s.coefficients(plan) for name, s in known.items()}
    most = limits.max_force if limits is not None else None
    best: AddedTest | None = None
    tests = admissible_tests(plan.frequency, plan.amplitude, limits)
    for frequency, amplitude in zip(*tests, strict=True):
        motion = sine_motion(float(amplitude), float(frequency), samples=128)
        forces = {n: ForceModel(tuple(t)).force(motion) for n, t in nominal.items()}
        sizes = {n: float(np.sqrt(np.mean(f**2))) for n, f in forces.items()}
        if most is not None and np.sqrt(2.0) * max(sizes.values()) > most:
            continue
        gaps: list[tuple[float, tuple[str, str]]] = []
        for pair in unsettled:
            for g in pair.gaps:
                if g.word == "nested":
                    continue
                level = max(plan.noise * sizes[g.truth], 1e-300)
                both = plan.with_test(float(frequency), float(amplitude), level)
                force = _whole(both, nominal[g.truth])
                gaps.append((known[g.model].gap_to(force, both), pair.structures))
        least, names = min(gaps)
        if best is None or least > best.nats:
            best = AddedTest(float(frequency), float(amplitude), names, least)
    now = min(p.nats for p in unsettled)
    return best if best is not None and best.nats > _GAIN * now else None


def _whole(plan: Plan, terms: Sequence[FittedTerm]) -> Array:
    values = np.array([t.coefficient for t in terms])
    return np.asarray(plan.columns([FittedTerm(t.id, 1.0, t.shape) for t in terms]) @ values)
