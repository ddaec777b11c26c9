"""The paper's tables beside what its formulas give."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.reproduction.error_measure import model_deviation
from discover.reproduction.paper import (
    CRITERION,
    PRINTED_INERTANCE,
    TABLE_2,
    TABLE_3,
    PrintedTable3,
    integer_order_model,
)
from models.device import Device
from models.flow import critical_frequency

_GRID = 21


@dataclass(frozen=True)
class DeviceRow:
    """Table 1 of one device with what follows from it."""

    device: Device
    """As in Table 1."""
    printed_inertance: float
    """kg."""

    def to_dict(self) -> dict[str, Any]:
        """Return the device, its derived quantities and both inertances."""
        d = self.device
        laminar, turbulent = d.laminar_coefficients, d.turbulent_coefficients
        return {
            "device": d.to_dict(),
            "piston_area": d.annulus_area,
            "channel_area": d.channel_area,
            "channel_length": d.channel_length,
            "fluid_mass": d.fluid_mass,
            "kinematic_viscosity": d.fluid.kinematic_viscosity,
            "inertance_printed": self.printed_inertance,
            "inertance_computed": d.computed_inertance,
            "laminar": {"c1": laminar.c1, "c2": laminar.c2},
            "turbulent": {"c1": turbulent.c1, "c2": turbulent.c2, "c3": turbulent.c3},
        }


def table_1() -> tuple[DeviceRow, ...]:
    """Return the devices with their derived quantities."""
    return tuple(
        DeviceRow(Device.preset(name), value) for name, value in PRINTED_INERTANCE.items()
    )


@dataclass(frozen=True)
class ExperimentRow:
    """A row of Table 2, as quoted: the measurements are not public."""

    label: str
    """Record and model."""
    fractional_printed: float
    """Percent."""
    integer_printed: float
    """Percent."""
    between_models: float
    """Percent: e_d of the two models against each other, computed."""

    @property
    def consistent(self) -> bool:
        """Whether three errors can be distances between three curves (triangle inequality)."""
        a, b, c = self.fractional_printed, self.integer_printed, self.between_models
        return abs(a - b) <= c <= a + b

    def to_dict(self) -> dict[str, Any]:
        """Return the row."""
        return {
            "record": self.label,
            "fractional_printed_percent": self.fractional_printed,
            "integer_printed_percent": self.integer_printed,
            "between_models_computed_percent": self.between_models,
            "recomputable": False,
            "consistent": self.consistent,
        }


def table_2() -> tuple[ExperimentRow, ...]:
    """Return Table 2 as quoted, with what the two models differ by."""
    rows = []
    for row in TABLE_2:
        condition = row.identified.condition
        integer = integer_order_model(condition.device)
        between = model_deviation(row.identified.model(), integer, condition)
        label = f"{condition.label} ({row.identified.name})"
        rows.append(ExperimentRow(label, row.fractional, row.integer, between))
    return tuple(rows)


@dataclass(frozen=True)
class ComparisonRow:
    """A row of Table 3 recomputed."""

    printed: PrintedTable3
    """As printed."""
    computed: float
    """Percent, at the printed parameters."""
    lowest: float
    """Percent: least within the rounding of b0 and the order."""
    highest: float
    """Percent: most within that rounding."""
    by_mean: float
    """Percent: with the mean magnitude as amplitude, as the paper's words say."""

    @property
    def distance(self) -> float:
        """Percentage points from the printed value to the spread, 0 inside it."""
        value = self.printed.error_percent
        return max(self.lowest - value, value - self.highest, 0.0)

    def to_dict(self) -> dict[str, Any]:
        """Return the row."""
        return {
            "id": self.printed.id,
            "record": self.printed.condition.label,
            "model": self.printed.identified.name,
            "printed_percent": self.printed.error_percent,
            "computed_percent": self.computed,
            "spread_percent": [self.lowest, self.highest],
            "distance_points": self.distance,
            "by_mean_amplitude_percent": self.by_mean,
        }


def table_3_row(printed: PrintedTable3) -> ComparisonRow:
    """Return one row recomputed, with the spread that the printed rounding allows."""
    reference = integer_order_model(printed.condition.device)
    shifts = np.linspace(-1.0, 1.0, _GRID)
    spread = [
        model_deviation(
            printed.identified.model(b0_shift=float(p), order_shift=float(q)),
            reference,
            printed.condition,
        )
        for p in shifts[:: _GRID // 2]
        for q in shifts
    ]
    model = printed.identified.model()
    return ComparisonRow(
        printed,
        model_deviation(model, reference, printed.condition),
        min(spread),
        max(spread),
        model_deviation(model, reference, printed.condition, amplitude="mean"),
    )


def table_3() -> tuple[ComparisonRow, ...]:
    """Return Table 3 recomputed."""
    return tuple(table_3_row(row) for row in TABLE_3)


@dataclass(frozen=True)
class BoundaryRow:
    """Critical frequency of a device at one amplitude (Eq. 16)."""

    device_name: str
    """Preset."""
    amplitude: float
    """m."""
    paper: float
    """Hz, by the paper's Dean number."""
    standard: float
    """Hz, by the standard one."""

    def to_dict(self) -> dict[str, Any]:
        """Return the row."""
        return {
            "device": self.device_name,
            "amplitude_m": self.amplitude,
            "critical_frequency_hz": {"paper": self.paper, "standard": self.standard},
        }


def critical_frequencies() -> tuple[BoundaryRow, ...]:
    """Return the critical frequencies at the amplitudes of the paper's records."""
    cases = [("device-12", a) for a in (0.005, 0.01, 0.02)]
    cases += [("device-10", a) for a in (0.005, 0.01, 0.0175)]
    rows = []
    for name, amplitude in cases:
        values = [
            float(critical_frequency(
                Device.preset(name), amplitude, dean=CRITERION, convention=convention
            ))
            for convention in ("paper", "standard")
        ]
        rows.append(BoundaryRow(name, amplitude, *values))
    return tuple(rows)
