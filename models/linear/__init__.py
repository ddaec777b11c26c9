"""Linear analysis: transfer functions, eigenvalues, rational approximations of s^order."""

from models.linear.dynamic import dynamic_stiffness, linear_terms, transfer_function
from models.linear.eigen import Modes, eigenvalues, modes
from models.linear.oustaloup import RationalPower, oustaloup
from models.linear.state_space import RationalStructure, rational_structure

__all__ = [
    "Modes",
    "RationalPower",
    "RationalStructure",
    "dynamic_stiffness",
    "eigenvalues",
    "linear_terms",
    "modes",
    "oustaloup",
    "rational_structure",
    "transfer_function",
]
