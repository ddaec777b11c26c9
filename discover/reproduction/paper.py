"""What Chen & Chen, *Materials* 2025, 18(11), 2556 prints: parameters, tables, records."""

from __future__ import annotations

from dataclasses import dataclass

from models.constitutive import ForceModel, foim, ioim_laminar, ioim_turbulent
from models.device import Device

CITATION = (
    "Y. Chen, N. Chen, A New Fractional-Order Constitutive Model and Rough Design Method for "
    "Fluid-Type Inerters, Materials 2025, 18(11), 2556, https://doi.org/10.3390/ma18112556"
)

CRITERION = 100.0
"""The Dean number that the paper takes as the boundary."""

OVERLAP = 5.0
"""Percent of the peak: two curves that differ by less are said to overlap."""


@dataclass(frozen=True)
class Condition:
    """A sine test of one device."""

    device_name: str
    """Preset."""
    frequency: float
    """Hz."""
    amplitude: float
    """m."""

    @property
    def device(self) -> Device:
        """The device."""
        return Device.preset(self.device_name)

    @property
    def label(self) -> str:
        """As in "device [12], 3 Hz, 10 mm"."""
        number = self.device_name.removeprefix("device-")
        return f"device [{number}], {self.frequency:g} Hz, {1e3 * self.amplitude:g} mm"


@dataclass(frozen=True)
class Identified:
    """A fractional model as the paper identified it.

    Examples
    --------
    >>> M2.model().terms[0].shape["order"]
    1.89
    """

    name: str
    """The paper's name (M3 is ours; the paper gives it none)."""
    condition: Condition
    """The record it was identified from."""
    b0: float
    """Correction of the inertance."""
    order: float
    """Order of the derivative."""
    b0_rounding: float
    """Half a unit of b0's last printed digit."""
    order_rounding: float
    """Half a unit of the order's last printed digit."""

    def model(self, *, b0_shift: float = 0.0, order_shift: float = 0.0) -> ForceModel:
        """Return the model, its parameters shifted by parts of their rounding (-1 to 1)."""
        return foim(
            self.condition.device,
            self.b0 + b0_shift * self.b0_rounding,
            self.order + order_shift * self.order_rounding,
        )


M1 = Identified("M1", Condition("device-12", 0.5, 0.02), 18.25, 0.48, 0.005, 0.005)
M2 = Identified("M2", Condition("device-12", 12.0, 0.005), 0.57, 1.89, 0.005, 0.005)
M3 = Identified("M3", Condition("device-10", 3.0, 0.0175), 0.087, 1.98, 0.0005, 0.005)
IDENTIFIED = (M1, M2, M3)


def integer_order_model(device: Device) -> ForceModel:
    """Return the integer-order model that the paper compares with: Eq. 5 for [12], 6 for [10]."""
    return ioim_turbulent(device) if device.name == "device-10" else ioim_laminar(device)


@dataclass(frozen=True)
class PrintedTable2:
    """A row of Table 2: errors against experiments, percent."""

    identified: Identified
    fractional: float
    integer: float


TABLE_2 = (
    PrintedTable2(M1, 23.99, 31.95),
    PrintedTable2(M2, 19.05, 21.2),
    PrintedTable2(M3, 23.39, 23.44),
)


@dataclass(frozen=True)
class PrintedTable3:
    """A row of Table 3: error of the fractional against the integer-order model, percent."""

    identified: Identified
    condition: Condition
    error_percent: float
    id: str


TABLE_3 = (
    PrintedTable3(M2, Condition("device-12", 3.0, 0.01), 19.1, "table-3-12-3hz"),
    PrintedTable3(M2, Condition("device-12", 8.0, 0.005), 2.6, "table-3-12-8hz"),
    PrintedTable3(M2, Condition("device-12", 15.0, 0.005), 5.44, "table-3-12-15hz"),
    PrintedTable3(M3, Condition("device-10", 0.5, 0.015), 0.2, "table-3-10-0.5hz"),
    PrintedTable3(M3, Condition("device-10", 8.0, 0.005), 2.12, "table-3-10-8hz"),
    PrintedTable3(M3, Condition("device-10", 12.0, 0.005), 1.85, "table-3-10-12hz"),
)

PRINTED_INERTANCE = {"device-12": 370.38, "device-10": 73.82}
"""kg, in the order that the geometry confirms for [12]."""
PRINTED_KINEMATIC = {"device-12": 0.027, "device-10": 0.0068}
"""The text's "kinematic viscosities", without a unit."""
