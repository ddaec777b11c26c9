"""Claims about the critical frequency and the segmented model (Eqs. 11 to 16, Figures 7 to 9)."""

from __future__ import annotations

import math

import fluids
import numpy as np
from scipy.optimize import brentq

from discover.reproduction.claims.claim import Claim, verdict
from discover.reproduction.error_measure import model_deviation
from discover.reproduction.paper import (
    CRITERION,
    M1,
    M2,
    M3,
    Condition,
    integer_order_model,
)
from models.device import Device
from models.flow import (
    CONVENTIONS,
    critical_frequency,
    dean,
    dean_per_speed,
    reynolds,
    transition_reynolds,
)

_PIPE = 2000.0  # the paper's transition in a straight pipe
_MARGIN = 1e-9


def _device(number: int) -> Device:
    return Device.preset(f"device-{number}")


def _peak_dean(condition: Condition, convention: str) -> float:
    speed = 2.0 * math.pi * condition.frequency * condition.amplitude
    return float(dean(condition.device, speed, convention=convention))


def formula() -> Claim:
    """Whether Eq. 16 follows from Eqs. 12 to 15."""
    device, amplitude = _device(12), 0.005
    nu = device.fluid.kinematic_viscosity
    by_formula = CRITERION / (8.0 * math.sqrt(2.0) * math.pi * amplitude) * nu
    by_formula *= math.sqrt(device.channel_radius * device.helix_radius)
    by_formula /= device.cylinder_radius**2 - device.rod_radius**2
    by_root = float(
        brentq(
            lambda f: float(dean(device, 2 * math.pi * f * amplitude)) - CRITERION, 1e-3, 1e2,
            xtol=1e-14,
        )
    )
    return Claim(
        "critical-frequency",
        "The critical frequency is De/(8√2 π A0) (μ/ρ) √(r3 r4)/(r2² - r1²).",
        verdict(holds=abs(by_formula / by_root - 1.0) < _MARGIN),
        by_formula, by_root, "Hz", "Eq. 16",
        "Device [12], 5 mm: the formula against the root of De(f) = 100 by Eqs. 12 to 15. The "
        "printed prefactor agrees; the printed powers of r3 are garbled and this is the form that "
        "has the right dimension.",
    )


def usual_numbers() -> Claim:
    """Whether Eqs. 12 and 14 are the usual Reynolds and Dean numbers."""
    device, speed = _device(12), 0.1
    diameter = 2.0 * device.channel_radius
    flow = speed * device.area_ratio
    re = fluids.Reynolds(V=flow, D=diameter, nu=device.fluid.kinematic_viscosity)
    de = fluids.Dean(Re=re, Di=diameter, D=2.0 * device.helix_radius)
    ratios = [
        float(reynolds(device, speed, convention="paper")) / re,
        float(dean(device, speed, convention="paper")) / de,
    ]
    return Claim(
        "usual-numbers",
        "Eqs. 12 and 14 are the Reynolds and Dean numbers to which the criterion De = 100 refers.",
        verdict(holds=max(abs(r - 1.0) for r in ratios) < 1e-6),
        "1 and 1", f"{ratios[0]:.3f} and {ratios[1]:.3f}", "times the usual number",
        "Eqs. 12 to 14",
        "The paper's numbers over those of the package fluids (Re = d u/ν, De = Re √(d/D)).",
    )


def amplitude_rule() -> Claim:
    """Whether the critical frequency falls with amplitude, as its inverse."""
    values = critical_frequency(_device(12), np.array([0.005, 0.01, 0.02]))
    slope = float(np.polyfit(np.log([0.005, 0.01, 0.02]), np.log(values), 1)[0])
    return Claim(
        "amplitude-rule",
        "The larger the amplitude, the lower the critical frequency.",
        verdict(holds=slope < 0.0), "falls", slope, "exponent of A0", "section 3.3, Figure 7",
        "d ln f_low/d ln A0 below zero: Eq. 16 says -1, which records at several amplitudes test.",
    )


def device_10_is_lower() -> Claim:
    """Whether [10] has the much lower critical frequency."""
    values = [float(critical_frequency(_device(n), 0.005)) for n in (12, 10)]
    return Claim(
        "device-10-lower",
        "The critical frequency of device [10] is much smaller than that of [12].",
        verdict(holds=values[0] > 3.0 * values[1]),
        "much smaller", f"[12] {values[0]:.3f} Hz, [10] {values[1]:.4f} Hz", "at 5 mm",
        "section 3.3, Figure 7",
        f"More than threefold: {values[0] / values[1]:.1f} times with Table 1's viscosity; with the"
        f" text's 0.0068 it would be {values[0] / values[1] * 0.00168 / 0.0068:.1f} times.",
    )


def dean_is_lower() -> Claim:
    """Whether De = 100 lies below Re = 2000."""
    rows = []
    for n in (12, 10):
        by_dean = float(critical_frequency(_device(n), 0.005))
        per_hertz = float(reynolds(_device(n), 2 * math.pi * 0.005))
        rows.append((by_dean, _PIPE / per_hertz))
    return Claim(
        "dean-below-reynolds",
        "De = 100 is reached at a lower frequency than Re = 2000.",
        verdict(holds=all(a < b for a, b in rows)),
        "lower", "; ".join(f"{a:.3g} against {b:.3g} Hz" for a, b in rows), "[12]; [10], 5 mm",
        "section 3.3, Figure 7", "Both devices, the paper's convention.",
    )


def helical_turbulence() -> Claim:
    """Whether a helix makes turbulence more likely."""
    limits = [transition_reynolds(_device(n).curvature_ratio) for n in (12, 10)]
    straight = transition_reynolds(0.0)
    return Claim(
        "helix-turbulence",
        "Turbulence is more likely to occur in a helical channel.",
        verdict(holds=max(limits) < straight),
        "more likely", f"transition at Re {limits[0]:.0f} and {limits[1]:.0f}, straight "
        f"{straight:.0f}", "standard Reynolds number", "section 3.3",
        "Transition in a coil (Schmidt) against a straight pipe. De = 100 marks secondary flow, "
        "which delays turbulence, as the paper says two sentences before.",
    )


def m1_below_boundary() -> Claim:
    """Whether M1 was identified below the boundary."""
    values = {c: _peak_dean(M1.condition, c) for c in CONVENTIONS}
    return Claim(
        "m1-below-boundary",
        "M1, identified at 0.5 Hz, 20 mm, is a model of the ultra-low frequency region.",
        verdict(holds=values["paper"] < CRITERION),
        "below De = 100",
        f"De {values['paper']:.0f} (paper), {values['standard']:.0f} (standard)", "",
        "sections 3.2 and 3.3",
        "Peak Dean number of M1's own record against the criterion, by the paper's convention.",
    )


def figure_8_region() -> Claim:
    """Whether Figure 8's records lie below the boundary."""
    limit = float(critical_frequency(_device(12), 0.005))
    return Claim(
        "figure-8-region",
        "0.3 and 0.5 Hz at 5 mm lie below the critical frequency, 2 and 5 Hz above.",
        verdict(holds=0.5 < limit < 2.0), "between 0.5 and 2", limit, "Hz",
        "section 3.3, Figures 8 and 9",
        "f_low of device [12] at 5 mm by the paper's convention (standard: "
        f"{float(critical_frequency(_device(12), 0.005, convention='standard')):.2f} Hz).",
    )


def _deviations_of_both(frequencies: tuple[float, ...]) -> tuple[list[float], list[float]]:
    """Return e_d of M1 and of M2 against Eq. 5 at 5 mm."""
    integer = integer_order_model(_device(12))
    conditions = [Condition("device-12", f, 0.005) for f in frequencies]
    return (
        [model_deviation(M1.model(), integer, c) for c in conditions],
        [model_deviation(M2.model(), integer, c) for c in conditions],
    )


def _listed(first: list[float], second: list[float]) -> str:
    pairs = zip(first, second, strict=True)
    return "; ".join(f"M1 {a:.1f}, M2 {b:.1f} %" for a, b in pairs)


def figure_8() -> Claim:
    """Whether M1 is the closer below the boundary."""
    first, second = _deviations_of_both((0.3, 0.5))
    return Claim(
        "figure-8",
        "Below the critical frequency (0.3 and 0.5 Hz, 5 mm) M1 is closer to the integer-order "
        "model than M2.",
        verdict(holds=all(a < b for a, b in zip(first, second, strict=True))),
        "M1", _listed(first, second), "", "section 3.3, Figure 8",
        "e_d (peak) of both models at both frequencies.",
    )


def figure_9() -> Claim:
    """Whether M2 is the closer above the boundary."""
    first, second = _deviations_of_both((2.0, 5.0))
    return Claim(
        "figure-9",
        "Above the critical frequency (2 and 5 Hz, 5 mm) M2 is closer to the integer-order model "
        "than M1.",
        verdict(holds=all(b < a for a, b in zip(first, second, strict=True))),
        "M2", _listed(first, second), "", "section 3.3, Figure 9",
        "e_d (peak) of both models at both frequencies.",
    )


def segmented_is_better() -> Claim:
    """Whether the segmented model beats M2 alone below the boundary."""
    limit = float(critical_frequency(_device(12), 0.005))
    frequencies = tuple(float(f) for f in np.linspace(0.05, limit, 14))
    first, second = _deviations_of_both(frequencies)
    wins = [f for f, a, b in zip(frequencies, first, second, strict=True) if a < b]
    reach = f"M1 closer up to {max(wins):.2f} Hz" if wins else "M1 closer nowhere"
    return Claim(
        "segmented",
        "The segmented model is more accurate at ultra-low frequency than M2 alone.",
        verdict(holds=float(np.mean(first)) < float(np.mean(second))),
        "more accurate",
        f"mean e_d: segmented {np.mean(first):.2f}, M2 alone {np.mean(second):.2f} %; {reach}",
        "", "section 3.3, section 4 (1)",
        f"Against Eq. 5 at 5 mm, 14 frequencies from 0.05 to {limit:.2f} Hz, the mean e_d.",
    )


def beyond_800() -> Claim:
    """Where the paper's inertial records lie."""
    values = [_peak_dean(one.condition, "paper") for one in (M2, M3)]
    return Claim(
        "beyond-800",
        "Above De = 800 what is known for 100 to 800 can be extended linearly.",
        "unverifiable", "100 to 800", f"M2 {values[0]:.0f}, M3 {values[1]:.0f}",
        "De (paper) of the records", "section 3.3",
        "Needs measurements on both sides. Both inertial models were identified beyond 800.",
    )


def inertia_above_boundary() -> Claim:
    """Whether inertia exceeds damping from the critical frequency on."""
    ratios = {}
    for n, amplitudes in ((12, (0.005, 0.02)), (10, (0.005, 0.0175))):
        device = _device(n)
        c1, c2 = device.laminar_coefficients
        # The boundary is a speed, so the damping there is the same at every amplitude.
        damping = c2 + 8.0 / (3.0 * math.pi) * c1 * CRITERION / dean_per_speed(device)
        for amplitude in amplitudes:
            omega = 2.0 * math.pi * float(critical_frequency(device, amplitude))
            ratios[f"[{n}] {1e3 * amplitude:g} mm"] = omega * device.inertance / damping
    return Claim(
        "inertia-above-boundary",
        "De = 100 separates flow that viscosity dominates from flow that inertia dominates.",
        verdict(holds=all(0.5 < r < 2.0 for r in ratios.values())),
        1.0, ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items()),
        "inertial over damping force at De = 100", "section 3.3",
        "ω b/c_eq of Eq. 5 at the boundary, to be one within a factor of two. The frequency at "
        "which the two forces are equal, near 4 ν/(π r3²), doesn't depend on the amplitude; "
        "that at De = 100 does.",
    )


CLAIMS = (
    formula,
    usual_numbers,
    amplitude_rule,
    device_10_is_lower,
    dean_is_lower,
    helical_turbulence,
    m1_below_boundary,
    figure_8_region,
    figure_8,
    figure_9,
    segmented_is_better,
    beyond_800,
    inertia_above_boundary,
)
