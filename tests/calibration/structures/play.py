"""A device behind a play with elastic contacts, run in time: inertia crosses the gap by itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from tests.calibration.structures.devices import Law, Redraw
from tests.calibration.structures.friction import Friction, Values, fall
from tests.calibration.structures.motion import Motion, at_times
from tests.calibration.structures.specimen import Specimen

Array = np.ndarray
STEP = 2.5e-4
"""s; a fortieth or less of the contact's period."""
SETTLE = 1.5
"""Periods run before the record, and at least half a second."""
_FASTEST = 2.0 * math.pi * 150.0  # rad/s, to which a fractional element is made of relaxations
_SLOWEST = 0.02  # rad/s, likewise


@dataclass(frozen=True)
class Contact:
    """The play's two stops."""

    gap: float
    """Whole play, m."""
    stiffness: float
    """N/m."""
    damping: float
    """N s/m, while they touch; they never pull."""

    def force(self, lead: Array, speed: Array) -> Array:
        """Return the force (R,) for the drive's lead on the device, m, and its rate, N."""
        if self.gap == 0.0:
            return self.stiffness * lead + self.damping * speed
        side = np.sign(lead)
        deep = np.maximum(np.abs(lead) - 0.5 * self.gap, 0.0)
        push = self.stiffness * deep + self.damping * speed * side * (deep > 0.0)
        return side * np.maximum(push, 0.0)


def through(specimen: Specimen, contact: Contact) -> list[Array]:
    """Return the forces (N,) of every record at its samples with the play in the load path, N."""
    motions = [run.motion for run in specimen.runs]
    settles = [max(SETTLE * m.period, 0.5) for m in motions]
    starts = np.array([m.time[0] - s for m, s in zip(motions, settles, strict=True)])
    spans = [m.time[-1] - t for m, t in zip(motions, starts, strict=True)]
    order = np.argsort(spans)[::-1]  # long ones first, so that finished ones drop off the end
    counts = np.array([math.ceil(spans[i] / STEP) + 2 for i in order])
    with np.errstate(all="ignore"):  # a step that blows up is found at the end
        forces = _run(specimen, contact, order, starts[order], counts)
    result: list[Array] = [np.empty(0)] * len(motions)
    for place, i in enumerate(order):
        own = starts[i] + STEP * np.arange(counts[place])
        result[i] = np.interp(motions[i].time, own, forces[place])
    return result


def _run(
    specimen: Specimen, contact: Contact, order: Array, starts: Array, counts: Array
) -> list[Array]:
    motions = [specimen.runs[i].motion for i in order]
    driven = _driven(motions, starts, counts)
    fluid = _Fluid.of(specimen, order, starts)
    seals = _Seals.of(specimen, order, motions)
    x, v = driven[0][:, 0].copy(), driven[1][:, 0].copy()
    result = [np.zeros(count) for count in counts]
    whole = np.zeros(driven[0].shape)
    live = len(counts)
    for n in range(int(counts[0])):
        while counts[live - 1] <= n:
            live -= 1
        if live < x.size:
            x, v = x[:live], v[:live]
            fluid.keep(live)
            seals.keep(live)
        lead = driven[0][:live, n] - x
        pull = contact.force(lead, driven[1][:live, n] - v)
        grip = contact.damping * (np.abs(lead) >= 0.5 * contact.gap)
        drag, slope = fluid.drag(v)
        rub, rub_slope = seals.force(x, v)
        change = STEP * (pull - drag - rub)
        change /= fluid.mass + STEP * (0.5 * slope + rub_slope + 0.5 * grip)
        fluid.relax(change)
        # Speeds lie between the steps: the force is that of their mean, at the step.
        whole[:live, n] = contact.force(lead, driven[1][:live, n] - v - 0.5 * change)
        v = v + change
        x = x + STEP * v
    if not np.all(np.isfinite(whole)):
        raise Redraw("the play's contacts can't be stepped")
    for k, count in enumerate(counts):
        result[k] = whole[k, :count]
    return result


def _driven(motions: Sequence[Motion], starts: Array, counts: Array) -> tuple[Array, Array]:
    """Return displacement and velocity (R, steps) of the drive."""
    found = np.zeros((2, len(motions), int(counts[0])))
    for k, (m, start, count) in enumerate(zip(motions, starts, counts, strict=True)):
        time = start + STEP * np.arange(count)
        found[0, k, :count] = at_times(m.lines, m.rates, time)
        found[1, k, :count] = at_times(m.operated(1.0), m.rates, time)
    return found[0], found[1]


class _Fluid:
    """The fluid's force step by step: mass, damping, relaxations of a fractional element."""

    def __init__(
        self, mass: Array, damping: Sequence[Array], exponent: Array, weights: Array, decay: Array
    ):
        self.mass, self.exponent, self.weights, self.decay = mass, exponent, weights, decay
        self.viscous, self.quadratic, self.power = damping
        self.state = np.zeros(weights.shape)

    @classmethod
    def of(cls, specimen: Specimen, order: Array, starts: Array) -> _Fluid:
        laws = [_law_of(specimen, int(i)) for i in order]
        nodes = np.geomspace(_SLOWEST, _FASTEST, 22)
        mass, viscous, weights = [], [], []
        for law in laws:
            own = np.zeros(nodes.size)
            m, c = law.inertance, law.viscous
            if law.core == "FOIM":
                m, c, own = relaxations(law, nodes)
            mass.append(m)
            viscous.append(c)
            weights.append(own)
        damping = [
            np.array(viscous), np.array([w.quadratic for w in laws]),
            np.array([w.power for w in laws]),
        ]
        exponent = np.array([w.exponent for w in laws])
        result = cls(np.array(mass), damping, exponent, np.array(weights), nodes * STEP)
        for k, (i, start) in enumerate(zip(order, starts, strict=True)):
            m = specimen.runs[i].motion
            begin = np.array([start])
            for j, p in enumerate(nodes):
                high = 1j * m.rates / (1j * m.rates + p)
                result.state[k, j] = at_times(m.operated(1.0) * high, m.rates, begin)[0]
        return result

    def keep(self, live: int) -> None:
        for name in ("mass", "viscous", "quadratic", "power", "exponent", "weights", "state"):
            setattr(self, name, getattr(self, name)[:live])

    def drag(self, v: Array) -> tuple[Array, Array]:
        speed = np.abs(v)
        power = self.power * (speed + 1e-9) ** (self.exponent - 1.0)
        per_speed = self.viscous + self.quadratic * speed + power
        slope = per_speed + self.quadratic * speed + (self.exponent - 1.0) * power
        force = per_speed * v + np.einsum("rs,rs->r", self.weights, self.state)
        return force, slope + self.weights.sum(axis=1)

    def relax(self, change: Array) -> None:
        passed = np.exp(-self.decay)
        fresh = (1.0 - passed) / self.decay
        self.state = self.state * passed + change[:, None] * fresh


def relaxations(law: Law, nodes: Array) -> tuple[float, float, Array]:
    """Return mass, damping and weights (S,) that make a fractional element of order 1 to 2.

    s^m = s (sin(pi n)/pi) int p^(n - 1) s/(s + p) dp with n = m - 1; below the nodes the
    integrand is damping, above them it is mass.
    """
    if not 1.0 < law.order < 2.0:
        raise Redraw("order outside 1 to 2 behind a play")
    n = law.order - 1.0
    whole = law.fractional * math.sin(math.pi * n) / math.pi
    width = math.log(nodes[1] / nodes[0])
    low, high = nodes[0] * math.exp(-0.5 * width), nodes[-1] * math.exp(0.5 * width)
    weights = whole * width * nodes**n
    return whole * high ** (n - 1.0) / (1.0 - n), whole * low**n / n, weights


def _law_of(specimen: Specimen, i: int) -> Law:
    weights = specimen.weights(i)
    if np.max(weights) < 1.0:
        raise Redraw("no play behind a gradual boundary")
    return specimen.bands.laws[int(np.argmax(weights))]


class _Seals:
    """The seals' friction step by step."""

    def __init__(self, size: Array, law: Callable[..., tuple[Array, Array, Array]], start: Array,
                 tops: Array):
        self.size, self.law, self.state, self.tops = size, law, start, tops
        self.before: Array | None = None

    @classmethod
    def of(cls, specimen: Specimen, order: Array, motions: Sequence[Motion]) -> _Seals:
        friction = specimen.friction
        size = friction.size * np.array([friction.factors[i] for i in order])
        tops = np.array([m.top_speed for m in motions])
        wide = int(friction.values.get("count", 1.0))
        return cls(size, _stepped(friction), np.zeros((len(order), wide)), tops)

    def keep(self, live: int) -> None:
        self.size, self.state, self.tops = self.size[:live], self.state[:live], self.tops[:live]
        if self.before is not None:
            self.before = self.before[:live]

    def force(self, x: Array, v: Array) -> tuple[Array, Array]:
        gone = np.zeros(x.size) if self.before is None else x - self.before
        self.before = x
        share, slope, self.state = self.law(self.state, gone, v, self.tops)
        return self.size * share, self.size * slope


def _stepped(friction: Friction) -> Callable[..., tuple[Array, Array, Array]]:
    """Return (state (R, S), step of displacement, velocity, top speeds) -> share, slope, state."""
    values: Values = friction.values
    shape = friction.shape

    def static(state: Array, gone: Array, v: Array, tops: Array) -> tuple[Array, Array, Array]:
        speed = values["share"] * tops if shape == "tanh-own" else values["speed"]
        if shape == "arctan":
            share = np.arctan(v / speed) * (2.0 / math.pi)
            return share, (2.0 / math.pi) / (speed * (1.0 + (v / speed) ** 2)), state
        share = np.tanh(v / speed)
        return share, (1.0 - share**2) / speed, state

    def sliding(state: Array, gone: Array, v: Array, tops: Array) -> tuple[Array, Array, Array]:
        none = np.zeros(v.size)
        if shape in ("slip", "sliders"):
            count = int(values.get("count", 1.0))
            lengths = np.array([values.get(f"length{i}", values.get("length")) for i in
                                range(count)], dtype=float)
            weights = np.array([values.get(f"weight{i}", 1.0) for i in range(count)])
            state = np.clip(state + gone[:, None] / lengths, -1.0, 1.0)
            return state @ weights, none, state
        limit = fall(v, values) if shape == "lugre" else np.ones(v.size)
        bound = np.sign(gone) * limit
        kept = np.exp(-np.abs(gone) / (values["length"] * limit))
        fresh = np.where(gone == 0.0, state[:, 0], bound + (state[:, 0] - bound) * kept)
        share = fresh
        if shape == "lugre":
            share = fresh + values["lag"] * (fresh - state[:, 0]) / STEP
        if shape == "stribeck-presliding":
            share = fresh * fall(v, values)
        return share, none, fresh[:, None]

    return static if shape in ("tanh", "tanh-own", "arctan", "jump") else sliding
