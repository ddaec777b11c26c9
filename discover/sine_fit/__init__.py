"""Least-squares fit of a sine record: frequency, offset, trend and harmonics."""

from discover.sine_fit.design import harmonic_design, harmonic_series
from discover.sine_fit.fit import fit_sine
from discover.sine_fit.long_fit import LongFit, fit_long_sine
from discover.sine_fit.solution import SineFit

__all__ = ["LongFit", "SineFit", "fit_long_sine", "fit_sine", "harmonic_design", "harmonic_series"]
