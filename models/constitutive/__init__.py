"""Constitutive models: a sum of terms with coefficients, simulated and stored."""

from models.constitutive.model import WHOLE_ORDERS, FittedTerm, ForceModel
from models.constitutive.paper import foim, ioim_laminar, ioim_turbulent, sfoim
from models.constitutive.segmented import COORDINATES, SCHEMA, Band, SegmentedModel

__all__ = [
    "COORDINATES",
    "SCHEMA",
    "WHOLE_ORDERS",
    "Band",
    "FittedTerm",
    "ForceModel",
    "SegmentedModel",
    "foim",
    "ioim_laminar",
    "ioim_turbulent",
    "sfoim",
]
