"""Flow in the helical channel: dimensionless numbers, friction, oscillatory impedance."""

from models.flow.dimensionless import (
    CONVENTIONS,
    critical_frequency,
    critical_speed,
    dean,
    dean_per_speed,
    reynolds,
)
from models.flow.friction import (
    channel_force,
    friction_times_reynolds,
    transition_reynolds,
)
from models.flow.womersley import (
    channel_impedance,
    effective_order,
    excess_impedance,
    normalised_impedance,
    wall_modes,
    womersley_number,
)

__all__ = [
    "CONVENTIONS",
    "channel_force",
    "channel_impedance",
    "critical_frequency",
    "critical_speed",
    "dean",
    "dean_per_speed",
    "effective_order",
    "excess_impedance",
    "friction_times_reynolds",
    "normalised_impedance",
    "reynolds",
    "transition_reynolds",
    "wall_modes",
    "womersley_number",
]
