"""One effect of the catalogue in every device, at a known size."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tests.calibration.structures.devices import Redraw, inertance_of
from tests.calibration.structures.friction import log_uniform
from tests.calibration.structures.motion import Motion
from tests.calibration.structures.play import Contact, through
from tests.calibration.structures.series import Link, behind
from tests.calibration.structures.specimen import Specimen, share

Array = np.ndarray
Generator = np.random.Generator
Change = Callable[[Specimen, float], list[Array]]

EXTRAS = (
    "series-compliance", "stiffness", "backlash", "force-offset", "time-delay",
    "asymmetric-damping", "position-dependent-friction",
)
"""Ids as the project's documents name them."""
OWN = {
    "series-compliance": ("rate-of-rate",),
    "stiffness": ("stiffness", "cubic"),
    "backlash": (),
    "force-offset": ("offset",),
    "time-delay": ("rate",),
    "asymmetric-damping": ("asymmetric", "asymmetric-quadratic"),
    "position-dependent-friction": ("place", "place-linear", "place-even"),
}
"""The study's own columns that stand for an effect."""
SIZE_TOLERANCE = 0.03
"""Of a size that is searched."""
_RINGS = 50.0  # Hz, where the first guess of a compliance rings
_FAR = 30.0  # times the first guess, from which something else makes the size
_BY_CONTACT = 0.2
"""Of a play's size: what its contacts alone change, about."""


@dataclass(frozen=True, eq=False)
class Hidden:
    """What was hidden."""

    id: str
    """Of `EXTRAS`."""
    amount: float
    """In the effect's own unit."""
    size: float
    """rms over records of each record's share of force."""
    changes: list[Array]
    """(N,) of each record's force, N."""


def hide(identifier: str, size: float, specimen: Specimen, rng: Generator) -> Hidden:
    """Return an effect of a size: rms over records of its share of each record's force.

    Raises
    ------
    Redraw
        Where no amount gives the size.
    """
    plain = [specimen.force(i) for i in range(len(specimen.runs))]
    change, guess, linear = _drawn(identifier, size, specimen, plain, rng)
    if linear:
        unit = change(specimen, 1.0)
        amount = size / share(unit, plain)
        return Hidden(identifier, amount, size, [amount * c for c in unit])
    return _searched(identifier, size, specimen, plain, change, guess)


def _searched(
    identifier: str, size: float, specimen: Specimen, plain: Sequence[Array], change: Change,
    guess: float,
) -> Hidden:
    slope, amount = 1.0, guess
    before: tuple[float, float] | None = None
    for _ in range(9):
        found = change(specimen, amount)
        reached = share(found, plain)
        if abs(reached / size - 1.0) < SIZE_TOLERANCE:
            return Hidden(identifier, amount, reached, found)
        if before is not None and abs(math.log(amount / before[0])) > 1e-6:
            slope = math.log(reached / before[1]) / math.log(amount / before[0])
            slope = min(max(slope, 0.3), 1.5)
        before = (amount, reached)
        amount *= min(max((size / reached) ** (1.0 / slope), 0.1), 10.0)
        if not 1.0 / _FAR < amount / guess < _FAR:
            break
    raise Redraw(f"no amount of {identifier} gives {size}")


def _drawn(
    identifier: str, size: float, specimen: Specimen, plain: Sequence[Array], rng: Generator
) -> tuple[Change, float, bool]:
    """Return how an effect changes the forces for an amount, a first amount, and if it's linear."""
    if identifier == "series-compliance":
        stiffness = _stiffness(specimen, plain, _RINGS)
        lag = 2.0 * rng.uniform(0.03, 0.1) / (2.0 * math.pi * _RINGS)
        return lambda s, give: _compliance(s, Link(give, lag)), 1.0 / stiffness, False
    if identifier == "backlash":
        return *_backlash(size, specimen, plain, rng), False
    if identifier == "time-delay":
        side = float(rng.choice([-1.0, 1.0]))
        return lambda s, amount: _delayed(s, side * amount), 1e-3, False
    return _added(identifier, specimen, plain, rng), 1.0, True


def _added(
    identifier: str, specimen: Specimen, plain: Sequence[Array], rng: Generator
) -> Change:
    motions = [r.motion for r in specimen.runs]
    side = float(rng.choice([-1.0, 1.0]))
    if identifier == "stiffness":
        return lambda s, k: [k * m.x for m in motions]
    if identifier == "force-offset":
        own = float(rng.choice([0.0, 0.0, 0.4]))
        levels = side * (1.0 + own * rng.standard_normal(len(motions)))
        return lambda s, c: [
            np.full(m.v.size, c * level) for m, level in zip(motions, levels, strict=True)
        ]
    if identifier == "asymmetric-damping":
        curved = bool(rng.integers(2))
        return lambda s, c: [
            c * side * (m.v**2 if curved else np.abs(m.v)) for m in motions
        ]
    stroke = max(m.stroke for m in motions)
    form, centre = int(rng.integers(3)), rng.uniform(-0.5, 0.5)

    def rub(s: Specimen, amount: float) -> list[Array]:
        found = []
        for i, m in enumerate(motions):
            place = m.x / stroke
            bore = (place**2, 0.5 * np.tanh(2.0 * (place - centre)),
                    np.exp(-(((place - centre) / 0.4) ** 2)))[form]
            found.append(amount * s.friction.factors[i] * bore * s.friction.direction(m))
        return found

    return rub


def _delayed(specimen: Specimen, delay: float) -> list[Array]:
    found = []
    for i, run in enumerate(specimen.runs):
        m = run.motion
        if m.places is not None:
            raise Redraw("delays are of sine tests")
        late = Motion(m.period, m.lines, m.size, m.time - delay)
        found.append(specimen.force(i, late) - specimen.force(i))
    return found


def _compliance(specimen: Specimen, link: Link) -> list[Array]:
    return [
        behind(specimen, i, link) - specimen.force(i) for i in range(len(specimen.runs))
    ]


def _backlash(
    size: float, specimen: Specimen, plain: Sequence[Array], rng: Generator
) -> tuple[Change, float]:
    """Return a play whose contacts alone would change the force by a fifth of the size."""
    springs = [
        float(np.std(f) / np.std(r.motion.x)) for f, r in zip(plain, specimen.runs, strict=True)
    ]
    stiffness = float(np.sqrt(np.mean(np.square(springs)))) / (_BY_CONTACT * size)
    mass = inertance_of(specimen.device)
    damping = 2.0 * rng.uniform(0.1, 0.3) * math.sqrt(stiffness * mass)

    def change(s: Specimen, gap: float) -> list[Array]:
        forces = through(s, Contact(gap, stiffness, damping))
        return [f - p for f, p in zip(forces, plain, strict=True)]

    return change, 2e-4 * size


def _stiffness(specimen: Specimen, plain: Sequence[Array], frequency: float) -> float:
    """Return the spring (N/m) on which the device's apparent mass rings at a frequency (Hz)."""
    masses = [
        float(np.std(f) / np.std(r.motion.a)) for f, r in zip(plain, specimen.runs, strict=True)
    ]
    return float(np.quantile(masses, 0.2)) * (2.0 * math.pi * frequency) ** 2


def draw_size(rng: Generator) -> float:
    """Draw a size from 3 to 10 %."""
    return log_uniform(rng, 0.03, 0.1)
