"""What a fractional derivative is made with, beside its values."""

from __future__ import annotations

from dataclasses import dataclass

from models.fractional.orders import Array

KINDS = ("caputo", "riemann-liouville", "grunwald-letnikov", "weyl")
"""Operators: from the first sample on without or with the initial values' share, or from minus
infinity."""


@dataclass(frozen=True)
class FractionalDerivative:
    """A derivative with the operator, the scheme and an estimate of its error."""

    values: Array
    """(..., N) or (K, ..., N), units of x per second to the order."""
    operator: str
    """One of `KINDS`: what was computed."""
    scheme: str
    """How: "gl", "l1", "bdf2" to "bdf6", "spectral", "harmonics", "band-limited", or
    "band-limited+bdf..." where a causal scheme followed the low-pass."""
    error: Array
    """() or (K,): expected rms error over rms value, truncation and noise together."""
    stride: int = 1
    """Samples between the points of the backward differences, for "bdf2" to "bdf6"."""
    cutoff: float | None = None
    """Hz, of the low-pass, where one was used."""
