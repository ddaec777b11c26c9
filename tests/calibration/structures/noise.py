"""Coloured noise of a force channel, drawn from a known spectrum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

Array = np.ndarray
Generator = np.random.Generator
KINDS = ("pink", "drifting", "hum", "resonant", "rising")


@dataclass(frozen=True)
class Noise:
    """Colour of one campaign's noise."""

    kind: str
    """One of `KINDS`."""
    corner: float
    """Hz, where the colour begins or stands."""
    strength: float
    """Of the coloured part against the white one."""

    def shape(self, frequency: Array) -> Array:
        """Return the power spectrum (F,) up to a factor."""
        f = np.maximum(np.abs(frequency), 0.02)
        if self.kind == "pink":
            return 1.0 + self.strength * self.corner / f
        if self.kind == "drifting":
            return 0.1 + self.strength / (1.0 + (f / self.corner) ** 2)
        if self.kind == "hum":
            peaks = [np.exp(-0.5 * ((f - k * 50.0) / 0.8) ** 2) for k in (1.0, 3.0)]
            return 1.0 + self.strength * self.corner * (peaks[0] + 0.4 * peaks[1])
        if self.kind == "resonant":
            s = f / (10.0 * self.corner)
            return 0.3 + self.strength / ((1.0 - s**2) ** 2 + (0.2 * s) ** 2)
        return 0.2 + self.strength * (f / self.corner) ** 2 / (1.0 + (f / (8 * self.corner)) ** 4)

    def power(self, frequency: Array, sampling: float) -> Array:
        """Return the spectral density (F,) of unit variance: 1 at every frequency if white."""
        every = np.linspace(0.0, 0.5 * sampling, 4097)[1:]
        return self.shape(frequency) / float(np.mean(self.shape(every)))

    def draw(self, size: int, sampling: float, rng: Generator) -> Array:
        """Return noise (N,) of unit rms over its samples."""
        length = fft.next_fast_len(max(2 * size, int(4.0 * sampling)), real=True)
        spectrum = np.asarray(fft.rfft(rng.standard_normal(length)))
        spectrum *= np.sqrt(self.power(fft.rfftfreq(length, 1.0 / sampling), sampling))
        values = np.asarray(fft.irfft(spectrum, n=length))[:size]
        return values / float(np.sqrt(np.mean(values**2)))


def draw_noise(rng: Generator) -> Noise:
    """Draw a colour."""
    return Noise(str(rng.choice(KINDS)), rng.uniform(2.0, 8.0), rng.uniform(0.3, 2.0))
