"""Devices, plans and noise of the third set."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy import fft, signal

from models.checks import Array
from models.device import Device, Fluid
from models.rig import Limits, Plan, TestPoint

NOISE = 0.01
"""rms over each record's rms force."""
_RATES = (100.0, 160.0, 240.0, 300.0, 480.0, 600.0, 960.0, 1500.0, 2400.0)
_SAMPLES_A_CYCLE = 32.0
_LIMITS = Limits(stroke=0.022, speed=0.45, force=20e3)


def third_device(rng: np.random.Generator) -> Device:
    """Draw a device with a short, wide or a long, narrow channel."""
    wide = bool(rng.integers(2))
    while True:
        rod = rng.uniform(0.009, 0.017)
        channel = rng.uniform(0.007, 0.011) if wide else rng.uniform(0.004, 0.006)
        device = Device(
            rod_radius=rod,
            cylinder_radius=rod + rng.uniform(0.010, 0.019),
            channel_radius=channel,
            helix_radius=rng.uniform(0.06, 0.16),
            helix_pitch=2.0 * channel * rng.uniform(1.05, 2.5),
            turns=float(rng.integers(8, 21) if wide else rng.integers(3, 10)),
            fluid=Fluid(rng.uniform(760.0, 1040.0), math.exp(rng.uniform(*np.log([1.2e-3, 6e-2])))),
            transition_length=rng.uniform(0.0, 0.08),
            piston_clearance=rng.uniform(6e-5, 2.5e-4),
            name="third",
        )
        if 30.0 < device.inertance < 900.0 and device.laminar_coefficients.c2 < 10e3:
            friction = 10.0 * rng.uniform(0.03, 0.15) * device.inertance
            return replace(device, coulomb_friction=friction)


def third_plan(device: Device, rng: np.random.Generator) -> Plan:
    """Draw 10 to 15 sine tests: rows of equal peak speed, each over several frequencies."""
    while True:
        rows = int(rng.integers(3, 6))
        lowest, highest = rng.uniform(0.2, 0.45), rng.uniform(6.0, 11.0)
        speeds = np.geomspace(rng.uniform(0.015, 0.03), rng.uniform(0.25, 0.43), rows)
        points: dict[str, TestPoint] = {}
        for speed in speeds * np.exp(0.1 * rng.standard_normal(rows)):
            count = int(rng.integers(3, 6))
            shares = (np.arange(count) + rng.uniform(0.0, 1.0, count)) / count
            for share in shares:
                frequency = float(f"{lowest * (highest / lowest) ** share:.3g}")
                amplitude = float(f"{speed / (2.0 * math.pi * frequency):.3g}")
                rates = [r for r in _RATES if r >= _SAMPLES_A_CYCLE * frequency]
                point = TestPoint(
                    frequency,
                    amplitude,
                    cycles=float(f"{rng.uniform(4.5, 9.5):.2f}"),
                    sampling=float(rng.choice(rates[:4])),
                )
                if amplitude >= 5e-4 and _LIMITS.allows(device, point):
                    points[point.file] = point
        if 10 <= len(points) <= 15:
            return Plan(tuple(points.values()))


def third_noise(force: Array, sampling: float, kind: int, rng: np.random.Generator) -> Array:
    """Return noise of 1 % of a record's rms force: wandering, of a band, or rising with it."""
    size = force.size
    white = rng.standard_normal(size)
    if kind % 3 == 0:
        keep = math.exp(-2.0 * math.pi * 0.8 / sampling)
        red = signal.lfilter([1.0], [1.0, -keep], rng.standard_normal(size + 2000))[2000:]
        noise = 0.5 * white + 0.9 * red * math.sqrt(1.0 - keep**2)
    elif kind % 3 == 1:
        spectrum = np.asarray(fft.rfft(rng.standard_normal(2 * size)))
        frequency = fft.rfftfreq(2 * size, 1.0 / sampling)
        inside = (frequency > 0.11 * sampling) & (frequency < 0.2 * sampling)
        band = np.asarray(fft.irfft(spectrum * inside))[:size]
        noise = 0.6 * white + 0.8 * band / max(float(np.std(band)), 1e-12)
    else:
        before = rng.standard_normal(size + 1)
        noise = 0.6 * white + 0.5 * (before[1:] - 0.8 * before[:-1])
    noise *= NOISE * math.sqrt(float(np.mean(force**2))) / math.sqrt(float(np.mean(noise**2)))
    return np.asarray(noise)
