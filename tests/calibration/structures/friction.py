"""Dry friction of a device: ten laws, each with its own way to reverse."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.calibration.structures.memory import dahl, lugre, stops
from tests.calibration.structures.motion import Motion

Array = np.ndarray
Values = Mapping[str, float]
Generator = np.random.Generator
PASSES = 3


@dataclass(frozen=True)
class Friction:
    """Friction of one device."""

    law: str
    """One of `LAWS`."""
    shape: str
    """How it reverses: one of `SHAPES`; the law itself but where only the size differs."""
    size: float
    """At sliding, N."""
    values: Values
    """Parameters of the shape."""
    factors: tuple[float, ...]
    """Of each record's size."""

    def force(self, motion: Motion, index: int) -> Array:
        """Return the friction at a record's samples (N,), N."""
        return self.size * self.factors[index] * SHAPES[self.shape](motion, self.values)

    def grid_force(self, motion: Motion, index: int) -> Array:
        """Return the friction on a motion's grid (G,), N."""
        return self.force(whole(motion), index)

    def direction(self, motion: Motion) -> Array:
        """Return the friction over its size at the samples (N,)."""
        return SHAPES[self.shape](motion, self.values)


def whole(motion: Motion) -> Motion:
    """Return a motion whose samples are its grid."""
    places = np.arange(motion.size)
    return Motion(
        motion.period, motion.lines, motion.size, places * (motion.period / motion.size),
        places, motion.repeats,
    )


def along(motion: Motion, run: Callable[[Array], Array]) -> Array:
    """Return a state with memory (..., N) at the samples: run along the path, the last period."""
    if not motion.repeats:
        last = int(np.max(motion.places)) + 1 if motion.places is not None else motion.size
        return run(motion.grid_x[:last])[..., motion.places]
    found = run(np.tile(motion.grid_x, PASSES))[..., -motion.size :]
    if found.ndim == 1:
        return motion.sampled(found)
    return np.stack([motion.sampled(row) for row in found])


def _jump(motion: Motion, values: Values) -> Array:
    return np.sign(motion.v)


def _tanh(motion: Motion, values: Values) -> Array:
    return np.tanh(motion.v / values["speed"])


def _tanh_own(motion: Motion, values: Values) -> Array:
    return np.tanh(motion.v / (values["share"] * motion.top_speed))


def _arctan(motion: Motion, values: Values) -> Array:
    return np.arctan(motion.v / values["speed"]) * (2.0 / math.pi)


def _dahl(motion: Motion, values: Values) -> Array:
    return along(motion, lambda x: dahl(x, values["length"]))


def _slip(motion: Motion, values: Values) -> Array:
    return along(motion, lambda x: stops(x, np.array([values["length"]]))[0])


def _sliders(motion: Motion, values: Values) -> Array:
    count = int(values["count"])
    lengths = np.array([values[f"length{i}"] for i in range(count)])
    weights = np.array([values[f"weight{i}"] for i in range(count)])
    return along(motion, lambda x: weights @ stops(x, lengths))


def _lugre(motion: Motion, values: Values) -> Array:
    step = motion.period / motion.size

    def run(x: Array) -> Array:
        v = np.resize(motion.grid_v, x.size)
        return lugre(x, fall(v, values), values["length"], values["lag"], step)

    return along(motion, run)


def _stribeck(motion: Motion, values: Values) -> Array:
    return fall(motion.v, values) * _dahl(motion, values)


def fall(v: Array, values: Values) -> Array:
    """Return friction at steady sliding over that at high speed (N,), by Stribeck."""
    slow = np.exp(-(np.abs(v / values["stribeck_speed"]) ** values["bend"]))
    return 1.0 + values["excess"] * slow


SHAPES: dict[str, Callable[[Motion, Values], Array]] = {
    "jump": _jump,
    "tanh": _tanh,
    "tanh-own": _tanh_own,
    "arctan": _arctan,
    "dahl": _dahl,
    "slip": _slip,
    "lugre": _lugre,
    "sliders": _sliders,
    "stribeck-presliding": _stribeck,
}
"""Friction over its size, by name of its shape."""

LAWS: tuple[str, ...] = (*SHAPES, "differs")
"""The ten laws; "differs" takes one of the others with another size in every record."""

SMOOTH: tuple[str, ...] = (
    "tanh", "tanh-own", "arctan", "dahl", "lugre", "sliders", "stribeck-presliding", "differs",
)
"""Laws that reverse gently enough to be solved behind a spring."""


def draw_friction(
    law: str, size: float, motions: Sequence[Motion], rng: Generator
) -> Friction:
    """Draw the parameters of a law, sane for a campaign's motions."""
    slowest = min(m.top_speed for m in motions)
    fastest = max(m.top_speed for m in motions)
    least = min(m.stroke for m in motions)
    shape = str(rng.choice(["tanh", "dahl", "slip"])) if law == "differs" else law
    values = {
        "speed": slowest * log_uniform(rng, 0.03, 0.8),
        "share": log_uniform(rng, 0.003, 0.1),
        "length": min(log_uniform(rng, 1e-5, 5e-4), 0.3 * least),
        "stribeck_speed": fastest * log_uniform(rng, 0.01, 0.06),
        "bend": rng.uniform(0.8, 2.0),
        "excess": rng.uniform(0.1, 0.5),
    }
    if shape == "slip":
        values["length"] = min(log_uniform(rng, 1e-5, 2.5e-4), 0.2 * least)
    if shape == "lugre":
        values["length"] = log_uniform(rng, 5e-6, 1e-4)
        values["excess"] = rng.uniform(0.0, 0.4)
        values["lag"] = rng.uniform(0.5e-4, 3e-4)
    if shape == "sliders":
        count = int(rng.integers(8, 25))
        weights = rng.dirichlet(np.full(count, rng.uniform(0.5, 4.0)))
        lengths = [log_uniform(rng, 4e-6, min(4e-4, 0.3 * least)) for _ in range(count)]
        values = {"count": float(count)}
        values |= {f"length{i}": lengths[i] for i in range(count)}
        values |= {f"weight{i}": float(weights[i]) for i in range(count)}
    spread = rng.uniform(0.08, 0.25) if law == "differs" else 0.0
    factors = np.exp(spread * rng.standard_normal(len(motions)))
    return Friction(law, shape, size, values, tuple(float(f) for f in factors))


def log_uniform(rng: Generator, low: float, high: float) -> float:
    """Draw a number whose logarithm is uniform."""
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))
