"""Fractional operators for records: from the first sample on, in steady state, band-limited."""

from models.fractional.band_limit import band_limited_derivative, low_pass, noise_cutoff
from models.fractional.dispatch import derivative
from models.fractional.exponential_sum import exponential_sum
from models.fractional.spectral import harmonic_factors, spectral_derivative

__all__ = [
    "band_limited_derivative",
    "derivative",
    "exponential_sum",
    "harmonic_factors",
    "low_pass",
    "noise_cutoff",
    "spectral_derivative",
]
