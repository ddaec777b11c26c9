"""Random devices, plans and records from closed forms; the library's terms are not used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import lfilter

from discover.records import Campaign, Record
from models.device import Device

STRUCTURES = ("FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent", "SFOIM")
MOST_ACCELERATION = 60.0


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
    """One sine test: its samples' phases and the coefficient of its AR(1) noise."""

    frequency: float
    amplitude: float
    theta: np.ndarray
    clean: np.ndarray
    correlation: float
    sigma: float
    upper: bool


@dataclass(frozen=True)
class Case:
    """A campaign with the truth beside it."""

    seed: int
    structure: str
    lower: Law
    upper: Law
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


def random_case(seed: int) -> Case:
    """Return a random device, plan and campaign; every fifth has a boundary.

    Of the segmented ones half follow the Dean number 100 and half are fixed in frequency.
    """
    rng = np.random.default_rng([2026, seed])
    structure = STRUCTURES[seed % len(STRUCTURES)]
    device = random_device(rng)
    per_speed = dean_per_speed(device)
    boundary, place = "none", np.inf
    if structure == "SFOIM":
        upper = _law(rng, device, "FOIM")
        lower = replace(
            upper, fractional=device.inertance * _log_uniform(rng, 5.0, 20.0),
            order=rng.uniform(0.3, 0.9),
        )
        boundary = "dean" if (seed // len(STRUCTURES)) % 2 == 0 else "frequency"
        place = 100.0 if boundary == "dean" else _log_uniform(rng, 0.6, 2.0)
    else:
        upper = lower = _law(rng, device, structure)
    count = int(rng.integers(4, 13))
    amplitudes = 0.02 * 0.5 ** np.arange(int(rng.integers(1, 4)))
    low = 0.1 * _log_uniform(rng, 0.7, 2.0)
    frequencies = np.geomspace(low, rng.uniform(5.0, 15.0), count)
    if seed % 11 == 3 and boundary == "none":
        frequencies = frequencies[-1:] * 0.5  # a single frequency separates nothing
    noise, correlation = rng.uniform(0.01, 0.05), rng.uniform(0.0, 0.98)
    tests, records = [], []
    for amplitude in amplitudes:
        for frequency in frequencies:
            omega = 2.0 * np.pi * frequency
            if amplitude * omega**2 > MOST_ACCELERATION:
                continue
            rate = max(200.0, 60.0 * frequency) * rng.uniform(1.0, 1.5)
            time = np.arange(int(rng.uniform(3.0, 8.0) / frequency * rate)) / rate
            theta = omega * time + rng.uniform(0.0, 2.0 * np.pi)
            coordinate = per_speed * amplitude * omega if boundary == "dean" else frequency
            above = boundary == "none" or coordinate > place
            clean = (upper if above else lower).force(amplitude, omega, theta)
            sigma = noise * float(np.sqrt(np.mean(clean**2)))
            white = rng.standard_normal(time.size + 500) * np.sqrt(1.0 - correlation**2)
            force = clean + sigma * lfilter([1.0], [1.0, -correlation], white)[500:]
            x = amplitude * (np.sin(theta) + 1e-4 * rng.standard_normal(time.size))
            tests.append(Test(frequency, amplitude, theta, clean, correlation, sigma, above))
            records.append(Record(f"{len(records):02d}.csv", time, force, x))
    campaign = Campaign(f"case {seed}", tuple(records), device=device, content_hash=str(seed))
    return Case(seed, structure, lower, upper, boundary, place, tuple(tests), campaign)
