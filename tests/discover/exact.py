"""Exact sine-test records from closed forms, independent of the library's terms and operators."""

from __future__ import annotations

import numpy as np

from discover.records import Campaign, Record
from models.device import Device

FREQUENCIES = tuple(np.geomspace(0.1, 15.0, 12))
AMPLITUDES = (0.005, 0.010, 0.020)
DEVICE_12 = Device.preset("device-12")
DEVICE_10 = Device.preset("device-10")


def fractional(product, order, friction):
    """FOIM under A sin(theta): the harmonic rule of Eq. 4, plus friction."""

    def force(amplitude, omega, theta):
        return product * amplitude * omega**order * np.sin(
            theta + order * np.pi / 2.0
        ) + friction * np.sign(np.cos(theta))

    return force


def segmented(device, below, above, *, dean=100.0):
    """SFOIM: (product, order, friction) below and above a Dean number, the paper's convention."""
    s1 = np.pi * (device.cylinder_radius**2 - device.rod_radius**2)
    s2 = np.pi * device.channel_radius**2
    kinematic = device.fluid.viscosity / device.fluid.density
    per_speed = 2.0 * (2.0 * device.channel_radius) * s1 / (kinematic * s2)
    per_speed *= np.sqrt(2.0 * device.channel_radius / device.helix_radius)

    def force(amplitude, omega, theta):
        low = per_speed * amplitude * omega < dean
        return fractional(*(below if low else above))(amplitude, omega, theta)

    return force


def integer(inertance, viscous, quadratic, turbulent, friction):
    """IOIM under A sin(theta); the turbulent term has the power 1.75."""

    def force(amplitude, omega, theta):
        v = amplitude * omega * np.cos(theta)
        return (
            -inertance * amplitude * omega**2 * np.sin(theta)
            + viscous * v
            + quadratic * v * np.abs(v)
            + turbulent * np.sign(v) * np.abs(v) ** 1.75
            + friction * np.sign(v)
        )

    return force


def records(
    force,
    *,
    noise=0.02,
    seed=0,
    frequencies=FREQUENCIES,
    amplitudes=AMPLITUDES,
    cycles=6.0,
    most_acceleration=60.0,
    held_out=(),
):
    """Return records of a force law, with white noise relative to each record's force."""
    rng = np.random.default_rng(seed)
    result = []
    for amplitude in amplitudes:
        for frequency in frequencies:
            omega = 2.0 * np.pi * frequency
            if amplitude * omega**2 > most_acceleration:
                continue
            rate = 1000.0 if frequency > 1.0 else 200.0
            time = np.arange(int(cycles / frequency * rate)) / rate
            theta = omega * time + rng.uniform(0.0, 2.0 * np.pi)
            clean = force(amplitude, omega, theta)
            scale = noise * np.sqrt(np.mean(clean**2))
            measured = clean + scale * rng.standard_normal(time.size)
            displacement = amplitude * np.sin(theta) + 1e-6 * rng.standard_normal(time.size)
            name = f"{frequency:.3g}hz-{1e3 * amplitude:g}mm.csv"
            result.append(
                Record(name, time, measured, displacement, held_out=len(result) in held_out)
            )
    return tuple(result)


def campaign(force, device=DEVICE_12, **options):
    """Return a campaign of exact records."""
    return Campaign("exact records", records(force, **options), device=device, content_hash="0")
