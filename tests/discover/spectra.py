"""Lines of exact sine tests, written out in full, as rows for regression.

Columns and forces come from closed forms on one cycle and not from the library's terms.
"""

from __future__ import annotations

import numpy as np

from discover.library.dictionary import Column, Dictionary
from discover.library.family import Family
from discover.triangle import WindowRows

POINTS = 512
HARMONICS = 7
THETA = 2.0 * np.pi * np.arange(POINTS) / POINTS

PLAIN = {
    "inertia": lambda x, v, a: a,
    "viscous-damping": lambda x, v, a: v,
    "quadratic-damping": lambda x, v, a: v * np.abs(v),
    "coulomb-friction": lambda x, v, a: np.sign(v),
    "stiffness": lambda x, v, a: x,
    "force-offset": lambda x, v, a: np.ones_like(x),
}


def dictionary(*ids, orders=(0.0, 2.0), exponents=None, reference=10.0, speed=0.3, delay=False):
    """Return a dictionary of these plain terms, one family of orders and perhaps one of powers."""
    families = []
    if orders is not None:
        families.append(Family("fractional-derivative", "order", *orders, 17, reference))
    if exponents is not None:
        families.append(Family("power-law-damping", "exponent", *exponents, 17, speed))
    shape = {"coulomb-friction": (("transition_speed", 0.0),)}
    return Dictionary(tuple(Column(i, shape.get(i, ())) for i in ids), tuple(families), delay)


def sine(amplitude, frequency):
    """Return x, v, a over one cycle of A sin."""
    omega = 2.0 * np.pi * frequency
    x = amplitude * np.sin(THETA)
    return x, amplitude * omega * np.cos(THETA), -(omega**2) * x


def fractional(amplitude, frequency, order):
    """Return the steady-state derivative of A sin over one cycle."""
    omega = 2.0 * np.pi * frequency
    return amplitude * omega**order * np.sin(THETA + 0.5 * np.pi * order)


def lines_of(values):
    """Return mean and harmonics whose squared magnitudes add up to the mean square."""
    spectrum = np.fft.rfft(values, axis=-1)[..., : HARMONICS + 1] / POINTS
    spectrum[..., 1:] *= np.sqrt(2.0)
    return spectrum


def force_of(terms, amplitude, frequency):
    """Return the force over one cycle of {id or ("order", q) or ("power", p): coefficient}."""
    motion = sine(amplitude, frequency)
    total = np.zeros(POINTS)
    for key, coefficient in terms.items():
        if isinstance(key, str):
            total += coefficient * PLAIN[key](*motion)
        elif key[0] == "order":
            total += coefficient * fractional(amplitude, frequency, key[1])
        else:
            total += coefficient * np.sign(motion[1]) * np.abs(motion[1]) ** key[1]
    return total


def window(space, force, amplitude, frequency, *, record, noise=0.0, rng=None, delay=0.0):
    """Return a test's rows; `noise` is the standard deviation of a line's part over the rms."""
    omega = 2.0 * np.pi * frequency
    motion = sine(amplitude, frequency)
    values = [PLAIN[c.id](*motion) for c in space.columns]
    for family in space.families:
        for node in family.nodes:
            if family.parameter == "order":
                column = fractional(amplitude, frequency, node)
            else:
                column = np.sign(motion[1]) * np.abs(motion[1]) ** node
            values.append(family.reference**-node * column)
    harmonics = np.arange(HARMONICS + 1)
    measured = lines_of(force) * np.exp(-1j * harmonics * omega * delay)
    power = float(np.sum(np.abs(measured) ** 2))
    sigma = max(noise, 1e-9) * np.sqrt(power)
    if rng is not None and noise:
        parts = rng.standard_normal((2, HARMONICS + 1))
        parts[1, 0] = 0.0
        measured = measured + sigma * (parts[0] + 1j * parts[1])
    stacked = [lines_of(np.array(values))]
    if space.delay:
        stacked.append((-1j * harmonics * omega * measured)[None])
    stacked.append(measured[None])
    matrix = np.concatenate(stacked)
    count = np.full(HARMONICS + 1, 2.0)
    count[0] = 1.0
    return WindowRows(
        matrix=np.concatenate((matrix.real, matrix.imag), axis=1).T,
        block=np.concatenate((harmonics, harmonics)),
        count=count,
        variance=np.full(HARMONICS + 1, sigma**2),
        discrepancy=np.zeros(HARMONICS + 1),
        record=record,
        frequency=frequency,
        amplitude=amplitude,
        speed=omega * amplitude,
        power=power,
        rest=0.0,
        noise_power=float(sigma**2 * count.sum()),
        share=1.0,
    )


def windows(space, terms, plan, *, noise=0.01, seed=0, delay=0.0):
    """Return the rows of a plan of (amplitude, frequency); terms may depend on the test."""
    rng = np.random.default_rng(seed)
    law = terms if callable(terms) else lambda amplitude, frequency: terms
    return [
        window(
            space, force_of(law(a, f), a, f), a, f, record=i, noise=noise, rng=rng, delay=delay
        )
        for i, (a, f) in enumerate(plan)
    ]
