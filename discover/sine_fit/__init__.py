"""Least-squares fit of a sine record: frequency, offset, trend, harmonics; steps of several."""

from discover.sine_fit.columns import columns_of
from discover.sine_fit.design import ComplexArray, harmonic_design, harmonic_series
from discover.sine_fit.fit import FEW_CYCLES, fit_sine, strongest_line
from discover.sine_fit.harmonic_sums import Harmonics
from discover.sine_fit.local import local_phasors
from discover.sine_fit.long_fit import LongFit, fit_long_sine
from discover.sine_fit.moments import Moments, moments
from discover.sine_fit.solution import SineFit
from discover.sine_fit.steps import sine_steps

__all__ = [
    "FEW_CYCLES",
    "ComplexArray",
    "Harmonics",
    "LongFit",
    "Moments",
    "SineFit",
    "columns_of",
    "fit_long_sine",
    "fit_sine",
    "harmonic_design",
    "harmonic_series",
    "local_phasors",
    "moments",
    "sine_steps",
    "strongest_line",
]
