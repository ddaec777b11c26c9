"""Simulation in time of structures with devices in them."""

from models.simulation.load import Load, no_load, sampled_load, sine_load, sweep_load
from models.simulation.response import EnergyBalance, ErrorEstimate, PeriodicPast, Response
from models.simulation.simulate import simulate

__all__ = [
    "EnergyBalance",
    "ErrorEstimate",
    "Load",
    "PeriodicPast",
    "Response",
    "no_load",
    "sampled_load",
    "simulate",
    "sine_load",
    "sweep_load",
]
