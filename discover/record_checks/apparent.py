"""Apparent mass and damping of a record: what its force does to the motion, before any model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.record_checks.by_parts import windowed_derivatives
from discover.record_kind import RecordKind
from discover.records import Record
from discover.sine_fit import fit_sine
from models.checks import Array


@dataclass(frozen=True)
class Apparent:
    """Least-squares mass and damping, and how much of the force each carries."""

    mass: float
    """kg, of the force in phase with the acceleration."""
    damping: float
    """N s/m, of the force in phase with the velocity; negative where the device gives energy."""
    mass_share: float
    """Root mean square of ``mass * a`` over the force's."""
    damping_share: float
    """Root mean square of ``damping * v`` over the force's."""


def apparent(record: Record, kind: RecordKind) -> Apparent | None:
    """Return a record's apparent mass and damping; None where it has no displacement.

    A sine test gives both from its fundamental. Other records are fitted by mass, damping,
    stiffness and the window's low end, integrated by parts against a window that vanishes at
    both ends, so that nothing is differentiated but the window.

    Examples
    --------
    >>> from discover.record_kind import classify
    >>> t = np.arange(2000) / 500.0
    >>> x = 0.01 * np.sin(10.0 * t)
    >>> record = Record("r", t, 70.0 * np.cos(10.0 * t) - 200.0 * np.sin(10.0 * t), x)
    >>> found = apparent(record, classify(record))
    >>> round(found.mass, 6), round(found.damping, 6)
    (200.0, 700.0)
    """
    if record.displacement is None:
        return None
    force, time = record.force[kind.usable], record.time[kind.usable]
    if kind.sine is not None:
        omega = 2.0 * np.pi * kind.sine.frequency
        fit = fit_sine(time, force, frequency=kind.sine.frequency, where=record.file)
        ratio = complex(fit.coefficients[1] / kind.sine.coefficients[1])
        size = abs(ratio)
        return Apparent(
            mass=-ratio.real / omega**2,
            damping=ratio.imag / omega,
            mass_share=abs(ratio.real) / size if size else 0.0,
            damping_share=abs(ratio.imag) / size if size else 0.0,
        )
    return _from_spectrum(record.displacement[kind.usable], force, record.step)


def _from_spectrum(x: Array, force: Array, step: float) -> Apparent:
    window, (displacement, velocity, acceleration) = windowed_derivatives(x, step)
    target = np.fft.rfft(window * (force - force.mean()))
    power = np.abs(displacement) ** 2
    strong = power > 1e-4 * power[3:].max()
    strong[:3] = False  # the window's own bins hold the offset and the drift
    columns = np.column_stack([acceleration, velocity, displacement])[strong]
    rows = np.concatenate([columns.real, columns.imag])
    goal = np.concatenate([target[strong].real, target[strong].imag])
    norms = np.linalg.norm(rows, axis=0)
    beta = np.linalg.lstsq(rows / norms, goal, rcond=1e-10)[0]
    total = float(np.linalg.norm(goal)) or 1.0
    return Apparent(
        mass=float(beta[0] / norms[0]),
        damping=float(beta[1] / norms[1]),
        mass_share=abs(float(beta[0])) / total,
        damping_share=abs(float(beta[1])) / total,
    )
