"""The measuring chain: noise, hum, resolution, delay and broken cycles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import signal
from scipy.interpolate import CubicSpline

from models.checks import Array, InputError, finite_array, number, one_of


@dataclass(frozen=True)
class Chain:
    """What happens to force and displacement on their way into a file.

    Examples
    --------
    >>> Chain.ideal().noise
    0.0
    """

    noise: float = 0.01
    """Force noise, rms over the reference force."""
    low_frequency: float = 0.5
    """Share of the noise's variance at low frequency (0: white), first-order coloured."""
    correlation_time: float = 0.05
    """Of the low-frequency noise, s."""
    hum: float = 0.001
    """Mains hum in the force, amplitude over the reference force; a third of it at 3 x mains."""
    mains: float = 50.0
    """Hz."""
    displacement_noise: float = 1e-6
    """White, rms, m."""
    bits: int = 16
    """Resolution of both channels; 0 for none."""
    force_range: float | None = None
    """Full scale, N; None takes 1.25 times the campaign's (or record's) peak."""
    displacement_range: float = 0.025
    """Full scale, m."""
    delay: float = 0.0
    """Of the force behind the displacement, s."""
    broken_cycles: float = 0.0
    """Share of a sine test's cycles in which the force signal breaks (held value or spikes)."""
    reference: str = "record"
    """What noise and hum are fractions of: the rms force of each "record" or of the "campaign"."""

    def __post_init__(self) -> None:
        """Refuse impossible chains."""
        for key in ("noise", "hum", "displacement_noise", "delay"):
            number(key, getattr(self, key), at_least=0.0, where="measuring chain")
        for key in ("low_frequency", "broken_cycles"):
            number(key, getattr(self, key), at_least=0.0, at_most=1.0, where="measuring chain")
        for key in ("correlation_time", "mains", "displacement_range"):
            number(key, getattr(self, key), above=0.0, where="measuring chain")
        number("bits", self.bits, at_least=0, at_most=32, where="measuring chain")
        if self.force_range is not None:
            number("force_range", self.force_range, above=0.0, where="measuring chain")
        one_of("reference", self.reference, ("record", "campaign"), where="measuring chain")

    @classmethod
    def ideal(cls) -> Chain:
        """Return a chain that changes nothing."""
        return cls(noise=0.0, hum=0.0, displacement_noise=0.0, bits=0)


def measure(
    time: Array,
    displacement: Array,
    force: Array,
    chain: Chain,
    rng: np.random.Generator,
    *,
    frequency: float | None = None,
    reference: float | None = None,
    peak: float | None = None,
) -> tuple[Array, Array]:
    """Return displacement and force as a measuring chain writes them.

    Parameters
    ----------
    time, displacement, force : array, shape (N,)
        s, m, N: uniform in time, exact.
    chain : Chain
        What it does.
    rng : Generator
        The only source of randomness.
    frequency : float, optional
        Of a sine test, Hz: only such a record has cycles that can break.
    reference : float, optional
        rms force that noise and hum are fractions of; this record's where not given.
    peak : float, optional
        Greatest force of the campaign, N: sets full scale; this record's where not given.

    Returns
    -------
    displacement, force : array, shape (N,)

    Notes
    -----
    A delay shifts the force by a cubic spline; before the first sample the spline is continued, so
    a delay over one sampling interval needs samples ahead of the record (`run` makes them).

    Raises
    ------
    InputError
        For arrays of unequal length, non-finite values or non-uniform time.
    """
    t = finite_array("time", time, ndim=1, min_size=4)
    x = finite_array("displacement", displacement, ndim=1)
    f = finite_array("force", force, ndim=1)
    for name, values in (("displacement", x), ("force", f)):
        if values.shape != t.shape:
            raise InputError(name, expected=f"of shape {t.shape}", found=f"{values.shape}")
    steps = np.diff(t)
    step = float((t[-1] - t[0]) / (t.size - 1))
    if not step > 0.0 or np.max(np.abs(steps - step)) > 1e-3 * step:
        raise InputError("time", expected="uniform and increasing", where="measuring chain")
    scale = math.sqrt(float(np.mean(f**2))) if reference is None else reference
    full = chain.force_range
    if full is None:
        full = 1.25 * (float(np.max(np.abs(f))) if peak is None else peak)
    if chain.delay > 0.0:
        f = np.asarray(CubicSpline(t, f)(t - chain.delay))
    f = f + _noise(t.size, step, chain, rng) * scale + _hum(t, chain, rng) * scale
    x = x + chain.displacement_noise * rng.standard_normal(t.size)
    if frequency is not None and chain.broken_cycles > 0.0:
        f = _broken(t, f, frequency, chain.broken_cycles, full, rng)
    return _quantise(x, chain.displacement_range, chain.bits), _quantise(f, full, chain.bits)


def _noise(size: int, step: float, chain: Chain, rng: np.random.Generator) -> Array:
    """Return white and first-order coloured noise of the chain's rms."""
    white = rng.standard_normal(size)
    keep = math.exp(-step / chain.correlation_time)
    drive = rng.standard_normal(size) * math.sqrt(1.0 - keep**2)
    start = rng.standard_normal()
    slow, _ = signal.lfilter([1.0], [1.0, -keep], drive, zi=np.array([keep * start]))
    share = chain.low_frequency
    return np.asarray(chain.noise * (math.sqrt(1.0 - share) * white + math.sqrt(share) * slow))


def _hum(time: Array, chain: Chain, rng: np.random.Generator) -> Array:
    """Return mains hum with its third harmonic, as a fraction of the reference."""
    first, third = rng.uniform(0.0, 2.0 * math.pi, 2)
    angle = 2.0 * math.pi * chain.mains * time
    return np.asarray(chain.hum * (np.sin(angle + first) + np.sin(3.0 * angle + third) / 3.0))


def _broken(
    time: Array,
    force: Array,
    frequency: float,
    share: float,
    full: float,
    rng: np.random.Generator,
) -> Array:
    """Return the force with some whole cycles in which the signal holds or spikes."""
    result = force.copy()
    cycle = np.floor((time - time[0]) * frequency).astype(np.int64)
    for number_ in range(int(cycle[-1]) + 1):
        if rng.random() >= share:
            continue
        inside = np.flatnonzero(cycle == number_)
        if rng.random() < 0.5:
            begin = int(rng.integers(inside.size))
            held = inside[begin : begin + max(inside.size // 5, 1)]
            result[held] = result[held[0]]
        else:
            hit = rng.choice(inside, size=max(inside.size // 50, 1), replace=False)
            result[hit] += full * rng.uniform(-0.5, 0.5, hit.size)
    return result


def _quantise(values: Array, full: float, bits: int) -> Array:
    """Return the values rounded to the converter's steps and limited to its range."""
    if bits == 0:
        return values
    step = 2.0 * full / 2.0**bits
    return np.asarray(np.clip(np.round(values / step) * step, -full, full))
