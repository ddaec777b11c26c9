"""Where a device's order comes from: laminar pipe flow beside the identified orders."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.reproduction.paper import IDENTIFIED, Identified, integer_order_model
from models.checks import Array
from models.constitutive import ForceModel
from models.equivalents import Equivalents, harmonic_equivalents, order_by_phase
from models.flow import channel_impedance, effective_order, womersley_number


@dataclass(frozen=True)
class OrderCurve:
    """Order of exact laminar pipe flow over the Womersley number."""

    womersley: Array
    """(N,)."""
    by_phase: Array
    """(N,) order whose derivative has the force's phase."""
    by_amplitude: Array
    """(N,) slope of ln|force| over ln frequency."""


@dataclass(frozen=True)
class OrderPoint:
    """An identified order beside what flow in that device, at that frequency, would have."""

    identified: Identified
    """The paper's model."""
    womersley: float
    """Womersley number of the channel at the record's frequency."""
    flow_by_phase: float
    """Order of exact laminar flow, by phase."""
    flow_by_amplitude: float
    """The same by amplitude."""
    integer_model: float
    """Order by phase of the integer-order model without friction, at the record's amplitude."""
    product_over_flow: float
    """The model's b(1 + b0) omega^order over |force|/displacement of exact laminar flow."""

    def to_dict(self) -> dict[str, Any]:
        """Return the row."""
        return {
            "model": self.identified.name,
            "record": self.identified.condition.label,
            "womersley": self.womersley,
            "identified_order": self.identified.order,
            "laminar_flow_order": {
                "phase": self.flow_by_phase, "amplitude": self.flow_by_amplitude
            },
            "integer_model_order": self.integer_model,
            "amplitude_over_laminar_flow": self.product_over_flow,
        }


def order_curve() -> OrderCurve:
    """Return the mapping from Womersley number to order, from 1 (viscous) to 2 (inertial)."""
    womersley = np.geomspace(0.1, 300.0, 301)
    return OrderCurve(
        womersley,
        effective_order(womersley, by="phase"),
        effective_order(womersley, by="amplitude"),
    )


def order_points() -> tuple[OrderPoint, ...]:
    """Return the paper's models beside the flow of their records."""
    return tuple(_point(one) for one in IDENTIFIED)


def _point(one: Identified) -> OrderPoint:
    condition, device = one.condition, one.condition.device
    omega = 2.0 * math.pi * condition.frequency
    womersley = float(womersley_number(device, condition.frequency))
    integer = integer_order_model(device)
    flow_terms = tuple(t for t in integer.terms if t.id != "coulomb-friction")
    equivalents: Equivalents = harmonic_equivalents(
        ForceModel(flow_terms), condition.amplitude, omega
    )
    flow = abs(complex(channel_impedance(device, omega))) * omega
    return OrderPoint(
        identified=one,
        womersley=womersley,
        flow_by_phase=float(effective_order(womersley, by="phase")),
        flow_by_amplitude=float(effective_order(womersley, by="amplitude")),
        integer_model=float(order_by_phase(equivalents, omega)),
        product_over_flow=device.inertance * (1.0 + one.b0) * omega**one.order / flow,
    )
