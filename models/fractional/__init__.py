"""Fractional operators for records: from the first sample on, in steady state, band-limited."""

from models.fractional.band_limit import (
    band_limited,
    band_limited_derivative,
    low_pass,
    noise_cutoff,
)
from models.fractional.dispatch import derivative, fractional_derivative
from models.fractional.exponential_sum import exponential_sum
from models.fractional.result import FractionalDerivative
from models.fractional.spectral import harmonic_factors, spectral_derivative
from models.fractional.streaming import stream_derivative

__all__ = [
    "FractionalDerivative",
    "band_limited",
    "band_limited_derivative",
    "derivative",
    "exponential_sum",
    "fractional_derivative",
    "harmonic_factors",
    "low_pass",
    "noise_cutoff",
    "spectral_derivative",
    "stream_derivative",
]
