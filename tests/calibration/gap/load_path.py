"""What every set needs for parts in the load path; their laws are each set's own."""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Values
from models.rig.stepping import Element, transmitted_force


def change(bench: Bench, element: Element, *, seals: bool) -> Array:
    """Return what an element in the load path changes, seals behind it or not."""
    force = transmitted_force(bench.stiff, bench.drive, element, seal_behind=seals)
    base = bench.stiff_fluid + (bench.seals if seals else 0.0)
    return bench.drive.sample(np.asarray(force - base))


def start_joint(scales: Scales) -> float:
    """Return a compliance, m/N, from which the one of a wanted size is searched."""
    return 0.05 * scales.speed**2 / scales.acceleration / scales.force


def stiff(bench: Bench, values: Values) -> tuple[float, float]:
    """Return stiffness and damping of a contact that resonates above the tests."""
    omega = 2.0 * math.pi * values["contact_frequency"]
    inertance = bench.device.inertance
    return inertance * omega**2, 2.0 * values["contact_damping"] * inertance * omega
