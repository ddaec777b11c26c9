"""One campaign of the blind study: what is hidden where, and the records."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.records import Campaign, Record
from models.device import Device
from models.rig import (
    CATALOGUE,
    FORMS,
    Chain,
    Effect,
    Limits,
    Plan,
    RigPhysics,
    RigRecord,
    find_effect,
    random_device,
    run,
    sine_plan,
)
from models.rig.seal import Seal, draw_seal
from tests.calibration.gap.second_set import (
    SECOND,
    second_device,
    second_noise,
    second_plan,
    second_seal,
)
from tests.calibration.gap.third_set import (
    THIRD,
    third_device,
    third_noise,
    third_plan,
    third_seal,
)

RECORDS = 12
SETS = ("first", "second", "third")
KEPT = SETS[:2]
"""Sets of the kept table; the third is run once, at the end."""
_FREQUENCIES = (0.3, 0.7, 1.5, 3.0, 6.0, 10.0)
_AMPLITUDES = (0.003, 0.008, 0.02)
_PAIR_SIZE = 0.1
_ANOTHER_DAY = 500_000
_STREAM = {"first": 7, "second": 23, "third": 37}
_OWN = {"second": SECOND, "third": THIRD}
NOISE = {"second": (29, second_noise), "third": (43, third_noise)}


@dataclass(frozen=True)
class Case:
    """What is hidden in one campaign."""

    kind: str
    """Set: "first", "second" or "third"."""
    hidden: tuple[str, ...]
    """Each as "id:form" of the first set or "id#place" of another; empty for nothing."""
    size: float
    """rms change of force over rms force, of each; 0 for nothing."""
    seed: int
    """Of the device, the plan, the motion and the noise."""

    @property
    def key(self) -> str:
        """What tells the case from others."""
        return f"{self.kind} {'+'.join(self.hidden)} {self.size:g} {self.seed}"

    @property
    def ids(self) -> tuple[str, ...]:
        """Of the catalogue; "outside" for what it has no name for."""
        names = tuple(
            find_effect(name).id if self.kind == "first" else name.partition("#")[0]
            for name in self.hidden
        )
        return tuple("outside" if name.startswith("outside") else name for name in names)

    def effects(self) -> dict[Effect, float]:
        """Return what the rig hides, with sizes."""
        result: dict[Effect, float] = {}
        for name in self.hidden:
            if self.kind == "first":
                result[find_effect(name)] = self.size
            else:
                identifier, _, place = name.partition("#")
                result[_OWN[self.kind][identifier][int(place)]] = self.size
        return result


def campaign(case: Case, *, clean: bool = False) -> Campaign:
    """Return the campaign of a case as the search gets it.

    Parameters
    ----------
    case : Case
        What is hidden.
    clean : bool
        The same device and plan with nothing hidden, run on another day: other phases and noise.
    """
    if clean:
        case = Case(case.kind, (), 0.0, case.seed)
    records = []
    for i, r in enumerate(measure(case, day=_ANOTHER_DAY if clean else 0)):
        force = r.force.copy()
        if case.kind in NOISE:
            stream, noise = NOISE[case.kind]
            own = np.random.default_rng([stream, case.seed + (_ANOTHER_DAY if clean else 0), i])
            sampling = round(1.0 / (r.time[1] - r.time[0]))
            force += noise(r.true_force, sampling, case.seed, own)
        records.append(
            Record(
                r.file, r.time, force, r.displacement.copy(),
                frequency=r.frequency, amplitude=r.amplitude,
            )
        )
    return Campaign(f"rig, {case.kind} set, seed {case.seed}", tuple(records))


def measure(case: Case, *, day: int = 0) -> tuple[RigRecord, ...]:
    """Return the rig's records of a case; beyond the first set, without their noise."""
    device, plan = _tested(case)
    chain = Chain() if case.kind == "first" else Chain(noise=0.0, hum=0.0)
    return run(
        device,
        plan,
        seed=case.seed + day,
        hidden=case.effects(),
        physics=replace(RigPhysics.simple(), seal_values=_seal(case, device)),
        chain=chain,
    )


def seal_of(case: Case) -> Seal:
    """Return how the seals of a case's device reverse: the same on every day."""
    return _seal(case, _tested(case)[0])


def _seal(case: Case, device: Device) -> Seal:
    """Return how the seals of a device reverse, by the laws of the case's set."""
    draw = {"first": draw_seal, "second": second_seal, "third": third_seal}
    return draw[case.kind](device)


def _tested(case: Case) -> tuple[Device, Plan]:
    """Return the device and the plan that a case's seed draws."""
    rng = np.random.default_rng([_STREAM[case.kind], case.seed])
    if case.kind == "second":
        device = second_device(rng)
        return device, second_plan(device, rng)
    if case.kind == "third":
        device = third_device(rng)
        return device, third_plan(device, rng)
    device = random_device(rng)
    points = list(
        sine_plan(device, frequencies=_FREQUENCIES, amplitudes=_AMPLITUDES, limits=Limits())
    )
    if len(points) > RECORDS:
        chosen = np.unique(np.linspace(0, len(points) - 1, RECORDS).astype(int))
        points = [points[i] for i in chosen]
    return device, Plan(tuple(points))


def single_cases(
    kind: str, seeds: Iterable[int], sizes: Sequence[float], effects: Sequence[str] | None = None
) -> list[Case]:
    """Return every effect, in a form that changes with the seed, at every size."""
    result = []
    for seed in seeds:
        if kind == "first":
            names = tuple(FORMS) if effects is None else tuple(effects)
            forms = [
                f"{name}:{list(FORMS[name])[seed % len(FORMS[name])]}" for name in names
            ]
        else:
            own = _OWN[kind]
            names = tuple(own) if effects is None else tuple(effects)
            forms = [
                f"{name}#{place}"
                for name in names
                for place in (
                    range(len(own[name])) if name == "outside" else [seed % len(own[name])]
                )
            ]
        result += [Case(kind, (form,), size, seed) for form in forms for size in sizes]
    return result


def clean_cases(kind: str, seeds: Iterable[int]) -> list[Case]:
    """Return campaigns with nothing hidden."""
    return [Case(kind, (), 0.0, seed) for seed in seeds]


def pair_cases(kind: str, seeds: Iterable[int]) -> list[Case]:
    """Return two different effects of the catalogue at 10 % each, drawn by the seed."""
    result = []
    for seed in seeds:
        rng = np.random.default_rng([41, _STREAM[kind], seed])
        names = []
        for name in rng.choice(list(CATALOGUE), size=2, replace=False):
            count = len(FORMS[name] if kind == "first" else _OWN[kind][name])
            place = int(rng.integers(count))
            first = f"{name}:{list(FORMS[name])[place]}" if kind == "first" else ""
            names.append(first or f"{name}#{place}")
        result.append(Case(kind, tuple(names), _PAIR_SIZE, seed))
    return result
