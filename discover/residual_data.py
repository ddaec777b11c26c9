"""What one model leaves of a record, for pictures: over frequency, phase and lag."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array


@dataclass(frozen=True)
class Response:
    """One model beside one record: what it leaves, and the dynamic stiffness of both."""

    frequency: Array
    """(k,) Hz, rising: of the spectra."""
    force: Array
    """(k,) N/sqrt(Hz), one-sided: the measured force."""
    left: Array
    """(k,) N/sqrt(Hz): measured less model."""
    noise: Array
    """(k,) N/sqrt(Hz): the noise of the measured force; empty where its spectrum isn't known."""
    stiffness_frequency: Array
    """(m,) Hz: a sine test's own frequency, else those that the motion holds."""
    stiffness: NDArray[np.complex128]
    """(m,) N/m: measured force over displacement."""
    model_stiffness: NDArray[np.complex128]
    """(m,) N/m: the model's force over displacement."""
    coherence: Array
    """(m,) of measured force and displacement, in [0, 1]; empty for a sine test."""
    phase: Array
    """(p,) of the cycle, in turns from the greatest displacement."""
    over_phase: Array
    """(p,) N: mean of what is left, at that phase; nan where the motion never is."""
    lag: Array
    """(l,) s, from the first sample on."""
    correlation: Array
    """(l,) of what is left with itself that much later, in [-1, 1]."""
    correlation_limit: float
    """Within which 95 % of white noise's correlations lie."""
    gain_percent: float
    """By how much the measured force is greater than the model's, along the model's."""
    error_over_noise: float | None
    """Root mean square of what is left over that of the noise; None where noise isn't known."""

    @property
    def outside_percent(self) -> float:
        """Share of the correlations outside the limit; 5 expected of white noise."""
        if not self.correlation.size:
            return 0.0
        return 100.0 * float(np.mean(np.abs(self.correlation) > self.correlation_limit))
