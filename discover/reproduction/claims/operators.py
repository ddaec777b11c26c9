"""Claims about fractional derivatives and the fractional model (Eqs. 1 to 4, 7, 8)."""

from __future__ import annotations

import math

import numpy as np

from discover.identification import Trial, identify_by_projection
from discover.reproduction.claims.claim import Claim, verdict
from discover.reproduction.paper import M1, M2, integer_order_model
from models.constitutive import foim, ioim_laminar, ioim_turbulent
from models.device import Device
from models.equivalents import fractional_equivalents
from models.flow import effective_order
from models.fractional import derivative
from models.motion import sine_motion

_ROUND_OFF = 1e-6


def caputo_of_power(power: float, order: float, t: float) -> float:
    """Return the Caputo derivative of t^power, power 0 or above order - 1 or a smaller integer."""
    if power < math.ceil(order) and power == int(power):
        return 0.0
    ratio = math.gamma(power + 1.0) / math.gamma(power + 1.0 - order)
    return float(ratio * t ** (power - order))


def composition() -> Claim:
    """Whether orders of Caputo derivatives add (Eq. 2, first line)."""
    t, a, b = 2.0, 0.6, 0.6
    inner = math.gamma(2.0) / math.gamma(2.0 - b)
    twice = inner * caputo_of_power(1.0 - b, a, t)
    once = caputo_of_power(1.0, a + b, t)
    return Claim(
        "composition",
        "D^α D^β x = D^(α+β) x for Caputo derivatives of orders α, β between 0 and 1.",
        verdict(holds=abs(twice - once) <= _ROUND_OFF),
        "equal", f"D^0.6 D^0.6 t = {twice:.3f}, D^1.2 t = {once:.3f} at t = 2", "",
        "Eq. 2",
        "x = t, whose derivatives are continuous: the two sides agree only where x starts at rest "
        "(or in a steady state).",
    )


def time_scale() -> Claim:
    """Whether D_t^a x = w^a D_tau^a z (Eq. 3)."""
    omega, order, dt = 3.7, 0.6, 1e-3
    tau = dt * np.arange(2001)
    z = np.sin(tau) ** 2
    direct = derivative(z, order, dt / omega)
    scaled = omega**order * derivative(z, order, dt)
    worst = float(np.max(np.abs(direct - scaled)) / np.max(np.abs(scaled)))
    return Claim(
        "time-scale",
        "Under τ = ω t the derivative scales with ω^order.",
        verdict(holds=worst < _ROUND_OFF), 0.0, worst, "relative difference", "Eq. 3",
        "Caputo derivatives of sin² on both time scales, equal to 1e-6.",
    )


def caputo_of_sine() -> Claim:
    """Whether the Caputo derivative of a sine is a shifted sine (Eq. 4)."""
    order, dt, cycles = 0.5, 2.0 * math.pi / 400, 10
    t = dt * np.arange(400 * cycles + 1)
    steady = np.sin(t + order * math.pi / 2)
    difference = np.abs(derivative(np.sin(t), order, dt) - steady)
    first, last = float(difference[:401].max()), float(difference[-400:].max())
    return Claim(
        "caputo-sine",
        "The Caputo derivative of A sin(ωt + φ) is A ω^α sin(ωt + φ + απ/2).",
        verdict(holds=first < 0.01), 0.0, first, "of the amplitude", "Eq. 4",
        "Order 0.5 from rest at t = 0: the largest difference in the first cycle, to stay under "
        f"1 %; in the tenth it is {100 * last:.2f} %. Eq. 4 is the steady state (Weyl), and every "
        "figure of the paper uses it.",
    )


def equivalents_hold() -> Claim:
    """Whether Eq. 8 equals Eq. 7 under a sine."""
    motion = sine_motion(0.005, 12.0)
    omega = 2.0 * math.pi * 12.0
    model = foim(Device.preset("device-12"), M2.b0, M2.order)
    inertance, damping = fractional_equivalents(model.terms[0].coefficient, M2.order, omega)
    built = inertance * motion.acceleration + damping * motion.velocity
    built = built + (model.terms[1].coefficient) * np.sign(motion.velocity)
    direct = model.force(motion)
    worst = float(np.max(np.abs(built - direct)) / np.max(np.abs(direct)))
    return Claim(
        "equivalents",
        "Under a sine the fractional model equals an inertance and a damping that depend on "
        "frequency.",
        verdict(holds=worst < _ROUND_OFF), 0.0, worst, "relative difference", "Eq. 8",
        "M2 at 12 Hz, 5 mm, both forms, equal to 1e-6.",
    )


def order_is_the_proportion() -> Claim:
    """Whether the order alone sets the proportion of inertia and damping."""
    omega = 2.0 * math.pi * np.array([0.5, 3.0, 15.0])
    inertance, damping = fractional_equivalents(1.0, M2.order, omega)
    ratios = omega * inertance / damping
    spread = float(np.ptp(ratios) / ratios.mean())
    return Claim(
        "order-proportion",
        "The order is the proportion of inertia to damping, whatever the frequency.",
        verdict(holds=spread < _ROUND_OFF),
        "constant", float(ratios.mean()), "inertial over damping force", "below Eq. 8",
        "ω b_eq/c_eq of Eq. 8 for M2 from 0.5 to 15 Hz: constant to 1e-6. A mass and a dashpot "
        "have a proportion that grows with frequency instead.",
    )


def order_range() -> Claim:
    """Whether the fractional models obey Eq. 7's range."""
    omega = 2.0 * math.pi * M1.condition.frequency
    inertance = float(fractional_equivalents(1.0, M1.order, omega).inertance)
    return Claim(
        "order-range",
        "The fractional model has an order between 1 and 2 (Eq. 7); M1 is one.",
        verdict(holds=1.0 < M1.order < 2.0),
        "1 to 2", M1.order, "order", "Eq. 7, Table 2",
        f"M1's order. Below one Eq. 8's inertance is {'negative' if inertance < 0 else 'positive'}:"
        " the device would act as a spring.",
    )


def low_order_from_flow() -> Claim:
    """Whether laminar flow can have an order below one."""
    womersley = np.geomspace(1e-3, 1e3, 400)
    orders = np.concatenate([effective_order(womersley, by=by) for by in ("phase", "amplitude")])
    low, high = float(orders.min()), float(orders.max())
    return Claim(
        "order-below-one",
        "An order of 0.48 describes the flow at ultra-low frequency.",
        verdict(holds=low <= M1.order <= high),
        M1.order, f"{low:.2f} to {high:.2f}", "order", "section 3.2",
        "The order of exact laminar pipe flow over all Womersley numbers, by phase and amplitude. "
        "Compliance or presliding friction must be tested first.",
    )


def order_below_one_always() -> Claim:
    """Give the integer-order model itself an order at 0.5 Hz."""
    condition = M1.condition
    motion = sine_motion(condition.amplitude, condition.frequency)
    trial = Trial(motion, integer_order_model(condition.device).force(motion))
    found = identify_by_projection([trial], condition.device, order_bounds=(0.0, 2.0))
    return Claim(
        "order-at-0.5hz",
        "At 0.5 Hz the identified order is always below one, however it is optimised.",
        "unverifiable", M1.order, found.order, "order", "section 3.2",
        "The record is not public. The integer-order model's own force, identified the same way "
        "with bounds 0 to 2, has the order shown.",
    )


def one_record() -> Claim:
    """Whether one record at one frequency can show a fractional law."""
    condition = M2.condition
    motion = sine_motion(condition.amplitude, condition.frequency)
    columns = np.stack([motion.velocity, motion.acceleration, motion.fractional(M2.order)])
    columns = columns / np.linalg.norm(columns, axis=1)[:, None]
    values = np.linalg.svd(columns, compute_uv=False)
    return Claim(
        "one-record",
        "M2's order, identified from one record at 12 Hz, is evidence of a fractional law.",
        verdict(holds=bool(values[2] > 1e-6 * values[0])),
        "order 1.89", float(values[2] / values[0]), "smallest over largest singular value",
        "section 3.2",
        "At one frequency v, a and D^1.89 x span a plane: a mass with a dashpot gives the same "
        "force exactly. Several frequencies in one band are needed.",
    )


def order_across_records() -> Claim:
    """Whether the order identified at 12 Hz is that at other frequencies."""
    device = Device.preset("device-12")
    found = []
    for frequency, amplitude in ((3.0, 0.01), (8.0, 0.005), (12.0, 0.005), (15.0, 0.005)):
        motion = sine_motion(amplitude, frequency)
        trial = Trial(motion, ioim_laminar(device).force(motion))
        found.append(identify_by_projection([trial], device, order_bounds=(0.0, 2.0)).order)
    return Claim(
        "order-across-records",
        "Parameters identified at 12 Hz hold at other frequencies: the order is the device's.",
        verdict(holds=float(np.ptp(found)) <= 2 * M2.order_rounding),
        M2.order, ", ".join(f"{value:.2f}" for value in found), "order at 3, 8, 12, 15 Hz",
        "section 3.2",
        "The order identified from the integer-order model's own force at each of the paper's "
        "records: to agree within the printed digit.",
    )


def linear_analysis() -> Claim:
    """Whether the fractional model is linear."""
    model = foim(Device.preset("device-12"), M2.b0, M2.order)
    once = model.force(sine_motion(0.005, 2.0))
    twice = model.force(sine_motion(0.010, 2.0))
    deviation = float(np.max(np.abs(twice - 2.0 * once)) / np.max(np.abs(twice)))
    left_out = ", ".join(name.replace("coulomb-", "Coulomb ") for name in model.nonlinear_terms)
    return Claim(
        "linear-analysis",
        "Transfer functions and eigenvalues apply to the fractional model, unlike the nonlinear "
        "ones.",
        verdict(holds=deviation < _ROUND_OFF), 0.0, deviation, "departure from superposition",
        "abstract, section 4",
        f"Force at twice the amplitude against twice the force, 2 Hz. The model keeps {left_out}; "
        "only without that term is it linear.",
    )


def fewer_parameters() -> Claim:
    """Count of terms and of identified parameters."""
    integer = [
        len(ioim_laminar(Device.preset("device-12")).terms),
        len(ioim_turbulent(Device.preset("device-10")).terms),
    ]
    fractional = foim(Device.preset("device-12"), M2.b0, M2.order)
    count = sum(1 + len(t.shape) for t in fractional.terms if t.id == "fractional-derivative") + 1
    return Claim(
        "fewer-parameters",
        "The fractional model has fewer parameters than the integer-order models.",
        verdict(holds=count < min(integer)),
        "fewer", f"{count} against {integer[0]} and {integer[1]}", "", "below Eq. 8, section 3.3",
        "Coefficients and orders of the force laws. The integer-order coefficients follow from "
        "geometry, all but friction; b0 and the order are identified from a record.",
    )


CLAIMS = (
    composition,
    time_scale,
    caputo_of_sine,
    equivalents_hold,
    order_is_the_proportion,
    order_range,
    low_order_from_flow,
    order_below_one_always,
    one_record,
    order_across_records,
    linear_analysis,
    fewer_parameters,
)
