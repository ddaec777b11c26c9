"""Claims about the two devices and their constants (Table 1 and the text)."""

from __future__ import annotations

import math
from dataclasses import replace

from discover.reproduction.claims.claim import Claim, verdict
from discover.reproduction.error_measure import model_deviation
from discover.reproduction.paper import (
    M2,
    M3,
    PRINTED_INERTANCE,
    PRINTED_KINEMATIC,
    TABLE_3,
)
from models.checks import InputError
from models.constitutive import foim, ioim_laminar, ioim_turbulent
from models.device import Device
from models.flow import effective_order, womersley_number

_HALF_CENT = 0.005


def _device(number: int) -> Device:
    return Device.preset(f"device-{number}")


def inertance_of_12() -> Claim:
    """Inertance of [12] from geometry, with both transition sections."""
    printed, computed = PRINTED_INERTANCE["device-12"], _device(12).computed_inertance
    return Claim(
        "inertance-12",
        "The inertance of device [12] is 370.38 kg.",
        verdict(holds=abs(computed - printed) <= _HALF_CENT),
        printed, computed, "kg", "Table 1, section 3.2",
        "b = ρ (l + 2 l0) S2/(1 + (h/2 π r4)²) (S1/S2)² from Table 1, to the printed digits.",
    )


def mass_without_transitions() -> Claim:
    """Inertance of [12] with the fluid mass as the paper defines it."""
    computed = replace(_device(12), transition_length=0.0).computed_inertance
    printed = PRINTED_INERTANCE["device-12"]
    return Claim(
        "fluid-mass",
        "The fluid mass in b is ρ l S2, of the helix alone (definition under Eq. 6).",
        verdict(holds=abs(computed - printed) <= _HALF_CENT),
        printed, computed, "kg", "below Eq. 6",
        "b of device [12] with that mass; 370.38 needs both transition sections in it.",
    )


def inertance_of_10() -> Claim:
    """Inertance of [10] from geometry."""
    printed, computed = PRINTED_INERTANCE["device-10"], _device(10).computed_inertance
    return Claim(
        "inertance-10",
        "The inertance of device [10] is 73.82 kg.",
        verdict(holds=abs(computed - printed) <= _HALF_CENT),
        printed, computed, "kg", "Table 1, section 3.2",
        "b from Table 1 by the same formula; the quoted value is taken as measured from here on.",
    )


def worst_table_3(friction_12: float, friction_10: float) -> float:
    """Return the largest distance to Table 3, percentage points, with these frictions in N."""
    worst = 0.0
    for row in TABLE_3:
        device = row.condition.device
        twelve = device.name == "device-12"
        friction = friction_12 if twelve else friction_10
        integer = (ioim_laminar if twelve else ioim_turbulent)(device, friction=friction)
        one = row.identified
        model = foim(device, one.b0, one.order, friction=friction)
        computed = model_deviation(model, integer, row.condition)
        worst = max(worst, abs(computed - row.error_percent))
    return worst


def friction_by_device() -> Claim:
    """Which friction belongs to which device."""
    stated, swapped = worst_table_3(550.0, 400.0), worst_table_3(400.0, 550.0)
    return Claim(
        "friction-order",
        "Friction is 400 N in device [10] and 550 N in device [12], as the sentence has it.",
        verdict(holds=stated <= swapped),
        "[10]: 400 N, [12]: 550 N",
        f"largest distance to Table 3: {stated:.2f} points as stated, {swapped:.2f} swapped",
        "", "section 3.2",
        "Table 3 recomputed with both assignments; the inertances of the same sentence are in the "
        "order [12], [10] too.",
    )


def can_be_built(clearance: float) -> bool:
    """Return whether device [10] can have a piston clearance, m."""
    try:
        replace(_device(10), piston_clearance=clearance)
    except InputError:
        return False
    return True


def clearance() -> Claim:
    """Whether the clearance of [10] is possible, and in which unit."""
    device = _device(10)
    gap = device.cylinder_radius - device.rod_radius
    as_metres = "possible" if can_be_built(0.1) else "impossible"
    film = device.turbulent_coefficients.c3
    return Claim(
        "clearance",
        "The piston of device [10] has a clearance of 0.1 mm.",
        verdict(holds=can_be_built(1e-4)),
        "0.1 mm", f"gap between rod and cylinder {1e3 * gap:g} mm", "", "Table 1",
        "A clearance is smaller than the gap between rod and cylinder. The row's unit is mm where "
        f"the table's other lengths are in m; as 0.1 m it is {as_metres}. The film's force is "
        f"{film:.2g} N s/m times v: it decides nothing.",
    )


def kinematic_viscosities() -> Claim:
    """Whether the text's viscosities are Table 1's."""
    ratio = PRINTED_KINEMATIC["device-10"] / PRINTED_KINEMATIC["device-12"]
    kinematic = [_device(n).fluid.kinematic_viscosity for n in (10, 12)]
    computed = kinematic[0] / kinematic[1]
    return Claim(
        "kinematic-viscosity",
        "The kinematic viscosities are 0.0068 for [10] and 0.027 for [12].",
        verdict(holds=abs(computed / ratio - 1.0) < 0.05),
        ratio, computed, "ratio", "section 3.2",
        "Their ratio, which no unit changes, against μ/ρ of Table 1. 0.027 is Table 1's dynamic "
        f"viscosity; μ/ρ is {kinematic[0]:.3g} and {kinematic[1]:.3g} m²/s.",
    )


def order_with_viscosity() -> Claim:
    """Whether the thinner fluid goes with the larger order."""
    orders = [
        float(effective_order(womersley_number(one.condition.device, one.condition.frequency)))
        for one in (M3, M2)
    ]
    thinner = _device(10).fluid.kinematic_viscosity < _device(12).fluid.kinematic_viscosity
    return Claim(
        "order-with-viscosity",
        "The device with the thinner fluid has the larger order.",
        verdict(holds=thinner and M3.order > M2.order and orders[0] > orders[1]),
        f"[10] {M3.order}, [12] {M2.order}",
        f"[10] {orders[0]:.3f}, [12] {orders[1]:.3f}",
        "order", "section 3.2",
        "Exact laminar pipe flow at the Womersley numbers of the two records, by phase.",
    )


def friction_dominates_at_rest() -> Claim:
    """Friction's share of the force at low and high frequency."""
    device = _device(12)
    c1, c2 = device.laminar_coefficients

    def share(frequency: float, amplitude: float = 0.005) -> float:
        # Friction against the rest's fundamental, both as peaks.
        speed = 2.0 * math.pi * frequency * amplitude
        inertia = device.inertance * 2.0 * math.pi * frequency * speed
        friction = device.coulomb_friction or 0.0
        damping = c2 * speed + c1 * speed**2
        return friction / (friction + math.hypot(inertia, damping))

    low, high = share(0.3), share(15.0)
    return Claim(
        "friction-share",
        "At low frequency friction is most of the force, at high frequency a small part.",
        verdict(holds=low > 0.5 and high < 0.1),
        "most, small", f"{100 * low:.0f} % at 0.3 Hz, {100 * high:.1f} % at 15 Hz", "",
        "section 2.2",
        "f0 over f0 plus the amplitude of all else in Eq. 5, device [12], 5 mm: above one half and "
        "below a tenth.",
    )


CLAIMS = (
    inertance_of_12,
    mass_without_transitions,
    inertance_of_10,
    friction_by_device,
    clearance,
    kinematic_viscosities,
    order_with_viscosity,
    friction_dominates_at_rest,
)
