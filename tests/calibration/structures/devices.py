"""Devices at random: a geometry for the Dean number and the law of the fluid, band by band."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from models.device import Device, Fluid
from tests.calibration.structures.friction import log_uniform
from tests.calibration.structures.motion import Motion
from tests.calibration.structures.plans import Run

Array = np.ndarray
Generator = np.random.Generator

CORES = ("FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent")
KINDS = (*CORES, "SFOIM")
"""Kinds of device: SFOIM has a boundary between two FOIM."""


@dataclass(frozen=True)
class Law:
    """The fluid's force in one band; coefficients that its core lacks are zero."""

    core: str
    """One of `CORES`."""
    inertance: float = 0.0
    """kg."""
    viscous: float = 0.0
    """N s/m."""
    quadratic: float = 0.0
    """N s^2/m^2."""
    power: float = 0.0
    """N (s/m)^exponent."""
    exponent: float = 1.75
    """Of the power law."""
    fractional: float = 0.0
    """N s^order/m."""
    order: float = 1.5
    """Of the derivative."""

    def parts(self, motion: Motion) -> dict[str, Array]:
        """Return each term's force at the samples (N,), N."""
        if self.core == "FOIM":
            return {"fractional": self.fractional * motion.samples(self.order)}
        v = motion.v
        result = {"inertance": self.inertance * motion.a, "viscous": self.viscous * v}
        if self.quadratic:
            result["quadratic"] = self.quadratic * v * np.abs(v)
        if self.power:
            result["power"] = self.power * np.abs(v) ** self.exponent * np.sign(v)
        return result

    def scaled(self, factor: float) -> Law:
        """Return the law with every coefficient times a factor."""
        names = ("inertance", "viscous", "quadratic", "power", "fractional")
        return replace(self, **{name: factor * getattr(self, name) for name in names})

    def force(self, motion: Motion) -> Array:
        """Return the fluid's force at the samples (N,), N."""
        return np.sum(list(self.parts(motion).values()), axis=0)

    def damping(self, motion: Motion) -> Array:
        """Return what resists speed at the samples (N,), N."""
        if self.core == "FOIM":
            rate = 2.0 * math.pi * self._middle(motion)
            turn = math.sin(0.5 * math.pi * min(self.order, 2.0 - 1e-9))
            return self.fractional * abs(turn) * rate ** (self.order - 1.0) * motion.v
        return self.force(motion) - self.inertance * motion.a

    @staticmethod
    def _middle(motion: Motion) -> float:
        """Return the frequency that holds the motion's power, Hz."""
        weights = np.abs(motion.lines) ** 2
        return float(weights @ motion.rates / np.sum(weights)) / (2.0 * math.pi)


@dataclass(frozen=True)
class Bands:
    """The device's laws along a coordinate."""

    laws: tuple[Law, ...]
    """From the lowest band up."""
    coordinate: str
    """"dean" or "frequency"; "" with one band."""
    boundaries: tuple[float, ...]
    """In the coordinate's unit; one less than laws."""
    width: float = 0.0
    """Of a gradual boundary in the coordinate's logarithm; 0 where it is sharp."""

    def weights(self, coordinate: float) -> Array:
        """Return the share of each law (B,) in a record at a coordinate."""
        if not self.boundaries:
            return np.ones(1)
        place = math.log(coordinate)
        steps = [place - math.log(b) for b in self.boundaries]
        if self.width:
            passed = [1.0 / (1.0 + math.exp(-s / self.width)) for s in steps]
        else:
            passed = [float(s > 0.0) for s in steps]
        return -np.diff([1.0, *passed, 0.0])


def draw_geometry(rng: Generator) -> Device:
    """Draw a device that can be built, from small to large."""
    while True:
        rod, channel = rng.uniform(0.008, 0.018), rng.uniform(0.0035, 0.009)
        device = Device(
            rod_radius=rod,
            cylinder_radius=rod + rng.uniform(0.007, 0.018),
            channel_radius=channel,
            helix_radius=rng.uniform(0.05, 0.15),
            helix_pitch=2.0 * channel * rng.uniform(1.1, 3.5),
            turns=float(rng.integers(3, 16)),
            fluid=Fluid(rng.uniform(780.0, 1050.0), log_uniform(rng, 1.5e-3, 0.1)),
            transition_length=float(rng.choice([0.0, rng.uniform(0.02, 0.1)])),
            piston_clearance=rng.uniform(5e-5, 2.5e-4),
            name="drawn",
        )
        if 15.0 < inertance_of(device) < 900.0:
            return device


def inertance_of(device: Device) -> float:
    """Return the mass of the oil that the channel speeds up, seen at the rod, kg."""
    piston = math.pi * (device.cylinder_radius**2 - device.rod_radius**2)
    channel = math.pi * device.channel_radius**2
    around = 2.0 * math.pi * device.helix_radius
    length = device.turns * math.hypot(around, device.helix_pitch)
    length += 2.0 * device.transition_length
    return device.fluid.density * length * piston**2 / channel


def dean_number(device: Device, speed: float) -> float:
    """Return the Dean number at a speed of the rod, by the paper's Eq. 12 to 14."""
    piston = math.pi * (device.cylinder_radius**2 - device.rod_radius**2)
    channel = math.pi * device.channel_radius**2
    reynolds = 2.0 * device.fluid.density * (2.0 * device.channel_radius) * piston * speed
    reynolds /= device.fluid.viscosity * channel
    return reynolds * math.sqrt(2.0 * device.channel_radius / device.helix_radius)


def coordinates(device: Device, runs: Sequence[Run], coordinate: str) -> Array:
    """Return each record's place (R,) along a coordinate."""
    if coordinate == "dean":
        return np.array([dean_number(device, r.motion.top_speed) for r in runs])
    return np.array([r.frequency for r in runs])


def draw_law(core: str, inertance: float, runs: Sequence[Run], rng: Generator) -> Law:
    """Draw a law whose terms matter on a plan's records."""
    fastest = max(runs, key=lambda r: r.motion.top_speed).motion
    speed = fastest.top_speed
    thrust = inertance * float(np.max(np.abs(fastest.a)))
    if core == "FOIM":
        order = rng.uniform(1.2, 1.95)
        middle = 2.0 * math.pi * math.exp(float(np.mean([math.log(r.frequency) for r in runs])))
        return Law(core, fractional=inertance * middle ** (2.0 - order), order=order)
    if core == "IOIM-linear":
        rate = 2.0 * math.pi * log_uniform(rng, 0.3, 4.0)
        return Law(core, inertance, viscous=inertance * rate)
    viscous = inertance * 2.0 * math.pi * log_uniform(rng, 0.1, 1.5)
    if core == "IOIM-laminar":
        share = log_uniform(rng, 0.15, 1.5)
        return Law(core, inertance, viscous, quadratic=share * thrust / speed**2)
    exponent = rng.uniform(1.68, 1.82)
    pipe, ends = log_uniform(rng, 0.4, 2.5), log_uniform(rng, 0.08, 0.6)
    return Law(
        core, inertance, viscous, quadratic=ends * thrust / speed**2,
        power=pipe * thrust / speed**exponent, exponent=exponent,
    )


def draw_bands(
    kind: str, coordinate: str, device: Device, runs: Sequence[Run], rng: Generator,
    *, lowest: float = 0.4,
) -> Bands:
    """Draw the laws of a kind of device and, for SFOIM, its boundary between two records.

    `lowest` bounds the order below the boundary.
    """
    inertance = inertance_of(device) * rng.uniform(0.85, 1.15)
    if kind != "SFOIM":
        return Bands((draw_law(kind, inertance, runs, rng),), "", ())
    places = coordinates(device, runs, coordinate)
    boundaries = draw_boundaries(np.sort(places), 1, rng)
    upper = Law("FOIM", fractional=inertance * 12.0 ** 0.3, order=rng.uniform(1.45, 1.95))
    lower = Law("FOIM", fractional=inertance, order=rng.uniform(lowest, 1.35))
    laws = joined((lower, upper), places, boundaries, runs, rng)
    return Bands(laws, coordinate, boundaries)


MIXED = (
    ("FOIM", "FOIM", "FOIM"),
    ("FOIM", "FOIM", "FOIM"),
    ("FOIM", "IOIM-linear", "IOIM-turbulent"),
    ("FOIM", "IOIM-laminar", "FOIM"),
    ("IOIM-linear", "FOIM", "IOIM-turbulent"),
    ("IOIM-linear", "IOIM-laminar", "IOIM-turbulent"),
    ("FOIM", "IOIM-turbulent", "FOIM"),
)
"""Cores of devices with three bands."""


def draw_many(
    count: int, coordinate: str, device: Device, runs: Sequence[Run], rng: Generator,
    *, width: float = 0.0,
) -> Bands:
    """Draw two or three bands of mixed cores, each told from its neighbours by its parameters."""
    inertance = inertance_of(device) * rng.uniform(0.85, 1.15)
    places = coordinates(device, runs, coordinate)
    boundaries = draw_boundaries(np.sort(places), count - 1, rng)
    cores = MIXED[int(rng.integers(len(MIXED)))][:count]
    edges = np.searchsorted(boundaries, places)
    laws = [
        draw_law(core, inertance, [r for r, e in zip(runs, edges, strict=True) if e == k], rng)
        for k, core in enumerate(cores)
    ]
    orders = rng.permutation([rng.uniform(0.5, 1.1), rng.uniform(1.2, 1.5), rng.uniform(1.6, 1.95)])
    laws = [
        replace(law, order=float(order)) if law.core == "FOIM" else law
        for law, order in zip(laws, orders, strict=False)
    ]
    laws = joined(laws, places, boundaries, runs, rng)
    return Bands(laws, coordinate, boundaries, width)


def joined(
    laws: Sequence[Law], places: Array, boundaries: Sequence[float], runs: Sequence[Run],
    rng: Generator,
) -> tuple[Law, ...]:
    """Return laws scaled so that the force is about as great on both sides of each boundary."""
    result = [laws[-1]]
    for law, boundary in zip(laws[-2::-1], boundaries[::-1], strict=True):
        nearest = np.argsort(np.abs(np.log(places / boundary)))[:4]
        ratios = [
            float(np.std(result[0].force(runs[i].motion)) / np.std(law.force(runs[i].motion)))
            for i in nearest
        ]
        result.insert(0, law.scaled(float(np.mean(ratios)) * log_uniform(rng, 0.7, 1.45)))
    return tuple(result)


def draw_boundaries(places: Array, count: int, rng: Generator) -> tuple[float, ...]:
    """Draw boundaries midway between neighbours of the sorted coordinates (R,).

    Each band keeps at least five records and a fifth of them; the two records beside a boundary
    are well apart.
    """
    least = max(5, places.size // (2 * count + 3))
    gaps = np.diff(np.log(places))
    options = np.flatnonzero(gaps > 0.04) + 1
    for _ in range(200):
        if options.size < count:
            break
        cuts = np.sort(rng.choice(options, size=count, replace=False))
        edges = np.concatenate([[0], cuts, [places.size]])
        if np.min(np.diff(edges)) >= least:
            return tuple(float(math.sqrt(places[c - 1] * places[c])) for c in cuts)
    raise Redraw("no place for a boundary")


class Redraw(Exception):
    """What was drawn can't be built or told; it is drawn again."""
