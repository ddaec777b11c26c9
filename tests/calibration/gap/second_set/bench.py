"""Devices, plans and noise of the second set."""

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
_RATES = (100.0, 128.0, 200.0, 256.0, 400.0, 512.0, 800.0, 1000.0, 1200.0, 2000.0)
_SAMPLES_A_CYCLE = 30.0


def second_device(rng: np.random.Generator) -> Device:
    """Draw a small or a large device, or one near the published device [10]."""
    while True:
        scale = float(rng.choice([0.7, 1.0, 1.5])) * rng.uniform(0.9, 1.1)
        rod = scale * rng.uniform(0.011, 0.016)
        channel = scale * rng.uniform(0.0045, 0.0075)
        device = Device(
            rod_radius=rod,
            cylinder_radius=rod + scale * rng.uniform(0.009, 0.016),
            channel_radius=channel,
            helix_radius=scale * rng.uniform(0.08, 0.14),
            helix_pitch=2.0 * channel * rng.uniform(1.2, 3.0),
            turns=float(rng.integers(3, 13)),
            fluid=Fluid(rng.uniform(790.0, 1000.0), math.exp(rng.uniform(*np.log([1.5e-3, 8e-2])))),
            transition_length=rng.uniform(0.0, 0.05),
            piston_clearance=rng.uniform(5e-5, 2e-4),
            name="second",
        )
        if 15.0 < device.inertance < 1500.0 and device.laminar_coefficients.c2 < 12e3:
            friction = 10.0 * rng.uniform(0.03, 0.2) * device.inertance
            return replace(device, coulomb_friction=friction)


def second_plan(device: Device, rng: np.random.Generator) -> Plan:
    """Draw 10 to 16 sine tests off any grid, few cycles long, at one or two amplitudes each."""
    wanted = int(rng.integers(10, 17))
    limits = Limits()
    lowest, highest = math.exp(rng.uniform(math.log(0.15), math.log(0.5))), rng.uniform(7.0, 14.0)
    while True:
        count = wanted // 2 + int(rng.integers(0, 3))
        spread = (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
        points: dict[str, TestPoint] = {}
        for share in spread:
            frequency = float(f"{lowest * (highest / lowest) ** share:.3g}")
            for _ in range(int(rng.integers(1, 3))):
                top = _greatest(device, frequency, limits)
                amplitude = float(f"{top * rng.uniform(0.3, 0.98):.2g}")
                rates = [r for r in _RATES if r >= _SAMPLES_A_CYCLE * frequency]
                point = TestPoint(
                    frequency,
                    amplitude,
                    cycles=float(rng.integers(4, 9)) + float(rng.choice([0.0, 0.37])),
                    sampling=float(rng.choice(rates[:5])),
                )
                if limits.allows(device, point):
                    points[point.file] = point
        if 10 <= len(points) <= 16:
            return Plan(tuple(points.values()))


def _greatest(device: Device, frequency: float, limits: Limits) -> float:
    """Return the greatest amplitude that the limits allow at a frequency, m."""
    trials = np.geomspace(limits.stroke, 1e-4, 60)
    for amplitude in trials:
        if limits.allows(device, TestPoint(frequency, float(amplitude))):
            return float(amplitude)
    return float(trials[-1])


def second_noise(force: Array, sampling: float, kind: int, rng: np.random.Generator) -> Array:
    """Return noise of 1 % of a record's rms force: 1/f, with mains hum, or resonant (AR(2))."""
    size = force.size
    white = rng.standard_normal(size)
    if kind % 3 == 0:
        spectrum = np.asarray(fft.rfft(rng.standard_normal(2 * size)))
        spectrum[1:] /= np.sqrt(np.arange(1, spectrum.size))
        spectrum[0] = 0.0
        pink = np.asarray(fft.irfft(spectrum))[:size]
        noise = 0.6 * white + 0.8 * pink / np.std(pink)
    elif kind % 3 == 1:
        angle = 2.0 * math.pi * 50.0 * np.arange(size) / sampling
        phases = rng.uniform(0.0, 2.0 * math.pi, 2)
        hum = np.sin(angle + phases[0]) + 0.4 * np.sin(3.0 * angle + phases[1])
        noise = white + 0.7 * hum
    else:
        radius = math.exp(-0.15)
        turn = 2.0 * math.pi * min(37.0 / sampling, 0.35)
        drive = rng.standard_normal(size + 200)
        coloured = signal.lfilter(
            [1.0], [1.0, -2.0 * radius * math.cos(turn), radius**2], drive
        )[200:]
        noise = 0.5 * white + coloured / np.std(coloured)
    noise *= NOISE * math.sqrt(float(np.mean(force**2))) / math.sqrt(float(np.mean(noise**2)))
    return np.asarray(noise)
