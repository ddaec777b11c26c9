"""What the samples of a sine test tell, which stands for them wherever it goes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit.cycle_sums import CycleSums
from discover.motion_fit.noise_spectrum import NoiseSpectrum
from models.checks import Array

Lines = NDArray[np.complex128]


@dataclass(frozen=True)
class SineFound:
    """Motion, lines and sums of all usable samples; see `Observation` and `Window`."""

    usable: slice
    """Samples of the record that are used."""
    frequency: float
    """Hz."""
    displacement: Lines
    """(H + 1,) m: mean and phasors of the motion."""
    force: Lines
    """(L,) N: lines of the measured force, their phases counted from the motion's own."""
    variance: Array
    """(L,) N^2: noise variance of the real (and of the imaginary) part of each line."""
    rest: float
    """N^2: mean square of the measured force that is in none of the lines."""
    displacement_noise: float
    """m, root mean square."""
    motion_error: Array
    """(H + 1,) m: standard error of each phasor's real (and imaginary) part; none where it is not
    measured."""
    force_noise: float
    """N, root mean square."""
    noise: NoiseSpectrum | None
    """Of the force; None where it was not sampled uniformly."""
    phase_fitted: bool
    """True where the record has no displacement and the motion's phase was fitted."""
    drift: float
    """N/s: straight trend of the force that the lines exclude."""
    sums: CycleSums | None
    """Of all usable samples; None where they are few."""
