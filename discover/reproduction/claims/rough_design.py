"""Claims about the rough design (section 3.3's end, section 4)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from discover.reproduction.claims.claim import Claim, verdict
from discover.reproduction.error_measure import SAMPLES, root_mean_square_error
from discover.reproduction.paper import M2, integer_order_model
from models.design import minimise_critical_frequency
from models.device import Device
from models.flow import critical_frequency
from models.motion import sine_motion

_STEP = 1e-6


def friction_hides_the_error() -> Claim:
    """Whether M2's error below the boundary is small beside friction."""
    device = Device.preset("device-12")
    limit = float(critical_frequency(device, 0.005))
    friction = device.coulomb_friction or math.nan
    shares = []
    for frequency in np.linspace(0.05, limit, 14):
        motion = sine_motion(0.005, float(frequency), samples=SAMPLES)
        error = root_mean_square_error(
            M2.model().force(motion), integer_order_model(device).force(motion)
        )
        shares.append(error / friction)
    return Claim(
        "error-below-friction",
        "At ultra-low frequency the error of one fractional model is small beside friction.",
        verdict(holds=max(shares) < 0.25),
        "small", 100.0 * max(shares), "% of f0, largest", "section 3.3",
        f"RMSE of M2 against Eq. 5 over f0, device [12], 5 mm, up to {limit:.2f} Hz: below a "
        "quarter.",
    )


def design_lowers_it() -> Claim:
    """Whether geometry can lower the critical frequency at equal inertance."""
    result = minimise_critical_frequency(Device.preset("device-12"), front=False)
    gain = result.improvement or 0.0
    return Claim(
        "design-lowers",
        "Structural parameters can be chosen so that the critical frequency becomes small.",
        verdict(holds=gain >= 2.0), "small", gain, "times lower", "section 3.3, section 4 (2)",
        "Device [12]'s inertance, package and fluid kept, parasitic damping at most doubled: at "
        "least halved.",
    )


def inertial_corner(device: Device) -> float:
    """Return the frequency at which viscous damping and inertia are equal (Eq. 5), Hz."""
    return device.laminar_coefficients.c2 / (2.0 * math.pi * device.computed_inertance)


def low_means_inertial() -> Claim:
    """Whether lowering Eq. 16 always lowers the frequency at which inertia takes over."""
    device = Device.preset("device-12")
    signs = {}
    for dimension in ("cylinder_radius", "channel_radius", "helix_radius"):
        moved = replace(device, **{dimension: getattr(device, dimension) * (1.0 + _STEP)})
        critical = math.log(
            float(critical_frequency(moved, 0.005)) / float(critical_frequency(device, 0.005))
        )
        corner = math.log(inertial_corner(moved) / inertial_corner(device))
        signs[dimension] = (critical / _STEP, corner / _STEP)
    agree = all(a * b > 1e-3 for a, b in signs.values())
    return Claim(
        "low-means-inertial",
        "Under the rough design inertia dominates: a lower critical frequency means more inertia.",
        verdict(holds=agree),
        "same direction for every dimension",
        "; ".join(
            f"{name.replace('_', ' ')}: f_low {a:+.2f}, corner {b:+.2f}"
            for name, (a, b) in signs.items()
        ),
        "elasticity", "abstract, section 4",
        "Elasticities of f_low (Eq. 16) and of the corner c2/(2 π b) above which inertia exceeds "
        "viscous damping. A narrower channel lowers the first and raises the second; the piston "
        "moves the first alone.",
    )


CLAIMS = (friction_hides_the_error, design_lowers_it, low_means_inertial)
