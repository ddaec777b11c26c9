"""Steady states of structures with nonlinear, rubbing and fractional devices under a sine."""

from models.harmonic_balance.branch import Branch, Fold, frequency_response
from models.harmonic_balance.problem import SineDrive
from models.harmonic_balance.stability import unstable_exponents
from models.harmonic_balance.steady_state import SteadyState, steady_state

__all__ = [
    "Branch",
    "Fold",
    "SineDrive",
    "SteadyState",
    "frequency_response",
    "steady_state",
    "unstable_exponents",
]
