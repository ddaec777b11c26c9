"""Effects that no usual catalogue of such devices has, at a known size."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tests.calibration.structures.devices import Redraw
from tests.calibration.structures.friction import log_uniform, whole
from tests.calibration.structures.memory import turns
from tests.calibration.structures.motion import Motion, lines_of, on_grid
from tests.calibration.structures.specimen import Specimen
from tests.calibration.structures.told import EXTRAS, FRICTION, LIBRARY, ORDERS, columns

Array = np.ndarray
Generator = np.random.Generator
Shape = Callable[[Specimen, int], Array]

EVEN = 1.3
"""Most by which the remainder's two sizes, pooled and by record, may differ."""
ABSORBED = 2.5
"""Most that an effect may be above what no term takes of it."""


@dataclass(frozen=True, eq=False)
class Unnamed:
    """What was hidden."""

    id: str
    """Of `OUTSIDE`."""
    size: float
    """Remainder's size: rms over records of its share of each record's force."""
    pooled: float
    """The same pooled over all samples."""
    raw: float
    """Of the whole effect: rms over records of its share."""
    changes: list[Array]
    """(N,) of each record's force, N."""


def hide_unnamed(
    identifier: str, size: float, specimen: Specimen, rng: Generator
) -> Unnamed:
    """Return an effect of which as much remains as asked for, once terms have taken their part.

    The device's own core, each band for itself, friction and simple extras are refitted.

    Raises
    ------
    Redraw
        Where the terms take most of it, or a few records hold it all.
    """
    shape = OUTSIDE[identifier](specimen, rng)
    changes = [shape(specimen, i) for i in range(len(specimen.runs))]
    forces = [specimen.force(i) for i in range(len(specimen.runs))]
    remains, force = _remains(specimen, changes, forces)
    raw = np.array([c @ c for c in changes])
    by_record = math.sqrt(float(np.mean(remains / force)))
    pooled = math.sqrt(float(np.sum(remains) / np.sum(force)))
    whole_share = math.sqrt(float(np.mean(raw / force)))
    if by_record <= 0.0 or whole_share > ABSORBED * by_record:
        raise Redraw("terms take most of the effect")
    if not 1.0 / EVEN < pooled / by_record < EVEN:
        raise Redraw("a few records hold the effect")
    amount = size / by_record
    return Unnamed(
        identifier, size, amount * pooled, amount * whole_share, [amount * c for c in changes]
    )


def _remains(
    specimen: Specimen, changes: Sequence[Array], forces: Sequence[Array]
) -> tuple[Array, Array]:
    """Return the squares of what terms leave of an effect and of the force, by record (R,)."""
    runs = specimen.runs
    scales = (max(r.motion.top_speed for r in runs), max(r.motion.stroke for r in runs))
    products = []
    for i, run in enumerate(runs):
        direction = specimen.friction.direction(run.motion)
        rows = columns(run.motion, specimen.fluid(i), direction, scales)
        rows = np.vstack([rows, direction, changes[i]])
        products.append(rows @ rows.T)
    every = np.stack(products)
    force = np.array([f @ f for f in forces])
    remains = np.zeros(len(runs))
    bands = np.array([int(np.argmax(specimen.weights(i))) for i in range(len(runs))])
    for k, law in enumerate(specimen.bands.laws):
        own = np.flatnonzero(bands == k)
        names = [*_columns_of(law.core, law.order), *FRICTION, *EXTRAS]
        places = [*LIBRARY.places(names), every.shape[1] - 2]
        total = np.einsum("r,rij->ij", 1.0 / force[own], every[own])
        square = total[np.ix_(places, places)]
        scale = np.sqrt(np.maximum(np.diag(square), 1e-300))
        scaled = square / np.outer(scale, scale) + 1e-9 * np.eye(len(places))
        weights = np.linalg.solve(scaled, total[places, -1] / scale) / scale
        for r in own:
            part = every[r][np.ix_(places, places)]
            remains[r] = every[r][-1, -1] - 2.0 * weights @ every[r][places, -1]
            remains[r] += weights @ part @ weights
    return np.maximum(remains, 0.0), force


def _columns_of(core: str, order: float) -> tuple[str, ...]:
    """Return the columns of a core; a fractional order lies between two of them."""
    if core == "FOIM":
        near = sorted(sorted(ORDERS, key=lambda o: abs(o - order))[:2])
        return tuple(f"D^{o}" for o in near)
    return {
        "IOIM-linear": ("a", "v"),
        "IOIM-laminar": ("a", "v", "v|v|"),
        "IOIM-turbulent": ("a", "v", "v|v|", "|v|^1.7", "|v|^1.8"),
    }[core]


def _ripple(specimen: Specimen, rng: Generator) -> Shape:
    length = max(r.motion.stroke for r in specimen.runs) * log_uniform(rng, 0.2, 0.6)
    phase = rng.uniform(0.0, 2.0 * math.pi)
    return lambda s, i: s.fluid(i) * np.cos(
        2.0 * math.pi * s.runs[i].motion.x / length + phase
    )


def _wake(specimen: Specimen, rng: Generator) -> Shape:
    length = log_uniform(rng, 0.004, 0.015)
    start = rng.uniform(0.0, 2.0 * math.pi)

    def shape(s: Specimen, i: int) -> Array:
        motion = s.runs[i].motion
        phase = 2.0 * math.pi * since_turn(motion) / length + start
        speed = np.abs(motion.v) / motion.top_speed
        return float(np.std(s.force(i))) * speed**2 * np.sin(phase)

    return shape


def _meshing(specimen: Specimen, rng: Generator) -> Shape:
    wave = 2.0 * math.pi / (max(r.motion.stroke for r in specimen.runs) * rng.uniform(0.4, 1.0))
    phase = rng.uniform(0.0, 2.0 * math.pi)

    def shape(s: Specimen, i: int) -> Array:
        m = s.runs[i].motion
        angle = wave * m.x + phase
        return np.cos(angle) * m.a - wave * np.sin(angle) * m.v**2

    return shape


def _varying_mass(specimen: Specimen, rng: Generator) -> Shape:
    stroke = max(r.motion.stroke for r in specimen.runs)
    lean = rng.uniform(-0.5, 0.5)

    def shape(s: Specimen, i: int) -> Array:
        m = s.runs[i].motion
        place = m.x / stroke
        share, slope = place + lean * place**2, (1.0 + 2.0 * lean * place) / stroke
        return share * m.a + 0.5 * slope * m.v**2

    return shape


def _place_damping(specimen: Specimen, rng: Generator) -> Shape:
    stroke = max(r.motion.stroke for r in specimen.runs)
    centre, width = rng.uniform(-0.3, 0.3), rng.uniform(0.15, 0.35)

    def shape(s: Specimen, i: int) -> Array:
        place = s.runs[i].motion.x / stroke
        return s.damping(i) * np.exp(-(((place - centre) / width) ** 2))

    return shape


def _pressed_seal(specimen: Specimen, rng: Generator) -> Shape:
    return lambda s, i: np.abs(s.fluid(i)) * s.friction.direction(s.runs[i].motion)


def _ringing(specimen: Specimen, rng: Generator) -> Shape:
    rate = 2.0 * math.pi * log_uniform(rng, 12.0, 45.0)
    loss = rng.uniform(0.02, 0.08)

    def shape(s: Specimen, i: int) -> Array:
        motion = s.runs[i].motion
        count = min(4000, motion.size // 4) if motion.places is None else motion.size // 2
        drive = lines_of(np.tanh(motion.grid_v / (0.003 * motion.top_speed)), count)
        w = 2.0 * np.pi / motion.period * np.arange(count) / rate
        gain = 1.0 / (1.0 - w**2 + 2j * loss * w) - 1.0
        fade = np.exp(-0.5 * (w / 6.0) ** 2)
        ring = motion.sampled(on_grid(drive * gain * fade, motion.size))
        return float(np.std(s.force(i))) * ring

    return shape


def _slow_valve(specimen: Specimen, rng: Generator) -> Shape:
    length = log_uniform(rng, 0.001, 0.006)
    way = float(rng.choice([-1.0, 1.0]))

    def shape(s: Specimen, i: int) -> Array:
        motion = s.runs[i].motion
        open_ = np.exp(-since_turn(motion) / length) * (way * motion.v > 0.0)
        return s.damping(i) * open_

    return shape


def _developing(specimen: Specimen, rng: Generator) -> Shape:
    length = log_uniform(rng, 0.0008, 0.004)

    def shape(s: Specimen, i: int) -> Array:
        motion = s.runs[i].motion
        return s.damping(i) * np.exp(-since_turn(motion) / length)

    return shape


OUTSIDE: dict[str, Callable[[Specimen, Generator], Shape]] = {
    "ripple": _ripple,
    "wake": _wake,
    "meshing": _meshing,
    "varying-mass": _varying_mass,
    "place-damping": _place_damping,
    "pressed-seal": _pressed_seal,
    "ringing": _ringing,
    "slow-valve": _slow_valve,
    "developing": _developing,
}
"""How each effect is drawn: (specimen, generator) -> shape of record i, up to its amount."""


def since_turn(motion: Motion) -> Array:
    """Return the way since the motion last turned (N,), m."""
    path = np.tile(motion.grid_x, 2)
    corners = turns(path)
    found = np.zeros(path.size)
    for first, last in zip(corners[:-1], corners[1:], strict=True):
        found[first : last + 1] = np.abs(path[first : last + 1] - path[first])
    return whole(motion).sampled(found[motion.size :])[
        motion.places
    ] if motion.places is not None else motion.sampled(found[motion.size :])
