"""Rough design: the geometry and fluid with the lowest critical frequency under bounds."""

from models.design.optimise import minimise_critical_frequency
from models.design.prices import ActiveBound, elasticities
from models.design.problem import FLUIDS, DesignBounds, Duty, parasitic_damping, peak_pressure
from models.design.result import Conflict, DesignPoint, DesignResult

__all__ = [
    "FLUIDS",
    "ActiveBound",
    "Conflict",
    "DesignBounds",
    "DesignPoint",
    "DesignResult",
    "Duty",
    "elasticities",
    "minimise_critical_frequency",
    "parasitic_damping",
    "peak_pressure",
]
