"""Random devices, plans and records from closed forms; the library's terms are not used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from discover.records import Campaign, Record
from models.device import Device
from tests.calibration.noise import KINDS, Noise, random_noise

STRUCTURES = ("FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent", "SFOIM")
MOST_ACCELERATION = 60.0
FEWEST, MOST = 8, 40
"""Records of a plan, unless it has a single frequency."""
FEWEST_BESIDE = 3
"""Tests on either side of a boundary."""


@dataclass(frozen=True)
class Law:
    """Force under x = A sin(theta) as coefficients of closed forms."""

    structure: str
    inertance: float = 0.0
    viscous: float = 0.0
    quadratic: float = 0.0
    turbulent: float = 0.0
    fractional: float = 0.0
    order: float = 0.0
    friction: float = 0.0

    def force(self, amplitude, omega, theta):
        v = amplitude * omega * np.cos(theta)
        return (
            -self.inertance * amplitude * omega**2 * np.sin(theta)
            + self.viscous * v
            + self.quadratic * v * np.abs(v)
            + self.turbulent * np.sign(v) * np.abs(v) ** 1.75
            + self.fractional * amplitude * omega**self.order
            * np.sin(theta + self.order * np.pi / 2.0)
            + self.friction * np.sign(v)
        )


@dataclass(frozen=True)
class Test:
    """One sine test: its samples' phases, its exact force and its noise."""

    frequency: float
    amplitude: float
    theta: np.ndarray
    clean: np.ndarray
    noise: Noise
    sigma: float
    upper: bool


@dataclass(frozen=True)
class Case:
    """A campaign with the truth beside it."""

    seed: int
    structure: str
    lower: Law
    upper: Law
    plan: str
    """"wide", "narrow" (a factor 1.3 to 2 in frequency) or "single" frequency."""
    boundary: str
    """"none", "dean" or "frequency"."""
    place: float
    tests: tuple[Test, ...]
    campaign: Campaign


def _log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def random_device(rng) -> Device:
    """Return a device around the paper's device [12]."""
    base = Device.preset("device-12")
    return replace(
        base,
        name="",
        channel_radius=0.005 * _log_uniform(rng, 0.8, 1.3),
        helix_radius=0.1 * _log_uniform(rng, 0.8, 1.3),
        helix_pitch=0.02,
        turns=14.0 * _log_uniform(rng, 0.6, 1.3),
        piston_clearance=1e-4,
    )


def _law(rng, device, structure) -> Law:
    c1, c2 = device.laminar_coefficients
    t1, t2, _ = device.turbulent_coefficients
    friction = _log_uniform(rng, 50.0, 600.0)
    b = device.inertance
    if structure == "FOIM":
        return Law(
            structure, fractional=b * _log_uniform(rng, 1.0, 2.0),
            order=rng.uniform(1.6, 1.97), friction=friction,
        )
    if structure == "IOIM-linear":
        viscous = c2 * _log_uniform(rng, 0.5, 2.0)
        return Law(structure, inertance=b, viscous=viscous, friction=friction)
    if structure == "IOIM-laminar":
        quadratic = c1 * _log_uniform(rng, 0.7, 3.0)
        return Law(structure, inertance=b, viscous=c2, quadratic=quadratic, friction=friction)
    return Law(
        structure, inertance=b, viscous=c2 * rng.uniform(0.0, 0.3), quadratic=t2, turbulent=t1,
        friction=friction,
    )


def dean_per_speed(device) -> float:
    """Return the paper's Dean number per m/s, from its Eqs. 12 to 14."""
    s1 = np.pi * (device.cylinder_radius**2 - device.rod_radius**2)
    s2 = np.pi * device.channel_radius**2
    kinematic = device.fluid.viscosity / device.fluid.density
    reynolds = 2.0 * (2.0 * device.channel_radius) * s1 / (kinematic * s2)
    return float(reynolds * np.sqrt(2.0 * device.channel_radius / device.helix_radius))


def _points(rng, plan: str) -> list[tuple[float, float]]:
    """Return (frequency, amplitude) of a plan's tests that the rig's acceleration allows."""
    low, high = 0.1 * _log_uniform(rng, 0.7, 2.0), rng.uniform(5.0, 15.0)
    count, levels = int(rng.integers(4, 14)), int(rng.integers(1, 4))
    if plan == "narrow":
        low = _log_uniform(rng, 0.2, 6.0)
        high, levels = low * rng.uniform(1.3, 2.0), levels + 1
    elif plan == "single":
        low = high = _log_uniform(rng, 0.3, 5.0)
        count, levels = 1, int(rng.integers(2, 6))
    amplitudes = 0.02 * (0.7 if plan == "single" else 0.5) ** np.arange(levels)
    return [
        (float(f), float(a))
        for a in amplitudes
        for f in np.geomspace(low, high, count)
        if a * (2.0 * np.pi * f) ** 2 <= MOST_ACCELERATION
    ]


def _segmented(rng, device, boundary: str) -> tuple[Law, Law, float]:
    """Return two fractional laws and the coordinate at which one replaces the other.

    Half of them are far apart in order and level, half are near.
    """
    upper = _law(rng, device, "FOIM")
    if rng.random() < 0.5:
        ratio, order = _log_uniform(rng, 5.0, 20.0), rng.uniform(0.3, 0.9)
    else:
        ratio, order = _log_uniform(rng, 1.5, 8.0), rng.uniform(0.8, 1.4)
        upper = replace(upper, order=rng.uniform(1.5, 1.97))
    lower = replace(upper, fractional=device.inertance * ratio, order=order)
    return lower, upper, 100.0 if boundary == "dean" else _log_uniform(rng, 0.6, 2.0)


def random_case(seed: int) -> Case:
    """Return a random device, plan and campaign; every fifth has a boundary.

    Of the segmented ones half follow the Dean number 100 and half are fixed in frequency; their
    plans are drawn until at least three tests lie on either side. Of the others a fifth are narrow
    in frequency and a twelfth have a single frequency. Each record has noise of its own: of one
    kind in half of the campaigns, of any kind in the other half.
    """
    rng = np.random.default_rng([2027, seed])
    structure = STRUCTURES[seed % len(STRUCTURES)]
    segmented = structure == "SFOIM"
    plan = "wide"
    if not segmented:
        plan = str(rng.choice(["wide", "narrow", "single"], p=[0.72, 0.2, 0.08]))
    boundary = "none"
    if segmented:
        boundary = "dean" if (seed // len(STRUCTURES)) % 2 == 0 else "frequency"
    while True:
        device = random_device(rng)
        per_speed = dean_per_speed(device)
        place = np.inf
        if segmented:
            lower, upper, place = _segmented(rng, device, boundary)
        else:
            lower = upper = _law(rng, device, structure)
        points = _points(rng, plan)
        above = [
            boundary == "none"
            or (per_speed * a * 2.0 * np.pi * f if boundary == "dean" else f) > place
            for f, a in points
        ]
        enough = plan == "single" or FEWEST <= len(points) <= MOST
        beside = min(sum(above), len(points) - sum(above)) if segmented else FEWEST_BESIDE
        if enough and points and beside >= FEWEST_BESIDE:
            break
    share = rng.uniform(0.01, 0.05)
    kind = str(rng.choice(KINDS)) if rng.random() < 0.5 else None
    tests, records = [], []
    for (frequency, amplitude), over in zip(points, above, strict=True):
        omega = 2.0 * np.pi * frequency
        rate = max(200.0, 60.0 * frequency) * rng.uniform(1.0, 1.5)
        time = np.arange(int(rng.uniform(3.0, 8.0) / frequency * rate)) / rate
        theta = omega * time + rng.uniform(0.0, 2.0 * np.pi)
        clean = (upper if over else lower).force(amplitude, omega, theta)
        noise = random_noise(rng, kind or str(rng.choice(KINDS)), time.size)
        sigma = share * float(np.sqrt(np.mean(clean**2)))
        force = clean + sigma * noise.draw(time.size, rng)
        x = amplitude * (np.sin(theta) + 1e-4 * rng.standard_normal(time.size))
        tests.append(Test(frequency, amplitude, theta, clean, noise, sigma, over))
        records.append(Record(f"{len(records):02d}.csv", time, force, x))
    campaign = Campaign(f"case {seed}", tuple(records), device=device, content_hash=str(seed))
    return Case(
        seed, structure, lower, upper, plan, boundary, place, tuple(tests), campaign
    )
