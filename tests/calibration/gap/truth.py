"""What a noise-free refit leaves, with nothing of the search that is tested.

Columns of the baseline are closed forms of the exact motion; the noise's spectrum is averaged from
the very generator that made it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import fft

from models.checks import Array
from models.rig import Chain, RigRecord
from models.rig import measure as measuring_chain
from models.rig.seal import Seal
from tests.calibration.gap.case import NOISE, Case, measure, seal_of

_HARMONICS = 6
_DRAWS = 100


def nats_left(case: Case, terms: Sequence[str] = ()) -> float:
    """Return half the chi-square, against the noise, of the change that a baseline leaves.

    Parameters
    ----------
    case : Case
        What is hidden.
    terms : sequence of str
        Refitted to the noise-free change of force; none where the device's own force is known.

    Notes
    -----
    The device's own force is in the span of the rig's own terms, so only the change is fitted: the
    rig's interpolation at friction's reversals, alike in both, drops out.
    """
    records = measure(case)
    plain = measure(Case(case.kind, (), 0.0, case.seed))
    weights = [1.0 / np.sqrt(noise_power(case, r)) for r in records]
    left = np.concatenate(
        [
            whitened(r.true_force - p.true_force, w)
            for r, p, w in zip(records, plain, weights, strict=True)
        ]
    )
    if terms:
        seal = seal_of(case)
        columns = np.concatenate(
            [
                np.stack([whitened(column, w) for column in _columns(r, terms, seal)], axis=1)
                for r, w in zip(records, weights, strict=True)
            ]
        )
        columns /= np.linalg.norm(columns, axis=0)
        left = left - columns @ np.linalg.lstsq(columns, left, rcond=1e-12)[0]
    return 0.5 * float(left @ left)


def _columns(record: RigRecord, terms: Sequence[str], seal: Seal) -> list[Array]:
    """Return the terms at the exact motion; friction with its derivative to its reversal speed.

    Friction is the device's own, whatever its law: a baseline that has the right curve.
    """
    velocity, acceleration = _motion(record)
    ratio = velocity / seal.half_speed
    known = {
        "inertia": [acceleration],
        "viscous-damping": [velocity],
        "quadratic-damping": [velocity * np.abs(velocity)],
        "coulomb-friction": [
            seal.reversal.share(ratio),
            ratio * seal.reversal.share_slope(ratio),
        ],
    }
    return [column for term in terms for column in known[term]]


def _motion(record: RigRecord) -> tuple[Array, Array]:
    """Return velocity and acceleration of a sine test from its exact displacement."""
    if record.frequency is None:
        raise ValueError(f"{record.file} is no sine test")
    rates = 2j * np.pi * record.frequency * np.arange(1, _HARMONICS + 1)
    waves = np.exp(np.outer(record.time, rates))
    design = np.column_stack([np.ones(record.time.size), waves.real, -waves.imag])
    found = np.linalg.lstsq(design, record.true_displacement, rcond=None)[0]
    phasors = found[1 : _HARMONICS + 1] + 1j * found[_HARMONICS + 1 :]
    return (waves @ (phasors * rates)).real, (waves @ (phasors * rates**2)).real


def noise_power(case: Case, record: RigRecord) -> Array:
    """Return the noise's expected power at each frequency of the record's spectrum, N^2."""
    size, force = record.time.size, record.true_force
    rng = np.random.default_rng([53, case.seed])
    total = np.zeros(size // 2 + 1)
    quiet = np.zeros(size)
    rms = float(np.sqrt(np.mean(force**2)))
    sampling = round(1.0 / (record.time[1] - record.time[0]))
    for _ in range(_DRAWS):
        if case.kind in NOISE:
            noise = NOISE[case.kind][1](force, sampling, case.seed, rng)
        else:
            _, noise = measuring_chain(
                record.time, quiet, quiet, Chain(bits=0), rng, reference=rms, peak=1.0
            )
        total += np.abs(fft.rfft(noise, norm="ortho")) ** 2
    # Of the mean of n draws of power, 1/mean is n/(n - 1) too great on average.
    return total / (_DRAWS - 1)


def whitened(values: Array, weight: Array) -> Array:
    """Return real components whose noise has unit variance."""
    spectrum = np.asarray(fft.rfft(values, norm="ortho")) * weight
    double = np.full(weight.size, np.sqrt(2.0))
    double[0] = 1.0
    if values.size % 2 == 0:
        double[-1] = 1.0
    return np.concatenate([spectrum.real * double, spectrum.imag * double])
